//! Files on disk: read with the path in every error, written whole or not at all.

use std::fs::{self, File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

/// Reads a text file; the error names the file and the cause.
///
/// # Errors
/// The file is missing, unreadable or no UTF-8.
pub fn read_text(path: &Path) -> Result<String> {
    fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))
}

/// Reads a binary file; the error names the file and the cause.
///
/// # Errors
/// The file is missing or unreadable.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>> {
    fs::read(path).with_context(|| format!("cannot read {}", path.display()))
}

/// The first bytes of a file, at most `count`: enough to tell what it is.
///
/// # Errors
/// The file is missing or unreadable.
pub fn read_start(path: &Path, count: usize) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(count as u64).read_to_end(&mut bytes));
    read.with_context(|| format!("cannot read {}", path.display()))?;
    Ok(bytes)
}

/// Writes `contents` to `path` whole or not at all.
///
/// The bytes go to a temporary file beside `path`, which is synced and then renamed over it, so a reader sees
/// the old file or the new one and never a part. Missing folders are made.
///
/// # Errors
/// The disk is full or the folder cannot be written; `path` is then as it was and the temporary file is gone.
pub fn write_whole(path: &Path, contents: &[u8]) -> Result<()> {
    write_whole_with(path, |file| file.write_all(contents).map_err(anyhow::Error::from))
}

/// [`write_whole`] for contents that are streamed rather than held in memory.
///
/// # Errors
/// As [`write_whole`], and whatever `write` reports.
pub fn write_whole_with(path: &Path, write: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let temporary = temporary_beside(path);
    let written: Result<()> = (|| {
        fs::create_dir_all(folder)?;
        let mut file = std::io::BufWriter::with_capacity(1 << 20, File::create(&temporary)?);
        write(&mut file)?;
        let file = file.into_inner().map_err(std::io::IntoInnerError::into_error)?;
        file.sync_all()?;
        drop(file);
        fs::rename(&temporary, path)?;
        // The rename itself survives a power cut only once the folder is on disk.
        File::open(folder)?.sync_all()?;
        Ok(())
    })();
    if written.is_err() {
        // The first error is the one to report; a temporary file that was never made cannot be removed.
        let _ = fs::remove_file(&temporary);
    }
    written.with_context(|| format!("cannot write {} (the file is as it was)", path.display()))
}

fn temporary_beside(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.partial", std::process::id()));
    path.with_file_name(name)
}

/// The most memory that this process has held at once \[bytes\], as Linux tells it; `None` elsewhere.
#[must_use]
pub fn peak_memory() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024 * kibibytes)
}

/// A file that only grows, line by line or record by record, and can be cut back to where a checkpoint was made.
#[derive(Debug)]
pub struct AppendFile {
    path: PathBuf,
    file: File,
    length: u64,
}

impl AppendFile {
    /// Starts an empty file, replacing whatever was there.
    ///
    /// # Errors
    /// The file cannot be made.
    pub fn create(path: &Path) -> Result<Self> {
        let file = File::create(path).with_context(|| format!("cannot make {}", path.display()))?;
        Ok(Self { path: path.to_owned(), file, length: 0 })
    }

    /// Opens an existing file and drops everything behind the first `length` bytes: what a killed run wrote after
    /// its last checkpoint, half a line included.
    ///
    /// # Errors
    /// The file is missing or shorter than `length`.
    pub fn reopen(path: &Path, length: u64) -> Result<Self> {
        let context = || format!("cannot continue {}", path.display());
        let mut file = OpenOptions::new().write(true).open(path).with_context(context)?;
        let found = file.metadata().with_context(context)?.len();
        ensure!(
            found >= length,
            "{}: {found} bytes, but the checkpoint was made when it had {length}",
            path.display()
        );
        file.set_len(length).with_context(context)?;
        file.seek(SeekFrom::End(0)).with_context(context)?;
        Ok(Self { path: path.to_owned(), file, length })
    }

    /// Appends one record.
    ///
    /// # Errors
    /// The disk is full or the file was removed.
    pub fn append(&mut self, record: &[u8]) -> Result<()> {
        self.file.write_all(record).with_context(|| format!("cannot append to {}", self.path.display()))?;
        self.length += record.len() as u64;
        Ok(())
    }

    /// Bytes so far, on disk once this returns.
    ///
    /// # Errors
    /// The disk refuses.
    pub fn sync(&mut self) -> Result<u64> {
        self.file.sync_data().with_context(|| format!("cannot write {}", self.path.display()))?;
        Ok(self.length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_no_temporary_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("certificate.json");
        write_whole(&path, b"old").unwrap();
        let failed = write_whole_with(&path, |file| {
            file.write_all(b"ne")?;
            anyhow::bail!("no space left on device")
        });
        let message = format!("{:#}", failed.unwrap_err());
        assert!(message.contains("certificate.json") && message.contains("no space left"), "{message}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_full_disk_is_an_error_that_names_the_file() {
        // /dev/full answers every write with ENOSPC.
        let mut log =
            AppendFile { path: "metrics.jsonl".into(), file: File::create("/dev/full").unwrap(), length: 0 };
        let message = format!("{:#}", log.append(b"{}\n").unwrap_err());
        assert!(message.contains("metrics.jsonl") && message.contains("No space left"), "{message}");
        assert_eq!(log.length, 0);
    }

    #[test]
    fn reopening_cuts_what_came_after_the_checkpoint() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("metrics.jsonl");
        let mut log = AppendFile::create(&path).unwrap();
        log.append(b"one\n").unwrap();
        let length = log.sync().unwrap();
        log.append(b"tw").unwrap();
        drop(log);
        let mut log = AppendFile::reopen(&path, length).unwrap();
        log.append(b"two\n").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"one\ntwo\n");
        assert!(AppendFile::reopen(&path, 100).is_err());
    }
}
