//! A store in a folder.
//!
//! ```text
//! FOLDER/store                       header: format, plan's hash                    binding.rs, header.rs
//!        plan.json                   the plan, as the caller wrote it
//!        lock                        held by who works here                         lock.rs
//!        NAME.PID-RANDOM.data        an open part: artifacts, one after the other   open_part.rs
//!        NAME.PID-RANDOM.journal     what of them is durable                        entry.rs
//!        parts/NAME.DIGEST.part      a sealed part: artifacts, then their list      sealed_part.rs
//!        PID-RANDOM.scratch          scratch space                                  scratch.rs
//! ```
//!
//! What is durable when: the data of an artifact before the journal's entry of it; all of a part before its name; the plan before the header. So
//! after a crash at any moment, whatever is there is right, and only the last seconds are missing.

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
    Artifacts, Disk, Hold, Key, Listed, PartFile, PartsPlace, PlanHash, Publish, StoreError,
    StoredPlan,
    files::{Files, OpenFile},
};
use binding::FolderState;
use entry::Entry;
use header::FileKind;
use index::{Index, Location};
use layout::Role;
use open_part::{OPEN_PART, OpenPart};

/// How often artifacts are made durable, unless one asks for something else: this much work is lost at most.
pub const SYNC_INTERVAL: Duration = Duration::from_secs(2);

/// The name of the part that a whole build makes.
const BUILD: &str = "build";

/// Artifacts in files of a folder: one part that is being written, and sealed ones.
#[derive(Debug)]
pub struct LocalStore {
    files: Arc<Files>,
    index: RwLock<Index>,
    /// The sealed parts by their numbers in the index.
    sealed: Vec<Box<dyn PartFile>>,
    own: Option<Own>,
}

/// The part that is written, and where.
#[derive(Debug)]
struct Own {
    folder: PathBuf,
    part: OpenPart,
    dropped: u64,
    /// Dropped last: until then nobody else may touch the folder.
    lock: OpenFile,
}

/// A part to be written by [`LocalStore::open_places`].
#[derive(Debug, Clone, Copy)]
pub struct OwnPart<'a> {
    /// The store's folder; made where it is not there, within one that is.
    pub folder: &'a Path,
    /// What the part is: step and subtree, for instance. Letters, digits, `-` and `_`.
    pub name: &'a str,
    /// What the store is bound to.
    pub plan: &'a StoredPlan,
    /// How often artifacts are made durable.
    pub interval: Duration,
}

/// The sealed parts that [`LocalStore::open_places`] reads.
#[derive(Clone, Copy)]
pub struct SealedParts<'a> {
    /// Where they lie.
    pub places: &'a [&'a dyn PartsPlace],
    /// Which of them are needed, by their names without digest. The others are not even opened, and neither are those in the folder of the
    /// own part.
    pub is_needed: &'a dyn Fn(&str) -> bool,
}

impl LocalStore {
    /// The plan that the store in `folder` is bound to; `None` if the folder is not there, empty, or only what is left of making or removing a store.
    /// Changes nothing.
    ///
    /// # Errors
    /// [`StoreError::NotAStore`] if it holds something else; [`StoreError::OtherVersion`]; [`StoreError::Damaged`].
    pub fn stored_plan(
        disk: Arc<dyn Disk>,
        folder: &Path,
    ) -> Result<Option<StoredPlan>, StoreError> {
        Folder::new(disk, folder).stored_plan()
    }

