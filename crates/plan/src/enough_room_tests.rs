//! A build that does not fit the memory or the disk is rejected, with the amount that it needs.

use super::*;
use crate::estimate::tests::{estimate, file};

const M: u64 = 1 << 20;
const G: u64 = 1 << 30;

/// The given memory, and the given free space for intermediate results and for the package, on one
/// file system or on two.
fn room(memory_bytes: u64, free: [u64; 2], devices: [u64; 2]) -> AvailableSpace {
    let place = |name: &str, at: usize| {
        (PathBuf::from(name), FileSystem { device: devices[at], free_bytes: free[at] })
    };
    let (store, target) = (place("/tmp/store", 0), place("/target", 1));
    AvailableSpace { memory_bytes, machine_bytes: Some(32 * G), store, target }
}

fn refusal(room: &AvailableSpace, estimate: &BuildEstimate) -> String {
    let error = room.check(estimate).unwrap_err();
    assert!(error.is_unusable_input(), "{error}");
    error.to_string()
}

#[test]
fn a_strip_that_does_not_fit_the_memory_is_refused_with_the_need() {
    let strip = file([10_000, 10_000], [10_000, 10_000], 0);
    let estimate = estimate(vec![1, 4], &[strip], 2);
    let said = refusal(&room(256 * M, [G, G], [1, 2]), &estimate);
    let need = estimate.memory.least_bytes.div_ceil(M);
    for part in ["--memory allows 256M", "dem.tif", "--threads", "TILED=YES", "--force"] {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!(said.contains(&format!("pass --memory {need}M")), "{said}");
    assert!(room(need * M, [G, G], [1, 2]).check(&estimate).is_ok());
}

#[test]
fn the_machine_itself_may_have_too_little() {
    let strip = file([10_000, 10_000], [10_000, 10_000], 0);
    let estimate = estimate(vec![1, 4], &[strip], 1);
    let small = AvailableSpace { machine_bytes: Some(300 * M), ..room(64 * G, [G, G], [1, 2]) };
    let said = refusal(&small, &estimate);
    assert!(said.contains("this machine has 300M") && !said.contains("fewer"), "{said}");
    assert!(!said.contains("pass --memory"), "more than the machine has: {said}");
    let unknown = AvailableSpace { machine_bytes: None, ..room(64 * G, [G, G], [1, 2]) };
    assert!(unknown.check(&estimate).is_ok());
}

#[test]
fn a_disk_that_is_too_small_is_refused_with_the_need() {
    let estimate = estimate(vec![1000, 4000], &[], 2);
    let (store, package) = (estimate.store_bytes, estimate.package_bytes);
    // With two file systems, each must have space for its own part.
    assert!(room(G, [store, package], [1, 2]).check(&estimate).is_ok());
    let said = refusal(&room(G, [store - 1, package], [1, 2]), &estimate);
    assert!(said.contains("/tmp/store") && said.contains("intermediate"), "{said}");
    assert!(said.contains("--tmp") && said.contains("--force"), "{said}");
    assert!(said.contains(&format!("about {}M", store.div_ceil(M))), "{said}");
    let said = refusal(&room(G, [store, package - 1], [1, 2]), &estimate);
    assert!(said.contains("/target") && said.contains("for the package"), "{said}");
    // A single file system must have space for both.
    let both = store + package;
    assert!(room(G, [both; 2], [1, 1]).check(&estimate).is_ok());
    refusal(&room(G, [both - 1; 2], [1, 1]), &estimate);
}

#[test]
fn a_folder_that_does_not_exist_yet_is_looked_at_where_it_will_be() {
    let folder = tempfile::tempdir().unwrap();
    let later = folder.path().join("later/still");
    let found = AvailableSpace::measure(G, [&later, folder.path()], 0).unwrap();
    assert_eq!(found.store.1.device, found.target.1.device);
    assert_eq!(found.store.0, later);
}

/// A resumed build does not need the space again that its store already occupies: here the store is
/// larger than any disk's free space.
#[test]
fn what_a_store_takes_already_counts_as_free() {
    let folder = tempfile::tempdir().unwrap();
    let held = 1 << 60;
    let found = AvailableSpace::measure(G, [folder.path(); 2], held).unwrap();
    assert!(found.store.1.free_bytes >= held && found.target.1.free_bytes >= held);
}
