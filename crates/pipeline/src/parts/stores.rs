//! The stores that a part or a merge works with: folders, and prefixes in object storage.

use std::{
    env, fs, io,
    path::{Path, PathBuf},
    sync::Arc,
};

use corniche_objects::{ObjectPlace, Requests};
use corniche_plan::BuildPlan;
use corniche_spec::{Observer, hex::hex};
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

/// Most processes of one machine that can make the same part at once.
const MOST_COPIES: u32 = 16;
/// How often a folder may be removed while it is being opened.
const MOST_TRIES: u32 = 8;

/// What a user says of stores.
#[derive(Clone, Copy)]
pub(crate) struct GivenStores<'a> {
    /// Folders and addresses. All are read, and the first is written.
    pub(crate) names: &'a [PathBuf],
    /// Where a part is made that is sent elsewhere then; `None`: the system's folder for temporary files.
    pub(crate) tmp: Option<&'a Path>,
}

/// Stores that are all of one plan.
pub(crate) struct Stores<'a> {
    disk: Arc<dyn Disk>,
    /// Each once; the first is written, too.
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

/// A store with a part that is being made, and where that goes when it is done.
pub(crate) struct OpenStores<'a> {
    pub(crate) store: LocalStore,
    /// The place it is sent to, and the folder in which it is made; `None` where it is made in place.
    sent: Option<(&'a ObjectPlace, PathBuf)>,
}

impl<'a> Stores<'a> {
    /// Looks which plans the stores are of, and changes nothing. The first need not be there yet if it `may_be_new`.
    pub(crate) fn look(
        given: GivenStores<'_>,
        plan: &'a BuildPlan,
        mut access: ObjectAccess,
        may_be_new: bool,
    ) -> Result<Self, BuildError> {
        let disk: Arc<dyn Disk> = Arc::new(SystemDisk);
        let wanted = stored(plan)?;
        let mut stores = Vec::new();
        let mut seen: Vec<PathBuf> = Vec::new();
        for (index, name) in given.names.iter().enumerate() {
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
            return Err(BuildError::Start { what: "no store is given".to_owned() });
        }
        let tmp = given.tmp.map_or_else(env::temp_dir, Path::to_path_buf);
        Ok(Self { disk, all: stores, plan, stored: wanted, tmp, access })
    }

    /// Opens those of their parts that `is_needed` asks for by their names, and a part of this name to write: in the first store if that is a
    /// folder, else in a folder of its own from which it is sent there.
    pub(crate) fn open(
        &self,
        name: &str,
        is_needed: &dyn Fn(&str) -> bool,
    ) -> Result<OpenStores<'_>, BuildError> {
        match self.all.first() {
            None => Err(BuildError::Start { what: "no store is given".to_owned() }),
            Some(OneStore::Folder(folder)) => {
                let store = self.open_in(folder.name(), name, is_needed, Hold::Shared)?;
                Ok(OpenStores { store, sent: None })
            }
            Some(OneStore::Objects(place)) => {
                let bound = place.bind(&self.stored)?;
                refuse_other(place.name(), self.plan, &self.stored, &bound)?;
                let first = self.tmp.join(self.work_name(place.name(), name));
                // Of two processes that make the same part, each has a folder of its own. After a kill the folder is free again.
                let mut copies = (2..=MOST_COPIES).map(|copy| numbered(&first, copy));
                let mut tries_left = MOST_TRIES;
                let mut folder = first.clone();
                let store = loop {
                    match self.open_in(&folder, name, is_needed, Hold::Alone) {
                        Err(StoreError::Locked { path, owner }) => match copies.next() {
                            Some(next) => folder = next,
                            None => return Err(StoreError::Locked { path, owner }.into()),
                        },
                        // The process that made it removed the folder at this moment.
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

    /// Opens the needed parts of those stores that are there, to be read alone; `None` if none is.
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

    /// What was asked of object storage so far; `None` if no store is there.
    pub(crate) fn requests(&self) -> Option<Requests> {
        self.access.requests()
    }

    /// The name of the folder in which a part for a place is made: the same for each process that makes it, and another for each plan and place.
    fn work_name(&self, place: &Path, part: &str) -> String {
        let mut digest = Sha256::new();
        digest.update(self.stored.hash);
        digest.update(place.as_os_str().as_encoded_bytes());
        format!("corniche-{}-{part}", &hex(&digest.finalize())[..16])
    }
}

/// The folder that a person names, which may be a link to one: within it no link is followed.
fn folder_of_store(name: &Path) -> PathBuf {
    // Shells complete a link to a folder with a slash, with which the system looks at the folder instead of the link.
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
    /// Ends the part and keeps it where it belongs. Returns where that is; `None` if nothing had to be made.
    pub(crate) fn keep(self, observer: &dyn Observer) -> Result<Option<PathBuf>, BuildError> {
        let Some((place, folder)) = self.sent else { return Ok(self.store.seal()?) };
        let sent = self.store.publish(place, &|| observer.is_cancelled());
        let sent = sent.map_err(|error| {
            tell_of_what_is_kept(&folder, observer);
            if observer.is_cancelled() { BuildError::Interrupted } else { BuildError::from(error) }
        })?;
        // The part is where it belongs. What cannot be removed is no failure.
        let left = match LocalStore::discard(Arc::new(SystemDisk), &folder) {
            Ok(left) => left.into_iter().map(|path| path.display().to_string()).collect(),
            // Another process begins to make the same part there.
            Err(StoreError::Locked { .. } | StoreError::Gone { .. }) => Vec::new(),
            Err(error) => vec![error.to_string()],
        };
        if !left.is_empty() {
            let left = left.join(", ");
            observer.warning(&format!("{} was not removed: {left}", folder.display()));
        }
        Ok(sent)
    }

    /// Leaves the store after a failure: what was done stays. The user is told where, if that is not the store.
    pub(crate) fn leave(self, observer: &dyn Observer) {
        if let Some((_, folder)) = &self.sent {
            tell_of_what_is_kept(folder, observer);
        }
    }

    /// Gives the part up: what was made of it is removed.
    pub(crate) fn abandon(self) -> Result<(), BuildError> {
        match self.sent {
            None => Ok(self.store.abandon()?),
            Some(_) => Ok(self.store.remove().map(drop)?),
        }
    }
}

/// Fails if a store is bound to another plan than what is wanted.
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

fn tell_of_what_is_kept(folder: &Path, observer: &dyn Observer) {
    observer.warning(&format!(
        "what was done is kept in {}; the same command goes on from there",
        folder.display()
    ));
}

fn numbered(folder: &Path, number: u32) -> PathBuf {
    let mut name = folder.as_os_str().to_owned();
    name.push(format!(".{number}"));
    name.into()
}

#[cfg(all(test, unix))]
#[path = "stores_tests.rs"]
mod tests;
