//! By default a build takes half of the machine's memory, within bounds.

use super::*;

#[test]
fn by_default_a_build_takes_half_of_the_machine_within_bounds() {
    assert_eq!(default_of(Some(6 << 30)), 3 << 30);
    assert_eq!(default_of(Some(64 << 30)), 4 << 30);
    assert_eq!(default_of(Some(300 << 20)), 256 << 20);
    assert_eq!(default_of(None), 1 << 30);
}

#[test]
fn the_memory_of_the_machine_is_read() {
    let text = "MemTotal:       24576000 kB\nMemFree:         1000 kB\n";
    assert_eq!(total_of_meminfo(text), Some(24_576_000 << 10));
    for bad in ["", "MemTotal: many kB", "MemTotal: 5", "MemFree: 5 kB"] {
        assert_eq!(total_of_meminfo(bad), None, "{bad}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn this_machine_has_memory_and_disks() {
    assert!(machine_memory_bytes().unwrap() > 1 << 20);
    let folder = tempfile::tempdir().unwrap();
    let own = FileSystem::containing(folder.path()).unwrap();
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).unwrap();
    assert_eq!(FileSystem::containing(&inner).unwrap().device, own.device);
    assert!(FileSystem::containing(&folder.path().join("none")).is_err());
}
