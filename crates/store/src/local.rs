//! A store in a folder.
//!
//! ```text
//! FOLDER/store                       header: format, plan's hash                    binding.rs, header.rs
//!        plan.json                   the plan, as the caller wrote it
//!        lock                        held by the process that works here            lock.rs
//!        NAME.PID-RANDOM.data        an open part: artifacts, one after another     open_part.rs
//!        NAME.PID-RANDOM.journal     the list of its durable artifacts              entry.rs
//!        parts/NAME.DIGEST.part      a sealed part: artifacts, then their list      sealed_part.rs
//!        PID-RANDOM.scratch          scratch space                                  scratch.rs
//! ```
//!
//! The order of durability: the data of an artifact before its journal entry; a whole part before
//! its name; the plan before the header. So after a crash at any moment, everything in the store is
//! correct, and only the last seconds are missing.

mod binding;
mod entry;
mod folder;
mod header;
mod index;
mod layout;
mod lock;
mod open_part;
mod scratch;
mod sealed_part;

use std::{
    path::{Path, PathBuf},
    sync::{Arc, PoisonError, RwLock, RwLockReadGuard},
    time::Duration,
};

pub use binding::{plan_of_header, store_header};
pub use folder::Folder;
pub use header::VERSION as FORMAT_VERSION;
pub use layout::{PARTS as PARTS_NAME, PLAN as PLAN_NAME, STORE as STORE_NAME, part_of_sealed};
pub use scratch::LocalScratch;
pub use sealed_part::check_sealed;

use crate::{
    ArtifactKey, Artifacts, Disk, FolderItem, Hold, PartFile, PartsPlace, PlanHash, Publish,
    StoreError, StoredPlan,
    files::{Files, OpenFile},
};
use binding::FolderState;
use entry::ArtifactEntry;
use header::FileKind;
use index::{ArtifactLocation, Index};
use layout::Role;
use open_part::{OPEN_PART, OpenPart};

/// The default interval at which artifacts are made durable: a crash loses at most this much work.
pub const SYNC_INTERVAL: Duration = Duration::from_secs(2);

/// The name of the part of a whole build.
const BUILD: &str = "build";

/// Artifacts in files of a folder: one part that is being written, and sealed parts.
#[derive(Debug)]
pub struct LocalStore {
    files: Arc<Files>,
    index: RwLock<Index>,
    /// The sealed parts by their numbers in the index.
    sealed: Vec<Box<dyn PartFile>>,
    own: Option<Own>,
}

/// The part that is being written, and its folder.
#[derive(Debug)]
struct Own {
    folder: PathBuf,
    part: OpenPart,
    dropped: u64,
    /// Dropped last: until then no other process may use the folder.
    lock: OpenFile,
}

/// A part that [`LocalStore::open_places`] writes.
#[derive(Debug, Clone, Copy)]
pub struct OwnPart<'a> {
    /// The store's folder, which is created if it does not exist; the folder around it must exist.
    pub folder: &'a Path,
    /// The name of the part, for example step and subtree. Letters, digits, `-` and `_`.
    pub name: &'a str,
    /// The plan to which the store is bound.
    pub plan: &'a StoredPlan,
    /// The interval at which artifacts are made durable.
    pub interval: Duration,
}

/// The sealed parts that [`LocalStore::open_places`] reads.
#[derive(Clone, Copy)]
pub struct SealedParts<'a> {
    /// The places that contain them.
    pub places: &'a [&'a dyn PartsPlace],
    /// Selects the needed parts by their names without digest. Other parts are not even opened,
    /// including those in the folder of the own part.
    pub is_needed: &'a dyn Fn(&str) -> bool,
}

/// The part that a process writes, and the lock on its folder.
struct LockedPart<'a> {
    folder: &'a Path,
    name: &'a str,
    lock: OpenFile,
}

impl LocalStore {
    /// Returns the plan to which the store in `folder` is bound; `None` if the folder does not
    /// exist, is empty, or only has the remains of creating or deleting a store. Changes nothing.
    ///
    /// # Errors
    /// [`StoreError::NotAStore`] if it contains something else; [`StoreError::OtherVersion`];
    /// [`StoreError::Damaged`].
    pub fn stored_plan(
        disk: Arc<dyn Disk>,
        folder: &Path,
    ) -> Result<Option<StoredPlan>, StoreError> {
        Folder::new(disk, folder).stored_plan()
    }

