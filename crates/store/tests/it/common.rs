//! Functions that the tests of the store share.
#![allow(
    dead_code,
    clippy::unwrap_used,
    reason = "each test file uses some of it; tests may unwrap"
)]

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    sync::Arc,
    time::Duration,
};

use corniche_store::{
    ArtifactKey, Artifacts, Disk, Folder, Hold, LocalStore, OwnPart, PartsPlace, PlanHash,
    SealedParts, StoreError, StoredPlan,
};
use corniche_testing::{Random, disks::MemoryDisk};

pub(crate) const NOTHING: [PathBuf; 0] = [];
pub(crate) const NO_ITEMS: [u64; 0] = [];
pub(crate) const NEVER: Duration = Duration::MAX;
pub(crate) const ALWAYS: Duration = Duration::ZERO;

pub(crate) fn folder() -> &'static Path {
    Path::new("/data/store")
}

pub(crate) fn empty_disk() -> MemoryDisk {
    MemoryDisk::with_folder(Path::new("/data"))
}

pub(crate) fn plan() -> StoredPlan {
    StoredPlan { hash: [7; 32], bytes: b"{\"cell\": 30}".to_vec() }
}

pub(crate) fn key(kind: u8, item: u64) -> ArtifactKey {
    ArtifactKey { kind, item }
}

/// Returns the artifact of a key in these tests: the key determines it, as in a build.
pub(crate) fn artifact(key: ArtifactKey) -> Vec<u8> {
    let mut random = Random::new(key.item << 8 | u64::from(key.kind));
    let length = random.below(700) as usize;
    (0..length).map(|_| random.bits() as u8).collect()
}

pub(crate) fn create(disk: &MemoryDisk, interval: Duration) -> Result<LocalStore, StoreError> {
    LocalStore::create(disk.disk(), folder(), &plan(), interval)
}

pub(crate) fn open(disk: &MemoryDisk, interval: Duration) -> Result<LocalStore, StoreError> {
    LocalStore::open(disk.disk(), folder(), &plan().hash, interval)
}

/// Opens all sealed parts of some folders together, and a part to write if requested, where several
/// processes may work at once.
pub(crate) fn open_parts(
    disk: Arc<dyn Disk>,
    folders: &[&Path],
    plan: &PlanHash,
    own: Option<OwnPart<'_>>,
) -> Result<LocalStore, StoreError> {
    let folders: Vec<Folder> =
        folders.iter().map(|folder| Folder::new(Arc::clone(&disk), folder)).collect();
    let places: Vec<&dyn PartsPlace> =
        folders.iter().map(|folder| folder as &dyn PartsPlace).collect();
    let sealed = SealedParts { places: &places, is_needed: &|_| true };
    LocalStore::open_places(disk, sealed, plan, own.map(|own| (own, Hold::Shared)))
}

/// Resumes the store if there is one, else creates it, like a build.
pub(crate) fn create_or_open(
    disk: &MemoryDisk,
    interval: Duration,
) -> Result<LocalStore, StoreError> {
    match LocalStore::stored_plan(disk.disk(), folder())? {
        Some(found) => {
            assert_eq!(found, plan());
            open(disk, interval)
        }
        None => create(disk, interval),
    }
}

/// Checks that the store holds exactly these artifacts, with all functions that return them.
pub(crate) fn check_holds(store: &LocalStore, expected: &BTreeMap<ArtifactKey, Vec<u8>>) {
    for kind in 0..=5 {
        let items: Vec<u64> =
            expected.keys().filter(|key| key.kind == kind).map(|key| key.item).collect();
        assert_eq!(store.items(kind), items);
    }
    for (key, bytes) in expected {
        assert!(store.has(*key));
        assert_eq!(store.get(*key).unwrap().as_ref(), Some(bytes));
    }
}

/// Checks that every artifact in the store is correct.
pub(crate) fn check_all_right(store: &LocalStore) -> usize {
    let mut count = 0;
    for kind in 0..=5 {
        for item in store.items(kind) {
            let key = key(kind, item);
            assert_eq!(store.get(key).unwrap(), Some(artifact(key)), "{key:?}");
            count += 1;
        }
    }
    count
}

pub(crate) fn all_of(
    keys: impl IntoIterator<Item = ArtifactKey>,
) -> BTreeMap<ArtifactKey, Vec<u8>> {
    keys.into_iter().map(|key| (key, artifact(key))).collect()
}

pub(crate) fn system() -> Arc<dyn corniche_store::Disk> {
    Arc::new(corniche_store::SystemDisk)
}
