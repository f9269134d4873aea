//! A store may be named by a symbolic link, in any spelling.

use std::os::unix::fs::symlink;

use corniche_store::StoredPlan;

use super::*;

#[test]
fn a_link_to_a_store_is_followed_with_and_without_a_slash() {
    let place = tempfile::tempdir().unwrap();
    let real = place.path().canonicalize().unwrap().join("real");
    let disk: Arc<dyn Disk> = Arc::new(SystemDisk);
    let plan = StoredPlan { hash: [7; 32], bytes: b"{}".to_vec() };
    drop(LocalStore::create(Arc::clone(&disk), &real, &plan, SYNC_INTERVAL).unwrap());
    symlink("real", place.path().join("link")).unwrap();
    for name in ["link", "link/", "link//", "link/.", "real", "real/"] {
        let folder = folder_of_store(&place.path().join(name));
        if name.starts_with("link") {
            assert_eq!(folder, real, "{name}");
        }
        let found = Folder::new(Arc::clone(&disk), &folder).stored_plan().unwrap();
        assert_eq!(found, Some(plan.clone()), "{name}");
        let own = OwnPart { folder: &folder, name: "a", plan: &plan, interval: SYNC_INTERVAL };
        let sealed = SealedParts { places: &[], is_needed: &|_| true };
        let own = Some((own, Hold::Shared));
        drop(LocalStore::open_places(Arc::clone(&disk), sealed, &plan.hash, own).unwrap());
    }
    // A path that does not exist yet, or a broken link, is reported later by the name that was
    // given.
    symlink("nowhere", place.path().join("dead")).unwrap();
    for name in ["missing", "dead"] {
        assert_eq!(folder_of_store(&place.path().join(name)), place.path().join(name));
    }
}