    /// Creates a store for a single build, in a folder that is empty or does not exist. The folder
    /// around it must exist.
    ///
    /// # Errors
    /// [`StoreError::Exists`], [`StoreError::NotAStore`] or [`StoreError::Locked`], and when the
    /// disk fails.
    pub fn create(
        disk: Arc<dyn Disk>,
        folder: &Path,
        plan: &StoredPlan,
        interval: Duration,
    ) -> Result<Self, StoreError> {
        let files = Files::new(disk);
        refuse_store(&files, folder)?;
        files.create_folder(folder)?;
        let lock = lock::lock_store(&files, folder, Hold::Alone)?;
        // Another process may have created a store before this process got the lock.
        refuse_store(&files, folder)?;
        remove_own_files(&files, folder)?;
        binding::bind(&files, folder, plan)?;
        Self::assemble(
            files,
            NO_PARTS,
            Some(LockedPart { folder, name: BUILD, lock }),
            &plan.hash,
            interval,
        )
    }

    /// Resumes the store of a build. Incomplete artifacts of a crash are truncated
    /// ([`Self::repaired`]).
    ///
    /// # Errors
    /// [`StoreError::NoStore`], [`StoreError::OtherPlan`], [`StoreError::Locked`] and others, and
    /// when the disk fails.
    pub fn open(
        disk: Arc<dyn Disk>,
        folder: &Path,
        plan: &PlanHash,
        interval: Duration,
    ) -> Result<Self, StoreError> {
        let files = Files::new(disk);
        binding::check_hash(&files, folder, plan)?;
        let lock = lock::lock_store(&files, folder, Hold::Alone)?;
        binding::check_hash(&files, folder, plan)?;
        let place = Folder::at_path(&files, folder);
        let sealed = SealedParts { places: &[&place], ..NO_PARTS };
        Self::assemble(
            files,
            sealed,
            Some(LockedPart { folder, name: BUILD, lock }),
            plan,
            interval,
        )
    }

