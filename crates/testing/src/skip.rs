//! Tests that cannot run on this machine report this, and are counted.

use std::{env, fs::OpenOptions, io::Write as _, thread};

/// Reports that the test in this thread, or a part of it, is skipped, and why.
///
/// The reason continues a sentence that begins with the number of tests: "need elevation files that
/// are not in the repository"; it names no file, so that tests with one reason are counted
/// together. `libtest` hides the output of a test and counts it as passed. So a line
/// `binary test: reason` is appended to the file that `CORNICHE_SKIPPED` names; `scripts/test`
/// counts these lines and prints them at its end.
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
        // The line is written at once, so that lines of several processes do not mix.
        file.and_then(|mut file| file.write_all(format!("{binary} {test}: {reason}\n").as_bytes()))
            .unwrap_or_else(|error| panic!("{}: {error}", list.display()));
    }
}
