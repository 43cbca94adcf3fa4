//! The frame of every file of this crate: what it is, how long it is, and whether it is whole.
//!
//! ```text
//! 8 bytes  magic                 u32  version            u64  length of all that follows
//! u32      length of the header  …    header, JSON       u32  CRC-32 of all bytes so far
//! …        numbers, little-endian                        u32  CRC-32 of all bytes so far
//! ```
//!
//! The header has a checksum of its own, so that nothing is allocated on the word of a damaged one.

use std::io::{self, Read, Write};

use crc32fast::Hasher;
use serde::{Serialize, de::DeserializeOwned};

/// A header is a page of JSON; a longer one is damage.
const HEADER_LIMIT: usize = 1 << 20;
/// Numbers converted at a time.
const CHUNK: usize = 1 << 14;

/// Why a checkpoint or a policy could not be written or read.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// The stream itself failed.
    #[error("cannot read or write the stream: {0}")]
    Io(#[source] io::Error),
    /// The stream does not begin as this kind of file does.
    #[error("not a file of kind {expected:?}: it begins with {:?}", String::from_utf8_lossy(found))]
    WrongMagic {
        /// What was asked for.
        expected: &'static str,
        /// Bytes that were found.
        found: [u8; 8],
    },
    /// Written by another version of this crate.
    #[error("format version {found} is not supported, this program reads versions 1 to {supported}")]
    UnsupportedVersion {
        /// Version of the file.
        found: u32,
        /// Newest version that can be read.
        supported: u32,
    },
    /// The stream ends early.
    #[error("truncated: the stream ends inside the {part}")]
    Truncated {
        /// Where it ends.
        part: &'static str,
    },
    /// The stream does not agree with its checksum.
    #[error("corrupted: the checksum of the {part} is {found:08x}, the file says {stated:08x}")]
    Checksum {
        /// What was summed.
        part: &'static str,
        /// Checksum of what was read.
        found: u32,
        /// Checksum that was written.
        stated: u32,
    },
    /// The header cannot be understood, although its checksum is right.
    #[error("unusable header: {0}")]
    Header(#[source] serde_json::Error),
    /// Length and content, or two parts of the content, do not agree.
    #[error("inconsistent: {part} is {found}, expected {expected}")]
    Inconsistent {
        /// What does not agree.
        part: &'static str,
        /// What the header calls for.
        expected: u64,
        /// What the file says.
        found: u64,
    },
    /// Training had diverged: such weights are of no use, neither written nor read.
    #[error("not finite: a number of the {part} is {value}")]
    NotFinite {
        /// What holds it.
        part: &'static str,
        /// NaN or an infinity.
        value: f64,
    },
    /// There is no memory for the replay that the file describes.
    #[error(transparent)]
    Replay(#[from] crate::replay::ReplayAllocationError),
}

/// Refuses an array that holds NaN or an infinity.
pub(crate) fn check_finite(part: &'static str, values: &[f32]) -> Result<(), CheckpointError> {
    match values.iter().find(|x| !x.is_finite()) {
        Some(&value) => Err(CheckpointError::NotFinite { part, value: f64::from(value) }),
        None => Ok(()),
    }
}

/// Kind of file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Format {
    pub(crate) magic: [u8; 8],
    pub(crate) name: &'static str,
    /// The version that is written; it and all before it can be read.
    pub(crate) version: u32,
    /// Brings the header of an earlier version up to the present one.
    pub(crate) upgrade: fn(u32, &mut serde_json::Value),
}

/// Writes a frame; [`Frame::finish`] must follow the last number.
pub(crate) struct Frame<'a, W: Write> {
    out: &'a mut W,
    hasher: Hasher,
    buffer: Vec<u8>,
}

impl<'a, W: Write> Frame<'a, W> {
    /// Begins a frame whose numbers will take `number_bytes` bytes.
    pub(crate) fn begin(
        out: &'a mut W,
        format: Format,
        header: &impl Serialize,
        number_bytes: u64,
    ) -> Result<Self, CheckpointError> {
        let header = serde_json::to_vec(header).map_err(CheckpointError::Header)?;
        let header_length = u32::try_from(header.len()).ok().filter(|&n| n as usize <= HEADER_LIMIT).ok_or(
            CheckpointError::Inconsistent {
                part: "length of the header",
                expected: HEADER_LIMIT as u64,
                found: header.len() as u64,
            },
        )?;
        let mut frame = Self { out, hasher: Hasher::new(), buffer: Vec::new() };
        frame.bytes(&format.magic)?;
        frame.bytes(&format.version.to_le_bytes())?;
        frame.bytes(&(12 + header.len() as u64 + number_bytes).to_le_bytes())?;
        frame.bytes(&header_length.to_le_bytes())?;
        frame.bytes(&header)?;
        frame.checksum()?;
        Ok(frame)
    }

    pub(crate) fn numbers(&mut self, values: &[f32]) -> Result<(), CheckpointError> {
        let mut buffer = std::mem::take(&mut self.buffer);
        for chunk in values.chunks(CHUNK) {
            buffer.clear();
            buffer.extend(chunk.iter().flat_map(|x| x.to_le_bytes()));
            self.bytes(&buffer)?;
        }
        self.buffer = buffer;
        Ok(())
    }