    /// Opens the sealed parts of several places together, and a part to write if requested. Without
    /// that part the store is read-only. The sealed parts in the own part's folder are read, too.
    /// With `Hold::Shared` other processes can write their parts in that folder at the same time.
    ///
    /// # Errors
    /// [`StoreError::NoStore`], [`StoreError::OtherPlan`], [`StoreError::OtherVersion`] or
    /// [`StoreError::Damaged`] with the name of the part; [`StoreError::Differs`] if two parts
    /// contradict each other; [`StoreError::Locked`] if the folder of the own part is in use; and
    /// when the disk or a place fails.
    pub fn open_places(
        disk: Arc<dyn Disk>,
        sealed: SealedParts<'_>,
        plan: &PlanHash,
        own: Option<(OwnPart<'_>, Hold)>,
    ) -> Result<Self, StoreError> {
        let files = Files::new(disk);
        let SealedParts { places, is_needed } = sealed;
        let Some((own, hold)) = own else {
            check_plans(places, plan)?;
            return Self::assemble(files, sealed, None, plan, SYNC_INTERVAL);
        };
        layout::check_part_name(own.name)?;
        binding::state(&files, own.folder)?;
        files.create_folder(own.folder)?;
        let lock = lock::lock_store(&files, own.folder, hold)?;
        if !matches!(binding::state(&files, own.folder)?, FolderState::Store) {
            binding::bind(&files, own.folder, own.plan)?;
        }
        let own_folder = Folder::at_path(&files, own.folder);
        let mut places = places.to_vec();
        if !places.iter().any(|place| place.name() == own.folder) {
            places.push(&own_folder);
        }
        check_plans(&places, plan)?;
        let sealed = SealedParts { places: &places, is_needed };
        Self::assemble(
            files,
            sealed,
            Some(LockedPart { folder: own.folder, name: own.name, lock }),
            plan,
            own.interval,
        )
    }

    /// Reads the lists of the places and opens the own part.
    fn assemble(
        files: Arc<Files>,
        parts: SealedParts<'_>,
        own: Option<LockedPart<'_>>,
        plan: &PlanHash,
        interval: Duration,
    ) -> Result<Self, StoreError> {
        let mut index = Index::default();
        let mut sealed = Vec::<Box<dyn PartFile>>::new();
        for place in parts.places {
            for name in place.parts()? {
                if !layout::part_of_sealed(&name).is_some_and(parts.is_needed) {
                    continue;
                }
                let file = place.open(&name)?;
                let number = part_number(file.path(), sealed.len())?;
                let visit = &mut |path: &Path, entry| add(&mut index, &sealed, number, path, entry);
                sealed_part::read_list(&*file, plan, visit)?;
                sealed.push(file);
            }
        }
        let mut store = Self { files, index: RwLock::default(), sealed, own: None };
        if let Some(LockedPart { folder, name, lock }) = own {
            open_part::remove_data_without_journal(&store.files, folder)?;
            remove_scratch(&store.files, folder)?;
            let visit =
                &mut |path: &Path, entry| add(&mut index, &store.sealed, OPEN_PART, path, entry);
            let (part, dropped) =
                OpenPart::open(&store.files, folder, name, plan, interval, visit)?;
            store.own = Some(Own { folder: folder.to_owned(), part, dropped, lock });
        }
        store.index = RwLock::new(index);
        Ok(store)
    }

    /// Makes all stored artifacts durable.
    ///
    /// # Errors
    /// When the disk fails; [`StoreError::Gone`] if the store was deleted.
    pub fn flush(&self) -> Result<(), StoreError> {
        self.own.as_ref().map_or(Ok(()), |own| own.part.flush())
    }

    /// Stops storing: from now on, nothing more is written, even when the store is dropped. For a
    /// store that is deleted together with its folder.
    pub fn give_up(&self) {
        if let Some(own) = &self.own {
            own.part.give_up("the store was abandoned".to_owned());
        }
    }

    /// Seals the own part: makes it durable under a name that depends on its content, and returns
    /// the path; `None` if nothing was stored. If the same part already exists, this copy is
    /// deleted.
    ///
    /// # Errors
    /// [`StoreError::ReadOnly`]; when the disk fails. The part then stays open and can be resumed.
    pub fn seal(mut self) -> Result<Option<PathBuf>, StoreError> {
        let own = self.take_own()?;
        own.part.seal(&own.folder, &self.index())
    }

    /// Seals the own part like [`Self::seal`] and sends it to a place, together with the parts that
    /// earlier processes left sealed in the folder. Returns the location of the part; `None` if
    /// there was nothing to send. If sending fails, everything stays in the folder, and publishing
    /// the same part again sends it. Parts that were sent are deleted from the folder, which can
    /// then be [discarded](Self::discard).
    ///
    /// # Errors
    /// [`StoreError::ReadOnly`]; when the disk or the place fails.
    pub fn publish(
        mut self,
        place: &dyn Publish,
        should_stop: &dyn Fn() -> bool,
    ) -> Result<Option<PathBuf>, StoreError> {
        let own = self.take_own()?;
        own.part.seal(&own.folder, &self.index())?;
        let mut published = None;
        for path in sealed_paths(&self.files, &own.folder)? {
            published = Some(place.publish(&path, should_stop)?);
            self.files.remove(&path)?;
        }
        Ok(published)
    }

    /// Abandons the own part: its artifacts are deleted. Sealed parts do not change.
    ///
    /// # Errors
    /// [`StoreError::ReadOnly`]; when the disk fails.
    pub fn abandon(mut self) -> Result<(), StoreError> {
        let own = self.take_own()?;
        own.part.abandon()
    }

    /// Creates scratch space in the store's folder.
    ///
    /// # Errors
    /// [`StoreError::ReadOnly`] without an own part; when the disk fails.
    pub fn scratch(&self) -> Result<LocalScratch, StoreError> {
        let own = self.own.as_ref().ok_or_else(|| self.read_only())?;
        let file = lock::create_owned(&self.files, |suffix| layout::scratch(&own.folder, suffix))?;
        Ok(LocalScratch::new(file))
    }

    /// Deletes the store. Only files that a store creates are deleted: other files and their folder
    /// stay, and their paths are returned.
    ///
    /// # Errors
    /// [`StoreError::ReadOnly`] without an own part; [`StoreError::Locked`] if other processes
    /// write parts here; when the disk fails.
    pub fn remove(mut self) -> Result<Vec<PathBuf>, StoreError> {
        let own = self.take_own()?;
        if !own.lock.try_lock(Hold::Alone)? {
            let owner = "another process that writes a part".to_owned();
            return Err(StoreError::Locked { path: own.folder.clone(), owner });
        }
        own.part.give_up("the store was removed".to_owned());
        remove_all(&self.files, &own.folder)
    }

    /// Deletes the store in a folder without opening it: the store may be damaged, or have another
    /// plan or version. If the folder contains something else, nothing is deleted, and the paths of
    /// the other files are returned.
    ///
    /// # Errors
    /// [`StoreError::NotAStore`], [`StoreError::Locked`], and when the disk fails.
    pub fn discard(disk: Arc<dyn Disk>, folder: &Path) -> Result<Vec<PathBuf>, StoreError> {
        let files = Files::new(disk);
        binding::clear_damaged_lock(&files, folder)?;
        if matches!(binding::state(&files, folder)?, FolderState::Absent) {
            return Ok(Vec::new());
        }
        let _lock = lock::lock_store(&files, folder, Hold::Alone)?;
        let foreign = foreign(&files, folder)?;
        if foreign.is_empty() { remove_all(&files, folder) } else { Ok(foreign) }
    }

    /// Number of artifacts that were truncated when the own part was opened: incomplete, damaged,
    /// or stored after such an artifact.
    #[must_use]
    pub fn repaired(&self) -> u64 {
        self.own.as_ref().map_or(0, |own| own.dropped)
    }

    fn index(&self) -> RwLockReadGuard<'_, Index> {
        self.index.read().unwrap_or_else(PoisonError::into_inner)
    }

