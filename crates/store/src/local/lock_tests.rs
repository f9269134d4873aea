//! Holders that share a lock read and write it at the same time, and an incomplete line, left by a
//! kill, is written again.

use std::{fs, thread};

use super::*;
use crate::SystemDisk;

fn folder() -> (tempfile::TempDir, Arc<Files>) {
    (tempfile::tempdir().unwrap(), Files::new(Arc::new(SystemDisk)))
}

#[test]
fn holders_that_share_a_lock_sign_it_side_by_side() {
    let (folder, files) = folder();
    // The previous owner had a longer name.
    let old = format!("{MARK}0123456789abcdef\n{OWNER}1234567 on {}\n", "n".repeat(60));
    fs::write(folder.path().join(layout::LOCK), old).unwrap();
    thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                for _ in 0..500 {
                    let held = lock_store(&files, folder.path(), Hold::Shared).unwrap();
                    let said = signature(&files, folder.path()).unwrap();
                    assert!(matches!(said, Signature::Store(_)), "{said:?}");
                    drop(held);
                }
            });
        }
    });
    let text = fs::read_to_string(folder.path().join(layout::LOCK)).unwrap();
    assert!(text.starts_with(&format!("{MARK}0123456789abcdef\n{OWNER}")), "{text}");
}

#[test]
fn a_lock_that_a_kill_cut_off_is_written_anew() {
    let line = format!("{MARK}0123456789abcdef\n");
    for end in [0, 1, MARK.len(), line.len() - 1] {
        let (folder, files) = folder();
        let path = folder.path().join(layout::LOCK);
        fs::write(&path, &line[..end]).unwrap();
        assert_eq!(signature(&files, folder.path()).unwrap(), Signature::None);
        drop(lock_store(&files, folder.path(), Hold::Alone).unwrap());
        let said = signature(&files, folder.path()).unwrap();
        assert_eq!(said, Signature::Store(line.len() as u64), "{end}");
        assert_eq!(fs::read_to_string(&path).unwrap().lines().count(), 2, "{end}");
    }
    for text in ["corniche store 0123\n", "corniche store ../../some/where\n", "corniche more"] {
        let (folder, files) = folder();
        fs::write(folder.path().join(layout::LOCK), text).unwrap();
        assert!(lock_store(&files, folder.path(), Hold::Alone).is_err(), "{text}");
        assert_eq!(fs::read_to_string(folder.path().join(layout::LOCK)).unwrap(), text);
    }
}
