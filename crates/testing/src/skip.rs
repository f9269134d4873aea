//! Tests that cannot run here say so, and are counted.

use std::{env, fs::OpenOptions, io::Write as _, thread};

/// Says that the test that runs in this thread, or a part of it, is skipped, and why.
///
/// The reason goes on after the number of tests: "need elevation files that are not in the repository"; it names no file, so that tests with one reason
/// are counted together. `libtest` hides what a test prints and counts it as passed. So a line `binary test: reason` is appended to the file that
/// `CORNICHE_SKIPPED` names; `scripts/test` counts these lines and shows them at its end.
///
/// # Panics
/// When that file cannot be written.
pub fn skip(reason: &str) {
    let thread = thread::current();
    let test = thread.name().unwrap_or("?");
    let binary = env::current_exe().unwrap_or_default();
    let binary = binary.file_stem().unwrap_or_default().to_string_lossy();
    let reason = reason.split_whitespace().collect::<Vec<_>>().join(" ");
    eprintln!("skipped: {reason}");
    if let Some(list) = env::var_os("CORNICHE_SKIPPED") {
        let file = OpenOptions::new().append(true).create(true).open(&list);
        // One write, so that lines of several processes do not mix.
        file.and_then(|mut file| file.write_all(format!("{binary} {test}: {reason}\n").as_bytes()))
            .unwrap_or_else(|error| panic!("{}: {error}", list.display()));
    }
}
