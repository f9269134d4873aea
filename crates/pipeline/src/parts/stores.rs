//! The stores of a part or a merge: folders, and prefixes in object storage.

use std::{
    env, fs, io,
    path::{Path, PathBuf},
    sync::Arc,
};

use corniche_objects::{ObjectPlace, StorageRequests};
use corniche_plan::BuildPlan;
use corniche_spec::{BuildObserver, hex::hex};
use corniche_store::{
    Disk, Folder, Hold, LocalStore, OwnPart, PartsPlace, Publish as _, SYNC_INTERVAL, SealedParts,
    StoreError, StoredPlan, SystemDisk,
};
use sha2::{Digest as _, Sha256};

use crate::{
    BuildError,
    build::work_store::{differences, stored},
    objects::{ObjectAccess, address},
};

/// The largest number of processes on one machine that can build the same part at the same time.
const MOST_COPIES: u32 = 16;
/// The number of tries if a folder is deleted while it is being opened.
const MOST_TRIES: u32 = 8;

/// Stores that all belong to one plan.
pub(crate) struct Stores<'a> {
    disk: Arc<dyn Disk>,
    /// Each store once; the first one is also written.
    all: Vec<OneStore>,
    plan: &'a BuildPlan,
    stored: StoredPlan,
    tmp: PathBuf,
    access: ObjectAccess,
}

enum OneStore {
    Folder(Folder),
    Objects(Box<ObjectPlace>),
}

/// A store with a part that is being built, and the destination of the part.
pub(crate) struct OpenStores<'a> {
    pub store: LocalStore,
    /// The place to which the part is uploaded, and the folder in which it is built; `None` if it
    /// is built in place.
    sent: Option<(&'a ObjectPlace, PathBuf)>,
}

impl<'a> Stores<'a> {
    /// Checks to which plans the stores with these folders or addresses belong, and changes
    /// nothing. All are read, and the first is written; it need not exist yet if it `may_be_new`. A
    /// part to upload is first written in `tmp`; `None`: the system's temporary folder.
    pub(crate) fn look(
        names: &[PathBuf],
        tmp: Option<&Path>,
        plan: &'a BuildPlan,
        mut access: ObjectAccess,
        may_be_new: bool,
    ) -> Result<Self, BuildError> {
        let disk: Arc<dyn Disk> = Arc::new(SystemDisk);
        let wanted = stored(plan)?;
        let mut stores = Vec::new();
        let mut seen: Vec<PathBuf> = Vec::new();
        for (index, name) in names.iter().enumerate() {
            let store = match address(name)? {
                Some(address) => OneStore::Objects(Box::new(access.place(&address)?)),
                None => OneStore::Folder(Folder::new(Arc::clone(&disk), &folder_of_store(name))),
            };
            match store.place().stored_plan()? {
                Some(there) => refuse_other(name, plan, &wanted, &there)?,
                None if index == 0 && may_be_new => {}
                None => return Err(BuildError::NoStore { folder: name.clone() }),
            }
            // A folder can have several names.
            let known = match &store {
                OneStore::Folder(_) => fs::canonicalize(name).ok(),
                OneStore::Objects(place) => Some(place.name().to_owned()),
            };
            if known.as_ref().is_none_or(|known| !seen.contains(known)) {
                seen.extend(known);
                stores.push(store);
            }
        }
        if stores.is_empty() {
            return Err(BuildError::Start {
                what: "no store is named; pass one with --store".to_owned(),
            });
        }
        let tmp = tmp.map_or_else(env::temp_dir, Path::to_path_buf);
        Ok(Self { disk, all: stores, plan, stored: wanted, tmp, access })
    }

