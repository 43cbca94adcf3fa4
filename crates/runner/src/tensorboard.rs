//! TensorBoard event files: TFRecord frames that hold protobuf `Event` messages with scalar summaries.
//!
//! Format: tensorflow/core/util/event.proto and tensorflow/core/lib/io/record_writer.h. Only the few fields that
//! scalars need are written, by hand: a protobuf compiler for five fields would be the heavier dependency.

use std::path::Path;

use anyhow::Result;

use crate::store::AppendFile;

/// An event file that receives scalars.
#[derive(Debug)]
pub struct EventFile {
    file: AppendFile,
}

impl EventFile {
    /// Starts a file with the version record that readers expect first.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(path: &Path, wall_time: f64) -> Result<Self> {
        let mut file = AppendFile::create(path)?;
        let mut event = Vec::new();
        put_double(&mut event, 1, wall_time);
        put_bytes(&mut event, 3, b"brain.Event:2");
        file.append(&frame(&event))?;
        Ok(Self { file })
    }

    /// Continues a file, dropping what came after its first `length` bytes.
    ///
    /// # Errors
    /// The file is missing or shorter.
    pub fn reopen(path: &Path, length: u64) -> Result<Self> {
        Ok(Self { file: AppendFile::reopen(path, length)? })
    }

    /// Adds one event with all `scalars` at `step`.
    ///
    /// # Errors
    /// The disk is full.
    pub fn scalars<'a>(
        &mut self,
        wall_time: f64,
        step: u64,
        scalars: impl IntoIterator<Item = (&'a str, f64)>,
    ) -> Result<()> {
        let mut summary = Vec::new();
        for (tag, value) in scalars {
            let mut entry = Vec::new();
            put_bytes(&mut entry, 1, tag.as_bytes());
            put_float(&mut entry, 2, value as f32);
            put_bytes(&mut summary, 1, &entry);
        }
        let mut event = Vec::new();
        put_double(&mut event, 1, wall_time);
        put_key(&mut event, 2, 0);
        put_varint(&mut event, step);
        put_bytes(&mut event, 5, &summary);
        self.file.append(&frame(&event))
    }

    /// Bytes so far, on disk once this returns.
    ///
    /// # Errors
    /// The disk refuses.
    pub fn sync(&mut self) -> Result<u64> {
        self.file.sync()
    }
}

/// One TFRecord: length, masked checksum of the length, payload, masked checksum of the payload.
fn frame(payload: &[u8]) -> Vec<u8> {
    let length = (payload.len() as u64).to_le_bytes();
    let mut record = Vec::with_capacity(payload.len() + 16);
    record.extend_from_slice(&length);
    record.extend_from_slice(&masked_checksum(&length).to_le_bytes());
    record.extend_from_slice(payload);
    record.extend_from_slice(&masked_checksum(payload).to_le_bytes());
    record
}

fn masked_checksum(bytes: &[u8]) -> u32 {
    crc32c::crc32c(bytes).rotate_right(15).wrapping_add(0xa282_ead8)
}

fn put_varint(out: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

fn put_key(out: &mut Vec<u8>, field: u64, wire_type: u64) {
    put_varint(out, field << 3 | wire_type);
}

fn put_double(out: &mut Vec<u8>, field: u64, value: f64) {
    put_key(out, field, 1);
    out.extend_from_slice(&value.to_le_bytes());
}

fn put_float(out: &mut Vec<u8>, field: u64, value: f32) {
    put_key(out, field, 5);
    out.extend_from_slice(&value.to_le_bytes());
}

fn put_bytes(out: &mut Vec<u8>, field: u64, bytes: &[u8]) {
    put_key(out, field, 2);
    put_varint(out, bytes.len() as u64);
    out.extend_from_slice(bytes);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_is_what_tensorflow_writes() {
        // The version event at wall time 0: field 1 as a double, field 3 as a string.
        let mut event = Vec::new();
        put_double(&mut event, 1, 0.0);
        put_bytes(&mut event, 3, b"brain.Event:2");
        assert_eq!(event, b"\x09\0\0\0\0\0\0\0\0\x1a\x0dbrain.Event:2");
        let record = frame(&event);
        assert_eq!(&record[..8], &(event.len() as u64).to_le_bytes());
        assert_eq!(record.len(), event.len() + 16);
    }

    #[test]
    fn the_checksum_is_castagnoli_masked() {
        // RFC 3720 B.4: CRC-32C of 32 zero bytes is 0x8a9136aa.
        assert_eq!(crc32c::crc32c(&[0; 32]), 0x8a91_36aa);
        assert_eq!(masked_checksum(&[0; 32]), 0x8a91_36aa_u32.rotate_right(15).wrapping_add(0xa282_ead8));
    }

    #[test]
    fn long_numbers_take_several_bytes() {
        let mut out = Vec::new();
        put_varint(&mut out, 300);
        assert_eq!(out, [0xac, 0x02]);
    }
}
