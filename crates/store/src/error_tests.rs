//! Errors of a store give advice that the current command can follow.

use super::*;

fn said(source: io::Error) -> String {
    StoreError::Io { path: "parts/tiles-1-0-0.part".into(), doing: "open", source }.to_string()
}

#[cfg(unix)]
#[test]
fn too_many_open_files_says_what_to_do() {
    for number in [23, 24] {
        let said = said(io::Error::from_raw_os_error(number));
        assert!(said.contains("tiles-1-0-0.part") && said.contains("ulimit -n"), "{said}");
    }
    let said = said(io::Error::from_raw_os_error(5));
    assert!(!said.contains("ulimit"), "{said}");
}

/// For a store, `part`, `merge` and `verify` have none of `--resume`, `--tmp` and `-O`.
#[test]
fn options_of_build_are_named_as_such() {
    use io::ErrorKind::{PermissionDenied, ReadOnlyFilesystem, StorageFull, Unsupported};
    let kinds = [StorageFull, PermissionDenied, ReadOnlyFilesystem, Unsupported];
    let mut texts: Vec<String> = kinds.into_iter().map(|kind| said(kind.into())).collect();
    texts.push(StoreError::Exists { path: "store".into() }.to_string());
    for text in texts {
        assert!(text.contains("(build: with -"), "{text}");
        for option in ["--resume", "--tmp", "-O"] {
            let of_build = text.matches(&format!("(build: with {option})")).count();
            assert_eq!(text.matches(option).count(), of_build, "{option}: {text}");
        }
    }
}