    /// Makes a store for a build of its own, in a folder that is empty or not there. The folder around it must be there.
    ///
    /// # Errors
    /// [`StoreError::Exists`], [`StoreError::NotAStore`] or [`StoreError::Locked`], and where the disk fails.
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
        // Another may have made one before the lock was ours.
        refuse_store(&files, folder)?;
        remove_own_files(&files, folder)?;
        binding::bind(&files, folder, plan)?;
        Self::assemble(files, NO_PARTS, Some((folder, BUILD, lock)), &plan.hash, interval)
    }

    /// Goes on with the store of a build. What a crash left half is cut off ([`Self::repaired`]).
    ///
    /// # Errors
    /// [`StoreError::NoStore`], [`StoreError::OtherPlan`], [`StoreError::Locked`] and others, and where the disk fails.
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
        let place = Folder::of(&files, folder);
        let sealed = SealedParts { places: &[&place], ..NO_PARTS };
        Self::assemble(files, sealed, Some((folder, BUILD, lock)), plan, interval)
    }

    /// Opens the sealed parts of several places as one, and a part of its own to write if asked. Without one the store can only be read.
    /// The sealed parts in the own part's folder are read too. `Hold::Shared` lets other processes make their parts in that folder at the same
    /// time.
    ///
    /// # Errors
    /// [`StoreError::NoStore`], [`StoreError::OtherPlan`], [`StoreError::OtherVersion`] or [`StoreError::Damaged`] with the name of the part;
    /// [`StoreError::Differs`] where two parts contradict each other; [`StoreError::Locked`] where the folder of the own part is in use;
    /// and where the disk or a place fails.
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
        if !matches!(binding::state(&files, own.folder)?.0, FolderState::Store) {
            binding::bind(&files, own.folder, own.plan)?;
        }
        let own_folder = Folder::of(&files, own.folder);
        let mut places = places.to_vec();
        if !places.iter().any(|place| place.name() == own.folder) {
            places.push(&own_folder);
        }
        check_plans(&places, plan)?;
        let sealed = SealedParts { places: &places, is_needed };
        Self::assemble(files, sealed, Some((own.folder, own.name, lock)), plan, own.interval)
    }

    /// Reads what the places hold and opens the own part.
    fn assemble(
        files: Arc<Files>,
        parts: SealedParts<'_>,
        own: Option<(&Path, &str, OpenFile)>,
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
        if let Some((folder, name, lock)) = own {
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

    /// Makes durable all that was put before.
    ///
    /// # Errors
    /// Where the disk fails; [`StoreError::Gone`] if the store was removed.
    pub fn flush(&self) -> Result<(), StoreError> {
        self.own.as_ref().map_or(Ok(()), |own| own.part.flush())
    }

    /// From here on nothing is kept: dropping the store writes nothing more. For a store that is removed with its folder.
    pub fn give_up(&self) {
        if let Some(own) = &self.own {
            own.part.give_up("the store was given up".to_owned());
        }
    }

    /// Ends the own part: makes it durable under a name that says what it holds, and returns that; `None` if nothing was put. If the
    /// same part is there already, this copy is dropped.
    ///
    /// # Errors
    /// [`StoreError::ReadOnly`]; where the disk fails. The part then stays open and can be gone on with.
    pub fn seal(mut self) -> Result<Option<PathBuf>, StoreError> {
        let own = self.own.take().ok_or_else(|| self.read_only())?;
        own.part.seal(&own.folder, &self.index())
    }

    /// Ends the own part as [`Self::seal`] does, and sends it to a place, with whatever an earlier process left sealed in the folder. Returns where
    /// the part is then; `None` if there was nothing to send. If that fails, everything stays in the folder, and the same part sends it when it
    /// is published again. What is sent is removed; the folder can then be [discarded](Self::discard).
    ///
    /// # Errors
    /// [`StoreError::ReadOnly`]; where the disk or the place fails.
    pub fn publish(
        mut self,
        place: &dyn Publish,
        should_stop: &dyn Fn() -> bool,
    ) -> Result<Option<PathBuf>, StoreError> {
        let own = self.own.take().ok_or_else(|| self.read_only())?;
        own.part.seal(&own.folder, &self.index())?;
        let mut published = None;
        for path in sealed_paths(&self.files, &own.folder)? {
            published = Some(place.publish(&path, should_stop)?);
            self.files.remove(&path)?;
        }
        Ok(published)
    }

    /// Gives the own part up: what was put into it is removed. Sealed parts stay as they are.
    ///
    /// # Errors
    /// [`StoreError::ReadOnly`]; where the disk fails.
    pub fn abandon(mut self) -> Result<(), StoreError> {
        let own = self.own.take().ok_or_else(|| self.read_only())?;
        own.part.abandon()
    }

    /// Scratch space in the store's folder.
    ///
    /// # Errors
    /// [`StoreError::ReadOnly`] without a part of its own; where the disk fails.
    pub fn scratch(&self) -> Result<LocalScratch, StoreError> {
        let own = self.own.as_ref().ok_or_else(|| self.read_only())?;
        let file = lock::create_owned(&self.files, |suffix| layout::scratch(&own.folder, suffix))?;
        Ok(LocalScratch::new(file))
    }

    /// Removes the store. Only what a store makes is removed: where the folder holds something else, it stays, and what stays is returned.
    ///
    /// # Errors
    /// [`StoreError::ReadOnly`] without a part of its own; [`StoreError::Locked`] if others make parts here; where the disk fails.
    pub fn remove(mut self) -> Result<Vec<PathBuf>, StoreError> {
        let own = self.own.take().ok_or_else(|| self.read_only())?;
        if !own.lock.try_lock(Hold::Alone)? {
            let owner = "another process that makes a part".to_owned();
            return Err(StoreError::Locked { path: own.folder.clone(), owner });
        }
        own.part.give_up("the store was removed".to_owned());
        remove_all(&self.files, &own.folder)
    }

    /// Removes the store in a folder without opening it: it may be damaged, or of another plan or version. Where the folder holds something
    /// else, nothing is removed, and what it is is returned.
    ///
    /// # Errors
    /// [`StoreError::NotAStore`], [`StoreError::Locked`], and where the disk fails.
    pub fn discard(disk: Arc<dyn Disk>, folder: &Path) -> Result<Vec<PathBuf>, StoreError> {
        let files = Files::new(disk);
        binding::clear_damaged_lock(&files, folder)?;
        if matches!(binding::state(&files, folder)?.0, FolderState::Absent) {
            return Ok(Vec::new());
        }
        let _lock = lock::lock_store(&files, folder, Hold::Alone)?;
        let foreign = foreign(&files, folder)?;
        if foreign.is_empty() { remove_all(&files, folder) } else { Ok(foreign) }
    }

    /// How many artifacts were cut off when the own part was opened: torn, damaged, or put after such a one.
    #[must_use]
    pub fn repaired(&self) -> u64 {
        self.own.as_ref().map_or(0, |own| own.dropped)
    }

    fn index(&self) -> RwLockReadGuard<'_, Index> {
        self.index.read().unwrap_or_else(PoisonError::into_inner)
    }

    fn read_only(&self) -> StoreError {
        let path = self.sealed.first().map(|file| file.path().to_owned()).unwrap_or_default();
        StoreError::ReadOnly { path }
    }
}