    /// Opens those parts whose names `is_needed` accepts, and a part of this name for writing: in
    /// the first store if that is a folder, otherwise in a separate folder from which it is
    /// uploaded there.
    pub(crate) fn open(
        &self,
        name: &str,
        is_needed: &dyn Fn(&str) -> bool,
    ) -> Result<OpenStores<'_>, BuildError> {
        match &self.all[0] {
            OneStore::Folder(folder) => {
                let store = self.open_in(folder.name(), name, is_needed, Hold::Shared)?;
                Ok(OpenStores { store, sent: None })
            }
            OneStore::Objects(place) => {
                let bound = place.bind(&self.stored)?;
                refuse_other(place.name(), self.plan, &self.stored, &bound)?;
                let first = self.tmp.join(self.work_name(place.name(), name));
                // Each of two processes that build the same part has its own folder. After a kill
                // the folder is free again.
                let mut copies = (2..=MOST_COPIES).map(|copy| numbered(&first, copy));
                let mut tries_left = MOST_TRIES;
                let mut folder = first.clone();
                let store = loop {
                    match self.open_in(&folder, name, is_needed, Hold::Alone) {
                        Err(StoreError::Locked { path, owner }) => match copies.next() {
                            Some(next) => folder = next,
                            None => return Err(StoreError::Locked { path, owner }.into()),
                        },
                        // The process that created the folder deleted it at this moment.
                        Err(StoreError::Io { source, .. })
                            if source.kind() == io::ErrorKind::NotFound && tries_left > 0 =>
                        {
                            tries_left -= 1;
                        }
                        store => break store?,
                    }
                };
                Ok(OpenStores { store, sent: Some((place, folder)) })
            }
        }
    }

    /// Opens the needed parts of existing stores for reading only; `None` if no store exists.
    pub(crate) fn open_to_read(
        &self,
        is_needed: &dyn Fn(&str) -> bool,
    ) -> Result<Option<LocalStore>, BuildError> {
        let mut places: Vec<&dyn PartsPlace> = Vec::new();
        for store in &self.all {
            if store.place().stored_plan()?.is_some() {
                places.push(store.place());
            }
        }
        if places.is_empty() {
            return Ok(None);
        }
        let sealed = SealedParts { places: &places, is_needed };
        Ok(Some(LocalStore::open_places(Arc::clone(&self.disk), sealed, &self.stored.hash, None)?))
    }

    fn open_in(
        &self,
        folder: &Path,
        name: &str,
        is_needed: &dyn Fn(&str) -> bool,
        hold: Hold,
    ) -> Result<LocalStore, StoreError> {
        let places: Vec<&dyn PartsPlace> = self.all.iter().map(OneStore::place).collect();
        let sealed = SealedParts { places: &places, is_needed };
        let own = OwnPart { folder, name, plan: &self.stored, interval: SYNC_INTERVAL };
        let disk = Arc::clone(&self.disk);
        LocalStore::open_places(disk, sealed, &self.stored.hash, Some((own, hold)))
    }

    /// Requests to object storage so far; `None` if no store is there.
    pub(crate) fn requests(&self) -> Option<StorageRequests> {
        self.access.requests()
    }

    /// The name of the folder in which a part for a place is built. It is the same for each process
    /// that builds the part, but differs by plan and place.
    fn work_name(&self, place: &Path, part: &str) -> String {
        let mut digest = Sha256::new();
        digest.update(self.stored.hash);
        digest.update(place.as_os_str().as_encoded_bytes());
        format!("corniche-{}-{part}", &hex(&digest.finalize())[..16])
    }
}

/// The folder that the user names, which may be a symbolic link to a folder: inside it no link is
/// followed.
fn folder_of_store(name: &Path) -> PathBuf {
    // Shells complete a link to a folder with a slash, which makes the system read the folder
    // instead of the link.
    let plain: PathBuf = name.components().collect();
    if plain.is_symlink() { fs::canonicalize(name).unwrap_or(plain) } else { name.to_path_buf() }
}

impl OneStore {
    fn place(&self) -> &dyn PartsPlace {
        match self {
            Self::Folder(folder) => folder,
            Self::Objects(place) => &**place,
        }
    }
}

impl OpenStores<'_> {
    /// Ends the part and writes it to its destination. Returns the destination; `None` if there was
    /// nothing to compute.
    pub(crate) fn keep(self, observer: &dyn BuildObserver) -> Result<Option<PathBuf>, BuildError> {
        let Some((place, folder)) = self.sent else { return Ok(self.store.seal()?) };
        let sent = self.store.publish(place, &|| observer.is_cancelled());
        let sent = sent.map_err(|error| {
            tell_of_what_is_kept(&folder, observer);
            if observer.is_cancelled() { BuildError::Interrupted } else { BuildError::from(error) }
        })?;
        // The part is complete at its destination, so leftovers that cannot be deleted are not an
        // error.
        let left = match LocalStore::discard(Arc::new(SystemDisk), &folder) {
            Ok(left) => left.into_iter().map(|path| format!("{path:?}")).collect(),
            // Another process is starting to build the same part there.
            Err(StoreError::Locked { .. } | StoreError::Gone { .. }) => Vec::new(),
            Err(error) => vec![error.to_string()],
        };
        if !left.is_empty() {
            let left = left.join(", ");
            observer.warning(&format!("{folder:?} was not completely removed: {left}"));
        }
        Ok(sent)
    }

    /// Leaves the store after a failure, with all progress. The user is told the folder if it is
    /// not the store.
    pub(crate) fn leave(self, observer: &dyn BuildObserver) {
        if let Some((_, folder)) = &self.sent {
            tell_of_what_is_kept(folder, observer);
        }
    }

    /// Abandons the part: its artifacts are deleted.
    pub(crate) fn abandon(self) -> Result<(), BuildError> {
        match self.sent {
            None => Ok(self.store.abandon()?),
            Some(_) => Ok(self.store.remove().map(drop)?),
        }
    }
}

/// Fails if a store belongs to another plan.
fn refuse_other(
    store: &Path,
    plan: &BuildPlan,
    wanted: &StoredPlan,
    there: &StoredPlan,
) -> Result<(), BuildError> {
    if there.hash == wanted.hash {
        return Ok(());
    }
    let differences = differences(plan, there);
    Err(BuildError::OtherPlan { store: store.to_path_buf(), differences })
}

fn tell_of_what_is_kept(folder: &Path, observer: &dyn BuildObserver) {
    observer
        .warning(&format!("progress is saved in {folder:?}; rerun the same command to continue"));
}

fn numbered(folder: &Path, number: u32) -> PathBuf {
    let mut name = folder.as_os_str().to_owned();
    name.push(format!(".{number}"));
    name.into()
}

#[cfg(all(test, unix))]
#[path = "stores_tests.rs"]
mod tests;
