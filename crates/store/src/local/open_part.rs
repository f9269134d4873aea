//! The part that is being written: artifacts one after the other in a data file, and a journal of them.
//!
//! The journal never names what might not be there: first the data is made durable, then the entries are written, then they are made durable.
//! So what a crash leaves is a journal that is right up to some entry. What follows there is cut off at the next start.

use std::{
    mem,
    path::{Path, PathBuf},
    sync::{
        Arc, Mutex, MutexGuard, OnceLock, PoisonError, RwLock, TryLockError,
        atomic::{AtomicU64, Ordering},
    },
    time::{Duration, Instant},
};

use crate::{
    Key, OpenMode, PartFile as _, PlanHash, StoreError,
    files::{Files, OpenFile},
    local::{
        entry::{ENTRY_BYTES, Entry, Visit},
        header::{self, FileKind, HEADER_BYTES},
        index::{Index, Location, OFFSET_LIMIT, PART_LIMIT},
        layout, lock, sealed_part,
    },
};

/// The number of the open part in the index.
pub(crate) const OPEN_PART: u32 = PART_LIMIT - 1;

/// A part that artifacts are added to, by any number of threads.
#[derive(Debug)]
pub(crate) struct OpenPart {
    name: String,
    data: OpenFile,
    journal: OpenFile,
    interval: Duration,
    /// Where the next artifact goes in the data file.
    end: AtomicU64,
    /// Entries of artifacts that are written, in order of putting, but not in the journal yet.
    pending: Mutex<Vec<Entry>>,
    /// How many entries the journal has. Who syncs holds it.
    journaled: Mutex<u64>,
    synced_at: Mutex<Instant>,
    /// A sync failed: what the system keeps of the unsynced writes is unknown, so nothing may be built on them.
    /// The text says why.
    failed: OnceLock<String>,
}

impl OpenPart {
    /// Goes on with a part that a dead process left, or makes a new one. Also returns how many entries were cut off: torn, of an artifact that is
    /// damaged, or after such a one.
    pub(crate) fn open(
        files: &Arc<Files>,
        folder: &Path,
        name: &str,
        plan: &PlanHash,
        interval: Duration,
        visit: &mut Visit<'_>,
    ) -> Result<(Self, u64), StoreError> {
        let found = layout::look(files, folder)?.unwrap_or_default();
        let mut left = Vec::new();
        for journal in found.of(layout::Role::Journal) {
            if layout::part_of_journal(journal) == Some(name)
                && let Some(journal) = lock::adopt(files, &folder.join(journal))?
            {
                left.push((journal.length()?, journal));
            }
        }
        // If it was begun more than once, go on with the one that holds most.
        left.sort_by_key(|(length, _)| *length);
        let longest = left.pop();
        for (_, journal) in left {
            remove(files, &journal)?;
        }
        match longest {
            Some((length, journal)) if length > HEADER_BYTES => {
                if let Some(resumed) = Self::resume(files, journal, name, plan, interval, visit)? {
                    return Ok(resumed);
                }
            }
            Some((_, journal)) => remove(files, &journal)?,
            None => {}
        }
        Ok((Self::create(files, folder, name, plan, interval)?, 0))
    }

    fn create(
        files: &Arc<Files>,
        folder: &Path,
        name: &str,
        plan: &PlanHash,
        interval: Duration,
    ) -> Result<Self, StoreError> {
        let journal = lock::create_owned(files, |suffix| layout::journal(folder, name, suffix))?;
        journal.write_all_at(&header::encode(FileKind::Journal, plan), 0)?;
        journal.sync()?;
        let data = files.open(&layout::data_of_journal(journal.path()), OpenMode::New)?;
        data.write_all_at(&header::encode(FileKind::Data, plan), 0)?;
        data.sync()?;
        files.sync_folder(folder)?;
        Ok(Self::new(name, data, journal, interval, HEADER_BYTES, 0))
    }