impl Artifacts for LocalStore {
    fn put(&self, key: Key, bytes: &[u8]) -> Result<(), StoreError> {
        if self.has(key) {
            return Ok(());
        }
        let own = self.own.as_ref().ok_or_else(|| self.read_only())?;
        own.part.put(&self.index, key, bytes)
    }

    fn get(&self, key: Key) -> Result<Option<Vec<u8>>, StoreError> {
        let Some(place) = self.index().get(key) else { return Ok(None) };
        let (is_sealed, file) = match (&self.own, self.sealed.get(place.part as usize)) {
            (_, Some(file)) => (true, &**file),
            (Some(own), None) => (false, own.part.data() as &dyn PartFile),
            (None, None) => return Ok(None),
        };
        let mut bytes = vec![0; place.length as usize];
        file.read_exact_at(&mut bytes, place.offset)?;
        if crc32fast::hash(&bytes) != place.crc {
            let Key { kind, item } = key;
            let what =
                format!("artifact {item} of kind {kind} has another checksum than when it was put");
            return Err(if is_sealed {
                FileKind::Sealed.damaged(file.path(), &what)
            } else {
                // What is damaged is cut off when the part is opened again.
                let what = format!("{what}; run the same command again (build: with --resume)");
                StoreError::Damaged { path: file.path().to_owned(), what }
            });
        }
        Ok(Some(bytes))
    }