    fn take_own(&mut self) -> Result<Own, StoreError> {
        self.own.take().ok_or_else(|| self.read_only())
    }

    fn read_only(&self) -> StoreError {
        let path = self.sealed.first().map(|file| file.path().to_owned()).unwrap_or_default();
        StoreError::ReadOnly { path }
    }
}

impl Artifacts for LocalStore {
    fn put(&self, key: ArtifactKey, bytes: &[u8]) -> Result<(), StoreError> {
        if self.has(key) {
            return Ok(());
        }
        let own = self.own.as_ref().ok_or_else(|| self.read_only())?;
        own.part.put(&self.index, key, bytes)
    }

    fn get(&self, key: ArtifactKey) -> Result<Option<Vec<u8>>, StoreError> {
        let Some(place) = self.index().get(key) else { return Ok(None) };
        let (is_sealed, file) = match (&self.own, self.sealed.get(place.part as usize)) {
            (_, Some(file)) => (true, &**file),
            (Some(own), None) => (false, own.part.data() as &dyn PartFile),
            (None, None) => return Ok(None),
        };
        let mut bytes = vec![0; place.length as usize];
        file.read_exact_at(&mut bytes, place.offset)?;
        if crc32fast::hash(&bytes) != place.crc {
            let ArtifactKey { kind, item } = key;
            let what = format!(
                "artifact {item} of kind {kind} does not have the checksum with which it was stored"
            );
            return Err(if is_sealed {
                FileKind::Sealed.damaged(file.path(), &what)
            } else {
                // The damaged artifact is truncated when the part is opened again.
                let what = format!("{what}; run the same command again (build: with --resume)");
                StoreError::Damaged { path: file.path().to_owned(), what }
            });
        }
        Ok(Some(bytes))
    }

    fn length(&self, key: ArtifactKey) -> Result<Option<u64>, StoreError> {
        Ok(self.index().get(key).map(|place| u64::from(place.length)))
    }

    fn has(&self, key: ArtifactKey) -> bool {
        self.index().get(key).is_some()
    }

    fn items(&self, kind: u8) -> Vec<u64> {
        self.index().items(kind)
    }
}

/// No places, and every part is needed: the default for reading all parts of some places.
const NO_PARTS: SealedParts<'static> = SealedParts { places: &[], is_needed: &|_| true };

/// Fails unless all places are bound to this plan.
fn check_plans(places: &[&dyn PartsPlace], plan: &PlanHash) -> Result<(), StoreError> {
    for place in places {
        let path = place.name().to_owned();
        match place.stored_plan()? {
            Some(stored) if stored.hash == *plan => {}
            Some(_) => return Err(StoreError::OtherPlan { path }),
            None => return Err(StoreError::NoStore { path }),
        }
    }
    Ok(())
}

/// Adds an entry of a part. If another part has the same artifact, both must be equal.
fn add(
    index: &mut Index,
    sealed: &[Box<dyn PartFile>],
    part: u32,
    path: &Path,
    entry: ArtifactEntry,
) -> Result<(), StoreError> {
    let ArtifactEntry { key, offset, length, crc } = entry;
    if index.insert(key, ArtifactLocation { part, offset, length, crc }) {
        return Ok(());
    }
    match index.get(key) {
        Some(place) if place.part != part && (place.length, place.crc) != (length, crc) => {
            let first = sealed.get(place.part as usize).map_or(path, |file| file.path());
            Err(StoreError::Differs {
                kind: key.kind,
                item: key.item,
                first: first.to_owned(),
                second: path.to_owned(),
            })
        }
        _ => Ok(()),
    }
}