    /// Goes on with a part whose journal has entries and is owned by now; `None` if it was sealed, and only the journal was left.
    fn resume(
        files: &Arc<Files>,
        journal: OpenFile,
        name: &str,
        plan: &PlanHash,
        interval: Duration,
        visit: &mut Visit<'_>,
    ) -> Result<Option<(Self, u64)>, StoreError> {
        let data = layout::data_of_journal(journal.path());
        let Some(data) = files.open_if_there(&data, OpenMode::Change)? else {
            remove(files, &journal)?;
            return Ok(None);
        };
        for (file, kind) in [(&journal, FileKind::Journal), (&data, FileKind::Data)] {
            header::check(kind, &file.read_start(HEADER_BYTES)?, file.path(), plan)?;
        }
        let Replayed { entries: journaled, end, dropped } = replay(&journal, &data, visit)?;
        // Durable before anything is added: else an old entry could come back behind a new one.
        journal.set_length(journal_bytes(journaled))?;
        journal.sync()?;
        data.set_length(end)?;
        data.sync()?;
        let part = Self::new(name, data, journal, interval, end, journaled);
        Ok(Some((part, dropped)))
    }

    fn new(
        name: &str,
        data: OpenFile,
        journal: OpenFile,
        interval: Duration,
        end: u64,
        journaled: u64,
    ) -> Self {
        Self {
            name: name.to_owned(),
            data,
            journal,
            interval,
            end: AtomicU64::new(end),
            pending: Mutex::default(),
            journaled: Mutex::new(journaled),
            synced_at: Mutex::new(Instant::now()),
            failed: OnceLock::new(),
        }
    }

    /// The file with its artifacts.
    pub(crate) fn data(&self) -> &OpenFile {
        &self.data
    }

