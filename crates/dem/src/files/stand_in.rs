//! Recognises what a failed download leaves in the place of a raster or a vector file.

use std::{fs::File, io::Read as _, path::Path};

/// How many bytes of a file are examined.
const START_BYTES: u64 = 4096;

/// What a file is that stands where geodata were to be, and what to do; `None` if it is nothing of the kind, or cannot be read.
#[must_use]
pub fn stand_in(path: &Path) -> Option<(&'static str, &'static str)> {
    // Opening a pipe would block until something is written to it.
    if !path.is_file() {
        return None;
    }
    let mut start = Vec::new();
    File::open(path).ok()?.take(START_BYTES).read_to_end(&mut start).ok()?;
    let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&start).trim_ascii_start();
    let is = |name: &[u8]| text.get(..name.len()).is_some_and(|own| own.eq_ignore_ascii_case(name));
    let has = |word: &[u8]| text.windows(word.len()).any(|own| own.eq_ignore_ascii_case(word));
    if is(b"version https://git-lfs") {
        Some(("a Git LFS pointer", "fetch the file that it stands for: git lfs pull"))
    } else if is(b"<!doctype html") || is(b"<html") || (is(b"<") && has(b"<html")) {
        Some(("an HTML page", "its download failed; fetch the file again"))
    } else if is(b"<") && has(b"ExceptionReport") {
        Some((
            "an error report of a server",
            "read it in an editor, correct the request and fetch the file again",
        ))
    } else {
        None
    }
}
