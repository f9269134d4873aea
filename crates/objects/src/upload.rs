//! Uploads a file to an object: as a whole or not at all, in one request or in parts.

use std::{
    fs::{self, File},
    io::{self, Read, Write as _},
    path::{Path, PathBuf},
    sync::Arc,
    thread,
    time::Duration,
};

use corniche_store::{Existing, OpenMode, open_own, random_digits};
use object_store::{
    Error, ObjectStore, PutMode, PutMultipartOptions, PutOptions,
    aws::AmazonS3,
    multipart::{MultipartStore, PartId},
    path::Path as Key,
};
use tokio::{task::JoinSet, time::timeout};

use crate::{Bucket, ObjectError, watch::check_name};

/// The number of bytes per request. S3 requires at least 5 MiB of all parts but the last.
const PART_BYTES: u64 = 8 << 20;
/// The largest number of parts of an object.
const MOST_PARTS: u64 = 10_000;
/// The largest number of bytes of a part.
const LARGEST_PART_BYTES: u64 = 5 << 30;
/// The number of parts that are sent at once.
const AT_ONCE: usize = 2;
/// The interval between calls of `should_stop` while parts are being sent.
const ASKS_EVERY: Duration = Duration::from_millis(200);

/// A file to upload.
#[derive(Clone, Copy)]
pub struct Upload<'a> {
    /// The file, which nobody changes meanwhile.
    pub file: &'a Path,
    /// The object's key.
    pub key: &'a str,
    /// The action if an object of that name exists.
    pub existing: Existing,
    /// Returns whether to stop.
    pub should_stop: &'a dyn Fn() -> bool,
}

impl Bucket {
    /// Uploads a file and returns its length.
    ///
    /// While a large file is sent in parts, a small file next to it (its name and `.upload`) stores
    /// the id of the upload. If the process is killed, the next process that sends the same file
    /// aborts that upload first, so that its parts take no space.
    ///
    /// # Errors
    /// [`ObjectError::Exists`] if the object exists and is to be kept; [`ObjectError::Stopped`];
    /// see [`ObjectError`].
    pub fn upload(&self, upload: &Upload<'_>) -> Result<u64, ObjectError> {
        let Upload { file: path, key, existing, .. } = *upload;
        let file_failed = |doing| {
            let path = path.to_owned();
            move |source| ObjectError::File { path, doing, source }
        };
        let mut file = File::open(path).map_err(file_failed("open"))?;
        let length = file.metadata().map_err(file_failed("check"))?.len();
        let address = self.address(key).to_string();
        if length > MOST_PARTS * LARGEST_PART_BYTES {
            return Err(ObjectError::TooLarge { name: address, length });
        }
        let (object, explain) = self.object(key, "write")?;
        let writer = random_digits();
        let note = UploadNote::for_file(path);
        self.end_earlier(path)?;
        let sent = if length <= PART_BYTES {
            let mut bytes = Vec::with_capacity(length as usize);
            file.read_to_end(&mut bytes).map_err(file_failed("read"))?;
            let mode = match existing {
                Existing::Keep => PutMode::Create,
                Existing::Replace => PutMode::Overwrite,
            };
            let attributes = [Self::writer(&writer)].into_iter().collect();
            let options = PutOptions { mode, attributes, ..PutOptions::default() };
            let put = self.keeping.put_opts(&object, bytes.into(), options);
            self.runtime.block_on(put).map(drop).map_err(Ended::Storage)
        } else {
            self.send_in_parts(upload, (&object, length), &mut file, &writer, &note)
        };
        match sent {
            Ok(()) => self.check_stored(key, length, &writer),
            Err(Ended::Stopped) => Err(ObjectError::Stopped { name: address }),
            Err(Ended::File(source)) => Err(file_failed("read")(source)),
            Err(Ended::Note(source)) => {
                Err(ObjectError::File { path: note.path, doing: "write", source })
            }
            // The answer to an earlier try may have been lost, so the existing object may be ours.
            Err(Ended::Storage(
                error @ (Error::AlreadyExists { .. }
                | Error::Precondition { .. }
                | Error::NotFound { .. }),
            )) => match self.look(key)? {
                Some((_, Some(by))) if by == writer => Ok(length),
                Some(_) if existing == Existing::Keep => Err(ObjectError::Exists { name: address }),
                _ => Err(ObjectError::Failed {
                    doing: "write",
                    name: address,
                    source: Box::new(error),
                }),
            },
            Err(Ended::Storage(error)) => Err(explain(error)),
        }
    }

    /// Checks that the uploaded object exists, since a confirmation of the server proves nothing.
    /// Returns its length.
    fn check_stored(&self, key: &str, length: u64, writer: &str) -> Result<u64, ObjectError> {
        /// Some servers list a new object only after a moment.
        const TRIES: u32 = 4;
        let name = self.address(key).to_string();
        let mut found = String::new();
        for pause in 0..TRIES {
            if pause > 0 {
                thread::sleep(self.first_pause * (1 << pause));
            }
            found = match self.look(key)? {
                None => "it does not exist".to_owned(),
                Some((there, _)) if there.length != length => {
                    format!("it has {} bytes instead of {length}", there.length)
                }
                // Not every server stores the writer.
                Some((_, Some(by))) if by != writer => return Err(ObjectError::Changed { name }),
                Some(_) => return Ok(length),
            };
        }
        Err(ObjectError::NotStored { name, found })
    }