    pub(crate) fn double(&mut self, value: f64) -> Result<(), CheckpointError> {
        self.bytes(&value.to_le_bytes())
    }

    pub(crate) fn finish(mut self) -> Result<(), CheckpointError> {
        self.checksum()?;
        self.out.flush().map_err(CheckpointError::Io)
    }

    fn bytes(&mut self, bytes: &[u8]) -> Result<(), CheckpointError> {
        self.hasher.update(bytes);
        self.out.write_all(bytes).map_err(CheckpointError::Io)
    }

    fn checksum(&mut self) -> Result<(), CheckpointError> {
        let sum = self.hasher.clone().finalize();
        self.bytes(&sum.to_le_bytes())
    }
}

/// Reads a frame; [`Unframe::finish`] must follow the last number.
pub(crate) struct Unframe<'a, R: Read> {
    input: &'a mut R,
    hasher: Hasher,
    version: u32,
    /// Bytes of the frame not yet read.
    left: u64,
    buffer: Vec<u8>,
}

impl<'a, R: Read> Unframe<'a, R> {
    /// Reads and checks everything up to the first number.
    pub(crate) fn begin<H: DeserializeOwned>(
        input: &'a mut R,
        format: Format,
    ) -> Result<(Self, H), CheckpointError> {
        let mut frame = Self { input, hasher: Hasher::new(), version: 0, left: 24, buffer: Vec::new() };
        let mut magic = [0; 8];
        frame.bytes(&mut magic, "magic")?;
        if magic != format.magic {
            return Err(CheckpointError::WrongMagic { expected: format.name, found: magic });
        }
        frame.version = frame.integer("version")?;
        if !(1..=format.version).contains(&frame.version) {
            let (found, supported) = (frame.version, format.version);
            return Err(CheckpointError::UnsupportedVersion { found, supported });
        }
        let mut length = [0; 8];
        frame.bytes(&mut length, "length")?;
        let length = u64::from_le_bytes(length);
        let header_length = frame.integer("length of the header")? as usize;
        if header_length > HEADER_LIMIT {
            let (expected, found) = (HEADER_LIMIT as u64, header_length as u64);
            return Err(CheckpointError::Inconsistent { part: "length of the header", expected, found });
        }
        let least = header_length as u64 + 12;
        frame.left =
            length.checked_sub(4).filter(|_| length >= least).ok_or(CheckpointError::Inconsistent {
                part: "length of the file",
                expected: least,
                found: length,
            })?;
        let mut header = vec![0; header_length];
        frame.bytes(&mut header, "header")?;
        frame.checksum("header")?;
        let mut header = serde_json::from_slice(&header).map_err(CheckpointError::Header)?;
        (format.upgrade)(frame.version, &mut header);
        let header = serde_json::from_value(header).map_err(CheckpointError::Header)?;
        Ok((frame, header))
    }

    /// Version of the file.
    pub(crate) fn version(&self) -> u32 {
        self.version
    }

    /// Refuses the file unless exactly `expected` bytes of numbers are left.
    pub(crate) fn expect_numbers(&self, expected: u64) -> Result<(), CheckpointError> {
        let found = self.left.saturating_sub(4);
        if found == expected {
            Ok(())
        } else {
            Err(CheckpointError::Inconsistent { part: "length of the numbers [bytes]", expected, found })
        }
    }

    pub(crate) fn numbers(&mut self, values: &mut [f32]) -> Result<(), CheckpointError> {
        let mut buffer = std::mem::take(&mut self.buffer);
        for chunk in values.chunks_mut(CHUNK) {
            buffer.resize(4 * chunk.len(), 0);
            self.bytes(&mut buffer, "numbers")?;
            for (value, bytes) in chunk.iter_mut().zip(buffer.chunks_exact(4)) {
                *value = f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
            }
        }
        self.buffer = buffer;
        Ok(())
    }

    pub(crate) fn double(&mut self) -> Result<f64, CheckpointError> {
        let mut bytes = [0; 8];
        self.bytes(&mut bytes, "numbers")?;
        Ok(f64::from_le_bytes(bytes))
    }

    pub(crate) fn finish(mut self) -> Result<(), CheckpointError> {
        self.checksum("file")
    }

    fn integer(&mut self, part: &'static str) -> Result<u32, CheckpointError> {
        let mut bytes = [0; 4];
        self.bytes(&mut bytes, part)?;
        Ok(u32::from_le_bytes(bytes))
    }

    fn bytes(&mut self, bytes: &mut [u8], part: &'static str) -> Result<(), CheckpointError> {
        self.left = self.left.checked_sub(bytes.len() as u64).ok_or(CheckpointError::Truncated { part })?;
        self.input.read_exact(bytes).map_err(|error| match error.kind() {
            io::ErrorKind::UnexpectedEof => CheckpointError::Truncated { part },
            _ => CheckpointError::Io(error),
        })?;
        self.hasher.update(bytes);
        Ok(())
    }

    fn checksum(&mut self, part: &'static str) -> Result<(), CheckpointError> {
        let found = self.hasher.clone().finalize();
        let stated = self.integer("checksum")?;
        if found == stated { Ok(()) } else { Err(CheckpointError::Checksum { part, found, stated }) }
    }
}