    /// Adds an artifact, and makes durable what is there if the last time is long ago and nobody else is at it.
    pub(crate) fn put(
        &self,
        index: &RwLock<Index>,
        key: Key,
        bytes: &[u8],
    ) -> Result<(), StoreError> {
        self.check_not_failed()?;
        let too_large = |what, length, limit| StoreError::TooLarge {
            path: self.data.path().to_owned(),
            what,
            length,
            limit,
        };
        let length = u32::try_from(bytes.len()).map_err(|_| {
            too_large("an artifact of so many bytes", bytes.len() as u64, u64::from(u32::MAX))
        })?;
        let crc = crc32fast::hash(bytes);
        // Reserve first, write outside any lock: threads do not wait for each other's disk.
        let offset = self.end.fetch_add(u64::from(length), Ordering::Relaxed);
        if offset + u64::from(length) >= OFFSET_LIMIT {
            return Err(too_large("so many bytes in one part", offset, OFFSET_LIMIT));
        }
        self.data.write_all_at(bytes, offset)?;
        {
            // Nobody sees the artifact before its entry is in line: whatever is made from it gets a later entry.
            let mut pending = locked(&self.pending);
            let place = Location { part: OPEN_PART, offset, length, crc };
            if index.write().unwrap_or_else(PoisonError::into_inner).insert(key, place) {
                pending.push(Entry { key, offset, length, crc });
            }
        }
        if locked(&self.synced_at).elapsed() < self.interval {
            return Ok(());
        }
        match self.journaled.try_lock() {
            Ok(journaled) => self.sync(journaled),
            Err(TryLockError::Poisoned(poisoned)) => self.sync(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => Ok(()),
        }
    }

    /// Makes durable all that was put before.
    pub(crate) fn flush(&self) -> Result<(), StoreError> {
        self.sync(locked(&self.journaled))
    }

    fn sync(&self, mut journaled: MutexGuard<'_, u64>) -> Result<(), StoreError> {
        self.check_not_failed()?;
        // All of these are written: an entry gets here after its data.
        let batch = mem::take(&mut *locked(&self.pending));
        if !batch.is_empty() {
            self.journal(&batch, *journaled)
                .inspect_err(|error| self.give_up(error.to_string()))?;
            *journaled += batch.len() as u64;
        }
        *locked(&self.synced_at) = Instant::now();
        Ok(())
    }

    /// Data first, then the entries that name it.
    fn journal(&self, batch: &[Entry], journaled: u64) -> Result<(), StoreError> {
        for file in [&self.data, &self.journal] {
            if !file.is_in_place()? {
                return Err(StoreError::Gone { path: file.path().to_owned() });
            }
        }
        let bytes: Vec<u8> = batch
            .iter()
            .zip(journaled..)
            .flat_map(|(entry, number)| entry.encode(number))
            .collect();
        self.data.sync()?;
        self.journal.write_all_at(&bytes, journal_bytes(journaled))?;
        self.journal.sync()
    }

    /// From here on nothing is kept any more, because of `cause`.
    pub(crate) fn give_up(&self, cause: String) {
        // The first cause is the one to be told.
        let _ = self.failed.set(cause);
    }

    /// Removes the part.
    pub(crate) fn abandon(self) -> Result<(), StoreError> {
        self.give_up("the part was given up".to_owned());
        remove(self.data.files(), &self.journal)
    }

    fn check_not_failed(&self) -> Result<(), StoreError> {
        self.failed.get().map_or(Ok(()), |cause| {
            Err(StoreError::Failed { path: self.data.path().to_owned(), cause: cause.clone() })
        })
    }

    /// Ends the part, of which `index` says what it holds. Returns where it is now; `None` if it holds nothing, and is removed.
    pub(crate) fn seal(self, folder: &Path, index: &Index) -> Result<Option<PathBuf>, StoreError> {
        self.flush()?;
        let files = self.data.files();
        let mut entries = index
            .iter()
            .filter(|(_, place)| place.part == OPEN_PART)
            .map(|(key, Location { offset, length, crc, .. })| Entry { key, offset, length, crc })
            .peekable();
        let path = if entries.peek().is_none() {
            files.remove(self.data.path())?;
            None
        } else {
            let end = self.end.load(Ordering::Relaxed);
            Some(sealed_part::seal(&self.data, folder, &self.name, entries, end)?)
        };
        files.remove(self.journal.path())?;
        Ok(path)
    }
}

impl Drop for OpenPart {
    /// Keeps what was put since the last time. That it may fail is no loss: the work of the last seconds is done again.
    fn drop(&mut self) {
        let _ = self.flush();
    }
}

/// Removes both files of a part that is owned. The journal goes last: data without one is nobody's.
fn remove(files: &Arc<Files>, journal: &OpenFile) -> Result<(), StoreError> {
    files.remove(&layout::data_of_journal(journal.path()))?;
    files.remove(journal.path())
}

/// Removes what dead processes left of parts whose journal is not there: data that nothing tells the meaning of.
pub(crate) fn remove_data_without_journal(
    files: &Arc<Files>,
    folder: &Path,
) -> Result<(), StoreError> {
    let found = layout::look(files, folder)?.unwrap_or_default();
    for name in found.of(layout::Role::Data) {
        let data = folder.join(name);
        // A living owner has made the journal first, and locked it; it is there while the data is.
        if !files.exists(&layout::journal_of_data(&data))? {
            files.remove(&data)?;
        }
    }
    Ok(())
}

/// What was found in a journal.
struct Replayed {
    /// How many entries are right.
    entries: u64,
    /// Where their last artifact ends.
    end: u64,
    /// How many more there were.
    dropped: u64,
}

/// Reads a journal up to the first entry that is torn or whose artifact is not what was put; hands out the entries before it.
///
/// Nothing after it is kept, even if it is whole: it may have been made from what is lost, or be the mark that says that all before it is
/// there.
fn replay(
    journal: &OpenFile,
    data: &OpenFile,
    visit: &mut Visit<'_>,
) -> Result<Replayed, StoreError> {
    const ENTRIES_AT_ONCE: u64 = 2048;
    let data_end = data.length()?;
    let journal_end = journal.length()?;
    let count = journal_end.saturating_sub(HEADER_BYTES).div_ceil(ENTRY_BYTES as u64);
    let (mut entries, mut end) = (0, HEADER_BYTES);
    let (mut bytes, mut artifact) = (Vec::new(), Vec::new());
    'journal: while entries < count {
        let from = journal_bytes(entries);
        bytes.resize((journal_end - from).min(ENTRIES_AT_ONCE * ENTRY_BYTES as u64) as usize, 0);
        journal.read_exact_at(&mut bytes, from)?;
        for entry in bytes.chunks(ENTRY_BYTES) {
            let Some(entry) = Entry::decode(entries, entry, data_end) else { break 'journal };
            artifact.resize(entry.length as usize, 0);
            data.read_exact_at(&mut artifact, entry.offset)?;
            if crc32fast::hash(&artifact) != entry.crc {
                break 'journal;
            }
            visit(data.path(), entry)?;
            entries += 1;
            end = end.max(entry.offset + u64::from(entry.length));
        }
    }
    Ok(Replayed { entries, end, dropped: count - entries })
}

/// The length of a journal of so many entries.
fn journal_bytes(entries: u64) -> u64 {
    HEADER_BYTES + entries * ENTRY_BYTES as u64
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
