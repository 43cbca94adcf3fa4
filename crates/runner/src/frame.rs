//! The frame of the binary files that a training leaves: what the file is, and a header that can be read alone.
//!
//! ```text
//! 8 bytes  magic       u32  version       u64  length of the header       u32  CRC-32C of the header
//! …        header, JSON with line breaks  …    what the header describes, with a length and checksum of its own
//! ```
//!
//! Numbers are little-endian. A file of an earlier version is brought to the present one step by step before its
//! header is interpreted: [`Kind::steps`].

use std::io::{Read, Write};

use anyhow::{Context, Result, anyhow, bail, ensure};
use serde::{Serialize, de::DeserializeOwned};
use serde_json::Value;

/// A header is a few kilobytes; a length beyond this is a corrupted one.
const MAX_HEADER: u64 = 1 << 26;

/// Turns a header of one version into one of the next.
pub type Step = fn(&mut Value) -> Result<()>;

/// A kind of file.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// The first bytes.
    pub magic: [u8; 8],
    /// What it is called where one is refused.
    pub name: &'static str,
    /// The first leads from version 1 to 2, and so on; there is one version more than steps.
    pub steps: &'static [Step],
}

impl Kind {
    /// The version that is written.
    #[must_use]
    pub fn version(&self) -> u32 {
        1 + self.steps.len() as u32
    }

    /// Writes everything up to what the header describes.
    ///
    /// # Errors
    /// The writer fails.
    pub fn write(&self, out: &mut impl Write, header: &impl Serialize) -> Result<()> {
        let mut json = serde_json::to_vec_pretty(header)?;
        json.push(b'\n');
        out.write_all(&self.magic)?;
        out.write_all(&self.version().to_le_bytes())?;
        out.write_all(&(json.len() as u64).to_le_bytes())?;
        out.write_all(&crc32c::crc32c(&json).to_le_bytes())?;
        out.write_all(&json)?;
        Ok(())
    }

    /// Reads a header, and leaves the reader at what it describes.
    ///
    /// # Errors
    /// The stream is of another kind or of a version that is not known, or is cut or damaged: the cause is named.
    pub fn read<H: DeserializeOwned>(&self, input: &mut impl Read) -> Result<H> {
        const CUT: &str = "the file ends within its header; it is cut";
        ensure!(take(input).context(CUT)? == self.magic, "this is no {}", self.name);
        let found = u32::from_le_bytes(take(input).context(CUT)?);
        let known = 1..=self.version();
        ensure!(
            known.contains(&found),
            "it is of version {found} of the format, and this program reads {}",
            if self.steps.is_empty() { "version 1".into() } else { format!("versions 1 to {}", known.end()) }
        );
        let length = u64::from_le_bytes(take(input).context(CUT)?);
        ensure!(length <= MAX_HEADER, "header of {length} bytes; the file is damaged");
        let checksum = u32::from_le_bytes(take(input).context(CUT)?);
        let mut json = vec![0; length as usize];
        input.read_exact(&mut json).context(CUT)?;
        if crc32c::crc32c(&json) != checksum {
            bail!("checksum of the header does not match; the file is damaged");
        }
        let mut header: Value = serde_json::from_slice(&json).map_err(|error| anyhow!("header: {error}"))?;
        for (step, version) in self.steps.iter().zip(1..).skip(found as usize - 1) {
            step(&mut header).with_context(|| format!("from version {version} to {}", version + 1))?;
        }
        serde_json::from_value(header).map_err(|error| anyhow!("header: {error}"))
    }
}

fn take<const N: usize>(input: &mut impl Read) -> std::io::Result<[u8; N]> {
    let mut bytes = [0; N];
    input.read_exact(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;
    use serde_json::json;

    use super::*;

    const FIRST: Kind = Kind { magic: *b"a kind\0\0", name: "file of a test", steps: &[] };
    const THIRD: Kind = Kind { steps: &[metres, named], ..FIRST };

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Header {
        length: f64,
        name: String,
    }

    fn metres(header: &mut Value) -> Result<()> {
        header["length"] = json!(header["length"].as_f64().context("length")? / 1000.0);
        Ok(())
    }

    fn named(header: &mut Value) -> Result<()> {
        header["name"] = json!("unknown");
        Ok(())
    }

    fn written(kind: &Kind, header: &impl Serialize) -> Vec<u8> {
        let mut bytes = Vec::new();
        kind.write(&mut bytes, header).unwrap();
        bytes
    }

    fn refusal(kind: &Kind, bytes: &[u8]) -> String {
        let mut bytes = bytes;
        format!("{:#}", kind.read::<Header>(&mut bytes).expect_err("this must be refused"))
    }

    #[test]
    fn an_earlier_version_is_brought_to_the_present_one_step_by_step() {
        let second = Kind { steps: &[metres], ..FIRST };
        let expected = |name: &str| Header { length: 1.5, name: name.into() };
        let read = |bytes: Vec<u8>| THIRD.read::<Header>(&mut bytes.as_slice()).unwrap();
        assert_eq!(read(written(&FIRST, &json!({"length": 1500.0}))), expected("unknown"));
        assert_eq!(read(written(&second, &json!({"length": 1.5}))), expected("unknown"));
        assert_eq!(read(written(&THIRD, &expected("rod"))), expected("rod"));
    }

    #[test]
    fn another_version_is_refused_with_both_named() {
        let newer = written(&THIRD, &json!({}));
        assert_eq!(
            refusal(&FIRST, &newer),
            "it is of version 3 of the format, and this program reads version 1"
        );
        let mut older = newer;
        older[8..12].fill(0);
        assert_eq!(
            refusal(&THIRD, &older),
            "it is of version 0 of the format, and this program reads versions 1 to 3"
        );
    }

    #[test]
    fn a_header_is_left_at_what_it_describes_and_can_be_read_by_a_person() {
        let mut bytes = written(&THIRD, &Header { length: 1.0, name: "rod".into() });
        let text = String::from_utf8_lossy(&bytes).into_owned();
        assert!(text.contains("\n  \"name\": \"rod\"\n}\n"), "{text}");
        bytes.extend(b"rest");
        let mut input = bytes.as_slice();
        THIRD.read::<Header>(&mut input).unwrap();
        assert_eq!(input, b"rest");
    }

    #[test]
    fn a_foreign_cut_or_damaged_header_is_refused() {
        let whole = written(&THIRD, &Header { length: 1.0, name: "rod".into() });
        for length in [0, 7, 10, 20, 30, whole.len() - 1] {
            assert_eq!(
                refusal(&THIRD, &whole[..length]).split(':').next(),
                Some("the file ends within its header; it is cut")
            );
        }
        let mut bytes = whole.clone();
        bytes[30] ^= 1;
        assert_eq!(refusal(&THIRD, &bytes), "checksum of the header does not match; the file is damaged");
        bytes[0] = b'x';
        assert_eq!(refusal(&THIRD, &bytes), "this is no file of a test");
        let mut bytes = whole;
        bytes[19] = 1;
        assert!(refusal(&THIRD, &bytes).ends_with("bytes; the file is damaged"));
    }
}