    fn length(&self, key: Key) -> Result<Option<u64>, StoreError> {
        Ok(self.index().get(key).map(|place| u64::from(place.length)))
    }

    fn has(&self, key: Key) -> bool {
        self.index().get(key).is_some()
    }

    fn items(&self, kind: u8) -> Vec<u64> {
        self.index().items(kind)
    }
}

/// No part; for all of some places.
const NO_PARTS: SealedParts<'static> = SealedParts { places: &[], is_needed: &|_| true };

/// Fails unless all places are of this plan.
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

/// Adds an entry of a part. What another part holds too must be the same there.
fn add(
    index: &mut Index,
    sealed: &[Box<dyn PartFile>],
    part: u32,
    path: &Path,
    entry: Entry,
) -> Result<(), StoreError> {
    let Entry { key, offset, length, crc } = entry;
    if index.insert(key, Location { part, offset, length, crc }) {
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

/// The number of the next sealed part.
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

/// Refuses a folder that is a store already, or holds something else.
fn refuse_store(files: &Arc<Files>, folder: &Path) -> Result<(), StoreError> {
    match binding::state(files, folder)?.0 {
        FolderState::Store => Err(StoreError::Exists { path: folder.to_owned() }),
        FolderState::Absent | FolderState::Free => Ok(()),
    }
}

/// The paths of the sealed parts of a folder, by name.
fn sealed_paths(files: &Arc<Files>, folder: &Path) -> Result<Vec<PathBuf>, StoreError> {
    let names = Folder::of(files, folder).parts()?;
    Ok(names.into_iter().map(|name| folder.join(layout::PARTS).join(name)).collect())
}

/// Removes the scratch space of dead processes.
fn remove_scratch(files: &Arc<Files>, folder: &Path) -> Result<(), StoreError> {
    let found = layout::look(files, folder)?.unwrap_or_default();
    for name in found.of(Role::Scratch) {
        let path = folder.join(name);
        if lock::adopt(files, &path)?.is_some() {
            files.remove(&path)?;
        }
    }
    Ok(())
}

/// Removes a store whose lock is held; returns what is left because no store makes it.
fn remove_all(files: &Arc<Files>, folder: &Path) -> Result<Vec<PathBuf>, StoreError> {
    let mut left = remove_own_files(files, folder)?;
    // The lock says whose the rest is. After a crash none of the rest may be there without it.
    files.sync_folder(folder)?;
    files.remove(&folder.join(layout::LOCK))?;
    if left.is_empty() {
        // Something may have come in between: then the folder is not empty, and stays.
        if let Err(error) = files.remove_folder(folder) {
            left = layout::look(files, folder)?
                .unwrap_or_default()
                .foreign
                .into_iter()
                .map(|name| folder.join(name))
                .collect();
            if left.is_empty() {
                return Err(error);
            }
        }
    }
    Ok(left)
}

/// What a store's folder holds that no store makes.
fn foreign(files: &Arc<Files>, folder: &Path) -> Result<Vec<PathBuf>, StoreError> {
    let found = layout::look(files, folder)?.unwrap_or_default();
    let mut foreign: Vec<PathBuf> = found.foreign.iter().map(|name| folder.join(name)).collect();
    if found.of(Role::Parts).next().is_some() {
        let parts = folder.join(layout::PARTS);
        let is_part = |entry: &Listed| {
            !entry.is_folder
                && entry.name.to_str().is_some_and(|n| layout::part_of_sealed(n).is_some())
        };
        let rest = files.list(&parts)?.unwrap_or_default().into_iter();
        foreign.extend(rest.filter(|entry| !is_part(entry)).map(|entry| parts.join(entry.name)));
    }
    Ok(foreign)
}

/// Removes all files of a store but the lock; returns what is left. The header goes before the plan: at any moment the folder is a store that
/// can be read, or none.
fn remove_own_files(files: &Arc<Files>, folder: &Path) -> Result<Vec<PathBuf>, StoreError> {
    let found = layout::look(files, folder)?.unwrap_or_default();
    let left = foreign(files, folder)?;
    let parts = folder.join(layout::PARTS);
    if found.of(Role::Parts).next().is_some() {
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