/// Returns the number of the next sealed part.
fn part_number(path: &Path, count: usize) -> Result<u32, StoreError> {
    match u32::try_from(count) {
        Ok(number) if number < OPEN_PART => Ok(number),
        _ => Err(StoreError::TooLarge {
            path: path.to_owned(),
            what: "one more sealed part",
            length: count as u64,
            limit: u64::from(OPEN_PART),
        }),
    }
}

/// Fails if a folder already is a store or contains something else.
fn refuse_store(files: &Arc<Files>, folder: &Path) -> Result<(), StoreError> {
    match binding::state(files, folder)? {
        FolderState::Store => Err(StoreError::Exists { path: folder.to_owned() }),
        FolderState::Absent | FolderState::Free => Ok(()),
    }
}

/// Returns the paths of the sealed parts of a folder, by name.
fn sealed_paths(files: &Arc<Files>, folder: &Path) -> Result<Vec<PathBuf>, StoreError> {
    let names = Folder::at_path(files, folder).parts()?;
    Ok(names.into_iter().map(|name| folder.join(layout::PARTS).join(name)).collect())
}

/// Deletes the scratch space of dead processes.
fn remove_scratch(files: &Arc<Files>, folder: &Path) -> Result<(), StoreError> {
    let found = layout::look(files, folder)?.unwrap_or_default();
    for name in found.files_with_role(Role::Scratch) {
        let path = folder.join(name);
        if lock::adopt(files, &path)?.is_some() {
            files.remove(&path)?;
        }
    }
    Ok(())
}

/// Deletes a store whose lock is held; returns the paths of files that no store creates.
fn remove_all(files: &Arc<Files>, folder: &Path) -> Result<Vec<PathBuf>, StoreError> {
    let mut left = remove_own_files(files, folder)?;
    // The lock proves that the other files belong to the store. After a crash none of them may
    // exist without the lock.
    files.sync_folder(folder)?;
    files.remove(&folder.join(layout::LOCK))?;
    if left.is_empty() {
        // Another process may have created something in between: then the folder is not empty, and
        // stays.
        if let Err(error) = files.remove_folder(folder) {
            left = foreign(files, folder)?;
            if left.is_empty() {
                return Err(error);
            }
        }
    }
    Ok(left)
}

/// Returns the files of a store's folder that no store creates.
fn foreign(files: &Arc<Files>, folder: &Path) -> Result<Vec<PathBuf>, StoreError> {
    let found = layout::look(files, folder)?.unwrap_or_default();
    let mut foreign: Vec<PathBuf> = found.foreign.iter().map(|name| folder.join(name)).collect();
    if found.files_with_role(Role::Parts).next().is_some() {
        let parts = folder.join(layout::PARTS);
        let is_part = |entry: &FolderItem| {
            !entry.is_folder
                && entry.name.to_str().is_some_and(|n| layout::part_of_sealed(n).is_some())
        };
        let rest = files.list(&parts)?.unwrap_or_default().into_iter();
        foreign.extend(rest.filter(|entry| !is_part(entry)).map(|entry| parts.join(entry.name)));
    }
    Ok(foreign)
}

/// Deletes all files of a store except the lock; returns the other files of the folder. The header
/// is deleted before the plan: at any moment the folder is either a readable store, or not a store.
fn remove_own_files(files: &Arc<Files>, folder: &Path) -> Result<Vec<PathBuf>, StoreError> {
    let found = layout::look(files, folder)?.unwrap_or_default();
    let left = foreign(files, folder)?;
    let parts = folder.join(layout::PARTS);
    if found.files_with_role(Role::Parts).next().is_some() {
        for path in sealed_paths(files, folder)? {
            files.remove(&path)?;
        }
        if !left.iter().any(|path| path.starts_with(&parts)) {
            files.remove_folder(&parts)?;
        }
    }
    for (name, role) in &found.own {
        if !matches!(role, Role::Fixed | Role::Parts) {
            files.remove(&folder.join(name))?;
        }
    }
    if found.has(layout::STORE) {
        files.remove(&folder.join(layout::STORE))?;
        files.sync_folder(folder)?;
    }
    files.remove(&folder.join(layout::PLAN))?;
    Ok(left)
}
