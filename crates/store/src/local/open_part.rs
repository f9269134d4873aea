//! The part that is being written: artifacts one after another in a data file, and a journal of
//! them.
//!
//! The journal never refers to data that may be missing: first the data is made durable, then the
//! entries are written, then the entries are made durable. So after a crash the journal is correct
//! up to some entry. The rest is truncated at the next start.

use std::{
    mem,
    path::{Path, PathBuf},
    sync::{
        Arc, Mutex, MutexGuard, OnceLock, PoisonError, RwLock, TryLockError,
        atomic::{AtomicU64, Ordering},
    },
    time::{Duration, Instant},
};

use corniche_work::locked;

use crate::{
    ArtifactKey, OpenMode, PartFile as _, PlanHash, StoreError,
    files::{Files, OpenFile},
    local::{
        entry::{ArtifactEntry, ENTRY_BYTES, Visit},
        header::{self, FileKind, HEADER_BYTES},
        index::{ArtifactLocation, Index, OFFSET_LIMIT, PART_LIMIT},
        layout, lock, sealed_part,
    },
};

/// The number of the open part in the index.
pub(crate) const OPEN_PART: u32 = PART_LIMIT - 1;

/// A part to which any number of threads add artifacts.
#[derive(Debug)]
pub(crate) struct OpenPart {
    name: String,
    data: OpenFile,
    journal: OpenFile,
    interval: Duration,
    /// The offset of the next artifact in the data file.
    end: AtomicU64,
    /// Entries of artifacts that are written, in the order of storing, but not in the journal yet.
    pending: Mutex<Vec<ArtifactEntry>>,
    /// Number of entries in the journal. The thread that syncs holds it.
    journaled: Mutex<u64>,
    synced_at: Mutex<Instant>,
    /// Set after a failed sync: the state of the unsynced writes is unknown, so nothing may rely on
    /// them. The text is the cause.
    failed: OnceLock<String>,
}

impl OpenPart {
    /// Resumes a part that a dead process left, or creates one. Also returns the number of
    /// truncated entries: incomplete, of a damaged artifact, or after such an entry.
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
        for journal in found.files_with_role(layout::Role::Journal) {
            if layout::part_of_journal(journal) == Some(name)
                && let Some(journal) = lock::adopt(files, &folder.join(journal))?
            {
                left.push((journal.length()?, journal));
            }
        }
        // If the part was begun more than once, resume the one with the most artifacts.
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

    /// Resumes a part whose journal has entries and is now owned by this process; `None` if the
    /// part was sealed, and only the journal is left.
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
        // This must be durable before anything is added: otherwise an old entry could reappear
        // after a new one.
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

    /// The file with the artifacts.
    pub(crate) fn data(&self) -> &OpenFile {
        &self.data
    }

    /// Adds an artifact, and syncs if the last sync is long ago and no other thread is syncing.
    pub(crate) fn put(
        &self,
        index: &RwLock<Index>,
        key: ArtifactKey,
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
        // Reserve space first, write without a lock: threads do not wait for each other's disk
        // writes.
        let offset = self.end.fetch_add(u64::from(length), Ordering::Relaxed);
        if offset + u64::from(length) >= OFFSET_LIMIT {
            return Err(too_large("so many bytes in one part", offset, OFFSET_LIMIT));
        }
        self.data.write_all_at(bytes, offset)?;
        {
            // No thread sees the artifact before its entry is pending: the entry of everything that
            // is computed from it comes later.
            let mut pending = locked(&self.pending);
            let place = ArtifactLocation { part: OPEN_PART, offset, length, crc };
            if index.write().unwrap_or_else(PoisonError::into_inner).insert(key, place) {
                pending.push(ArtifactEntry { key, offset, length, crc });
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

    /// Makes all stored artifacts durable.
    pub(crate) fn flush(&self) -> Result<(), StoreError> {
        self.sync(locked(&self.journaled))
    }

    fn sync(&self, mut journaled: MutexGuard<'_, u64>) -> Result<(), StoreError> {
        self.check_not_failed()?;
        // The data of all these entries is written: an entry is added after its data.
        let batch = mem::take(&mut *locked(&self.pending));
        if !batch.is_empty() {
            self.journal(&batch, *journaled)
                .inspect_err(|error| self.give_up(error.to_string()))?;
            *journaled += batch.len() as u64;
        }
        *locked(&self.synced_at) = Instant::now();
        Ok(())
    }

    /// Syncs the data first, then the entries that refer to it.
    fn journal(&self, batch: &[ArtifactEntry], journaled: u64) -> Result<(), StoreError> {
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

    /// Stops storing: from now on, every call fails with `cause`.
    pub(crate) fn give_up(&self, cause: String) {
        // Only the first cause is reported.
        let _ = self.failed.set(cause);
    }

    /// Deletes the part.
    pub(crate) fn abandon(self) -> Result<(), StoreError> {
        self.give_up("the part was abandoned".to_owned());
        remove(self.data.files(), &self.journal)
    }

    fn check_not_failed(&self) -> Result<(), StoreError> {
        self.failed.get().map_or(Ok(()), |cause| {
            Err(StoreError::Failed { path: self.data.path().to_owned(), cause: cause.clone() })
        })
    }

    /// Seals the part, whose content is in `index`. Returns its path; `None` if it is empty, and is
    /// deleted.
    pub(crate) fn seal(self, folder: &Path, index: &Index) -> Result<Option<PathBuf>, StoreError> {
        self.flush()?;
        let files = self.data.files();
        let mut entries = index
            .iter()
            .filter(|(_, place)| place.part == OPEN_PART)
            .map(|(key, ArtifactLocation { offset, length, crc, .. })| ArtifactEntry {
                key,
                offset,
                length,
                crc,
            })
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
    /// Makes the artifacts since the last sync durable. A failure is acceptable: the work of the
    /// last seconds is repeated.
    fn drop(&mut self) {
        let _ = self.flush();
    }
}

/// Deletes both files of a part that this process owns. The journal is deleted last: data without a
/// journal belongs to nobody.
fn remove(files: &Arc<Files>, journal: &OpenFile) -> Result<(), StoreError> {
    files.remove(&layout::data_of_journal(journal.path()))?;
    files.remove(journal.path())
}

/// Deletes the data files that dead processes left without a journal: nothing describes their
/// content.
pub(crate) fn remove_data_without_journal(
    files: &Arc<Files>,
    folder: &Path,
) -> Result<(), StoreError> {
    let found = layout::look(files, folder)?.unwrap_or_default();
    for name in found.files_with_role(layout::Role::Data) {
        let data = folder.join(name);
        // A living owner has created and locked the journal first; it exists as long as the data.
        if !files.exists(&layout::journal_of_data(&data))? {
            files.remove(&data)?;
        }
    }
    Ok(())
}

/// The result of reading a journal.
struct Replayed {
    /// Number of valid entries.
    entries: u64,
    /// The end of their last artifact.
    end: u64,
    /// Number of dropped entries.
    dropped: u64,
}

/// Reads a journal up to the first entry that is incomplete or whose artifact is damaged; passes on
/// the entries before it.
///
/// All later entries are dropped, even if they are intact: they may have been computed from the
/// lost ones, or be the mark which says that everything before it is complete.
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
            let Some(entry) = ArtifactEntry::decode(entries, entry, data_end) else {
                break 'journal;
            };
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

/// The length of a journal with this number of entries.
fn journal_bytes(entries: u64) -> u64 {
    HEADER_BYTES + entries * ENTRY_BYTES as u64
}
