//! A file to an object: as a whole or not at all, in one request or in parts.

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

/// What is sent in one request. S3 wants at least 5 MiB of all parts but the last.
const PART_BYTES: u64 = 8 << 20;
/// The most parts of an object.
const MOST_PARTS: u64 = 10_000;
/// The most bytes of a part.
const LARGEST_PART_BYTES: u64 = 5 << 30;
/// Parts that are sent at once.
const AT_ONCE: usize = 2;
/// `should_stop` is asked so often while parts are sent.
const ASKS_EVERY: Duration = Duration::from_millis(200);

/// A file to be sent.
#[derive(Clone, Copy)]
pub struct Upload<'a> {
    /// The file, which nobody changes meanwhile.
    pub file: &'a Path,
    /// The object's key.
    pub key: &'a str,
    /// What to do with an object of that name.
    pub existing: Existing,
    /// Whether to stop.
    pub should_stop: &'a dyn Fn() -> bool,
}

impl Bucket {
    /// Sends a file. Returns its length.
    ///
    /// While a large file is sent in parts, a small file beside it (its name and `.upload`) says which upload that is. If the process is
    /// killed, the next one that sends the same file ends that upload first, so that its parts take no space.
    ///
    /// # Errors
    /// [`ObjectError::Exists`] if there is such an object and it is to be kept; [`ObjectError::Stopped`]; see [`ObjectError`].
    pub fn upload(&self, upload: &Upload<'_>) -> Result<u64, ObjectError> {
        let Upload { file: path, key, existing, .. } = *upload;
        let file_failed = |doing| {
            let path = path.to_owned();
            move |source| ObjectError::File { path, doing, source }
        };
        let mut file = File::open(path).map_err(file_failed("open"))?;
        let length = file.metadata().map_err(file_failed("look at"))?.len();
        let address = self.address(key).to_string();
        if length > MOST_PARTS * LARGEST_PART_BYTES {
            return Err(ObjectError::TooLarge { name: address, length });
        }
        let (object, explain) = self.object(key, "write")?;
        let writer = random_digits();
        let note = Note::of(path);
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
            // The answer to an earlier try may have been lost on its way, and what is there be ours.
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

    /// Looks for what was sent: that a server says it has stored something proves nothing. Returns its length.
    fn check_stored(&self, key: &str, length: u64, writer: &str) -> Result<u64, ObjectError> {
        /// Not every server shows at once what it has.
        const TRIES: u32 = 4;
        let name = self.address(key).to_string();
        let mut found = String::new();
        for pause in 0..TRIES {
            if pause > 0 {
                thread::sleep(self.first_pause * (1 << pause));
            }
            found = match self.look(key)? {
                None => "it is not there".to_owned(),
                Some((there, _)) if there.length != length => {
                    format!("it has {} bytes in place of {length}", there.length)
                }
                // Not every server keeps who wrote it.
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
        note: &Note,
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
            // If this fails too, the next process that sends the file ends the upload.
            let ended = self.runtime.block_on(storage.abort_multipart(object, &id));
            if !matches!(ended, Ok(()) | Err(Error::NotFound { .. })) {
                return sent;
            }
        }
        note.remove();
        sent
    }

    /// Ends the upload of a file by an earlier process that was killed.
    pub(crate) fn end_earlier(&self, file: &Path) -> Result<(), ObjectError> {
        let note = Note::of(file);
        let Some((key, id)) = note.read() else { return Ok(()) };
        let (object, explain) = self.object(&key, "end an earlier upload of")?;
        match self.runtime.block_on(self.keeping.abort_multipart(&object, &id)) {
            // It was complete, or ended by someone else.
            Ok(()) | Err(Error::NotFound { .. }) => {
                note.remove();
                Ok(())
            }
            Err(error) => Err(explain(error)),
        }
    }
}

/// Why the sending ended early.
enum Ended {
    Stopped,
    File(io::Error),
    Note(io::Error),
    Storage(Error),
}

/// Sends all parts, some at once.
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
    // Dropping it ends what is still being sent.
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
            // Not yet.
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

/// The file that says which upload is under way: the object's key, and the upload's id.
struct Note {
    path: PathBuf,
}

impl Note {
    fn of(file: &Path) -> Self {
        let mut path = file.as_os_str().to_owned();
        path.push(".upload");
        Self { path: path.into() }
    }

    fn write(&self, key: &str, id: &str) -> io::Result<()> {
        let mut file = open_own(&self.path, OpenMode::ChangeOrNew)?;
        file.set_len(0)?;
        file.write_all(format!("{key}\n{id}\n").as_bytes())
    }

    /// What a process left that was killed. A note that is not whole names no upload.
    fn read(&self) -> Option<(String, String)> {
        let mut text = String::new();
        open_own(&self.path, OpenMode::Read).ok()?.read_to_string(&mut text).ok()?;
        let (key, rest) = text.split_once('\n')?;
        let id = rest.strip_suffix('\n')?;
        Some((key.to_owned(), id.to_owned()))
    }

    /// If it cannot be removed, the next process ends an upload that is not there, which does no harm.
    fn remove(&self) {
        let _ = fs::remove_file(&self.path);
    }
}
