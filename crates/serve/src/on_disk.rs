//! Files on disk that may change, and the versions of open files.

use std::{
    fmt,
    fs::{File, Metadata},
    io::{self, Read as _, Seek as _, SeekFrom},
    ops::Range,
    sync::{Mutex, PoisonError},
    time::{SystemTime, UNIX_EPOCH},
};

use sha2::{Digest as _, Sha256};

/// The largest number of bytes of one range that are hashed.
const MOST_BYTES: u64 = 64 << 20;

/// A file on disk, provided by the program that starts the server.
pub trait OnDisk: fmt::Debug + Send + Sync {
    /// Opens the current version of the file.
    ///
    /// # Errors
    /// Returns `NotFound` if the file is missing or must not be sent; texts of other errors are
    /// sent to the client.
    fn open(&self) -> io::Result<File>;

    /// The ranges of the open file that distinguish its versions; they are hashed once per version.
    ///
    /// # Errors
    /// The same as those of [`OnDisk::open`].
    fn telling(&self, file: &File) -> io::Result<Vec<Range<u64>>>;
}

/// A version that was hashed.
#[derive(Debug)]
pub(crate) struct Known {
    state: State,
    tag: String,
}

/// The state of a version in the file system, which alone could be the same for two versions.
#[derive(Debug, Clone, PartialEq, Eq)]
struct State {
    length_bytes: u64,
    modified: SystemTime,
    /// The device, the inode number, and the time of the last change, which programs cannot set.
    #[cfg(unix)]
    identity: [i64; 4],
}

impl State {
    fn from_metadata(found: &Metadata) -> io::Result<Self> {
        #[cfg(unix)]
        use std::os::unix::fs::MetadataExt as _;
        Ok(Self {
            length_bytes: found.len(),
            modified: found.modified()?,
            #[cfg(unix)]
            identity: [
                found.dev().cast_signed(),
                found.ino().cast_signed(),
                found.ctime(),
                found.ctime_nsec(),
            ],
        })
    }
}

/// An open file, its length and its `ETag`, all of one version.
pub(crate) struct OpenedFile {
    pub(crate) file: File,
    pub(crate) length_bytes: u64,
    pub(crate) tag: String,
}

/// Opens a file; length and tag are those of the opened file, even if its path leads to another
/// file by then.
pub(crate) fn open(on_disk: &dyn OnDisk, known: &Mutex<Option<Known>>) -> io::Result<OpenedFile> {
    let file = on_disk.open()?;
    let state = State::from_metadata(&file.metadata()?)?;
    let length_bytes = state.length_bytes;
    let last = || known.lock().unwrap_or_else(PoisonError::into_inner);
    let tag = last().as_ref().filter(|last| last.state == state).map(|last| last.tag.clone());
    let tag = match tag {
        Some(tag) => tag,
        None => tag_of(on_disk, &file, &state)?,
    };
    *last() = Some(Known { state, tag: tag.clone() });
    Ok(OpenedFile { file, length_bytes, tag })
}

/// The tag: length, time and half of a hash of the bytes that distinguish versions, in quotes.
fn tag_of(on_disk: &dyn OnDisk, file: &File, state: &State) -> io::Result<String> {
    let mut digest = Sha256::new();
    for range in on_disk.telling(file)? {
        let mut reader = file;
        reader.seek(SeekFrom::Start(range.start))?;
        digest.update(range.start.to_le_bytes());
        digest.update(range.end.to_le_bytes());
        io::copy(&mut reader.take((range.end - range.start).min(MOST_BYTES)), &mut digest)?;
    }
    // Times before 1970 are distinguished, too.
    let (sign, since) = match state.modified.duration_since(UNIX_EPOCH) {
        Ok(since) => ("", since),
        Err(before) => ("-", before.duration()),
    };
    let (length_bytes, nanos, hash) = (state.length_bytes, since.as_nanos(), half_in_hex(digest));
    Ok(format!("\"{length_bytes:x}-{sign}{nanos:x}-{hash}\""))
}

/// The first half of a hash, as hexadecimal digits.
pub(crate) fn half_in_hex(digest: Sha256) -> String {
    let half =
        digest.finalize().iter().take(16).fold(0, |half: u128, &byte| half << 8 | u128::from(byte));
    format!("{half:032x}")
}