    fn send_in_parts(
        &self,
        upload: &Upload<'_>,
        (object, length): (&Key, u64),
        file: &mut File,
        writer: &str,
        note: &UploadNote,
    ) -> Result<(), Ended> {
        let storage = match upload.existing {
            Existing::Keep => &self.keeping,
            Existing::Replace => &self.replacing,
        };
        let attributes = [Self::writer(writer)].into_iter().collect();
        let options = PutMultipartOptions { attributes, ..PutMultipartOptions::default() };
        let begun = storage.create_multipart_opts(object, options);
        let id = self.runtime.block_on(begun).map_err(Ended::Storage)?;
        check_name("the name of an upload", &id)
            .map_err(|bad| Ended::Storage(Error::Generic { store: "S3", source: Box::new(bad) }))?;
        let sent = note.write(upload.key, &id).map_err(Ended::Note).and_then(|()| {
            let parts = send_parts(storage, (object, &id), file, length, upload.should_stop);
            let parts = self.runtime.block_on(parts)?;
            let end = storage.complete_multipart(object, &id, parts);
            self.runtime.block_on(end).map(drop).map_err(Ended::Storage)
        });
        if sent.is_err() {
            // If this fails too, the next process that sends the file aborts the upload.
            let ended = self.runtime.block_on(storage.abort_multipart(object, &id));
            if !matches!(ended, Ok(()) | Err(Error::NotFound { .. })) {
                return sent;
            }
        }
        note.remove();
        sent
    }

    /// Aborts the upload of a file by an earlier process that was killed.
    pub(crate) fn end_earlier(&self, file: &Path) -> Result<(), ObjectError> {
        let note = UploadNote::for_file(file);
        let Some((key, id)) = note.read() else { return Ok(()) };
        let (object, explain) = self.object(&key, "abort an earlier upload of")?;
        match self.runtime.block_on(self.keeping.abort_multipart(&object, &id)) {
            // The upload was complete, or aborted by another process.
            Ok(()) | Err(Error::NotFound { .. }) => {
                note.remove();
                Ok(())
            }
            Err(error) => Err(explain(error)),
        }
    }
}

/// The reason why an upload ended early.
enum Ended {
    Stopped,
    File(io::Error),
    Note(io::Error),
    Storage(Error),
}

/// Sends all parts, several at once.
async fn send_parts(
    storage: &Arc<AmazonS3>,
    (object, id): (&Key, &String),
    file: &mut File,
    length: u64,
    should_stop: &dyn Fn() -> bool,
) -> Result<Vec<PartId>, Ended> {
    let part_bytes = PART_BYTES.max(length.div_ceil(MOST_PARTS));
    let count = length.div_ceil(part_bytes) as usize;
    let mut parts: Vec<Option<PartId>> = vec![None; count];
    let mut next = 0;
    // Dropping the tasks aborts what is still being sent.
    let mut sending = JoinSet::new();
    loop {
        if should_stop() {
            return Err(Ended::Stopped);
        }
        while sending.len() < AT_ONCE && next < count {
            let wanted = part_bytes.min(length - next as u64 * part_bytes);
            let mut bytes = vec![0; wanted as usize];
            file.read_exact(&mut bytes).map_err(Ended::File)?;
            let (storage, object, id) = (Arc::clone(storage), object.clone(), id.clone());
            let index = next;
            sending.spawn(async move {
                (index, storage.put_part(&object, &id, index, bytes.into()).await)
            });
            next += 1;
        }
        match timeout(ASKS_EVERY, sending.join_next()).await {
            // No part has finished yet.
            Err(_) => {}
            Ok(None) => break,
            Ok(Some(joined)) => {
                let (index, sent) = joined.map_err(|error| Ended::File(io::Error::other(error)))?;
                parts[index] = Some(sent.map_err(Ended::Storage)?);
            }
        }
    }
    Ok(parts.into_iter().flatten().collect())
}

/// The file that identifies the upload in progress: the object's key, and the upload's id.
struct UploadNote {
    path: PathBuf,
}

impl UploadNote {
    fn for_file(file: &Path) -> Self {
        let mut path = file.as_os_str().to_owned();
        path.push(".upload");
        Self { path: path.into() }
    }

    fn write(&self, key: &str, id: &str) -> io::Result<()> {
        let mut file = open_own(&self.path, OpenMode::ChangeOrNew)?;
        file.set_len(0)?;
        file.write_all(format!("{key}\n{id}\n").as_bytes())
    }

    /// Reads the note of a killed process. An incomplete note names no upload.
    fn read(&self) -> Option<(String, String)> {
        let mut text = String::new();
        open_own(&self.path, OpenMode::Read).ok()?.read_to_string(&mut text).ok()?;
        let (key, rest) = text.split_once('\n')?;
        let id = rest.strip_suffix('\n')?;
        Some((key.to_owned(), id.to_owned()))
    }

    /// If the note cannot be removed, the next process aborts an upload that does not exist, which
    /// does no harm.
    fn remove(&self) {
        let _ = fs::remove_file(&self.path);
    }
}
