//! Compressed files of a page, for clients that accept them.

use std::{
    io::{self, Write as _},
    sync::{Arc, OnceLock},
};

use brotli::CompressorWriter;
use bytes::Bytes;
use hyper::{
    HeaderMap,
    header::{ACCEPT_ENCODING, HeaderValue, RANGE},
};

/// Shorter files fit into a packet or two without compression.
const LEAST_BYTES: usize = 1 << 11;
/// The quality, of brotli's 0 to 11. The highest saves a tenth more bytes, but the first request
/// would wait for seconds (docs/lab/browser.md).
const QUALITY: u32 = 9;
/// The logarithm of the window size, which all browsers support.
const WINDOW: u32 = 22;
const BUFFER_BYTES: usize = 1 << 16;

/// A file in memory, compressed once, at the first request.
#[derive(Debug, Clone, Default)]
pub(crate) struct CompressedFile(Arc<OnceLock<Option<Bytes>>>);

impl CompressedFile {
    /// The compressed file, or `None` if it is not shorter. Compression takes some tenths of a
    /// second per megabyte.
    pub(crate) fn compressed(&self, bytes: &Bytes) -> Option<Bytes> {
        let shorter = |packed: &Bytes| packed.len() < bytes.len();
        // Of concurrent requests, one compresses, and the others wait. Compression into memory
        // cannot fail.
        self.0.get_or_init(|| pack(bytes).ok().filter(shorter)).clone()
    }
}

fn pack(bytes: &[u8]) -> io::Result<Bytes> {
    let mut writer = CompressorWriter::new(Vec::new(), BUFFER_BYTES, QUALITY, WINDOW);
    writer.write_all(bytes)?;
    writer.flush()?;
    Ok(writer.into_inner().into())
}

/// Whether compression pays off: for text and programs that are not short. Images and packages are
/// already compressed, and packages are read by ranges.
pub(crate) fn is_worth_it(media_type: &str, length_bytes: usize) -> bool {
    let is_text = media_type.starts_with("text/")
        || matches!(media_type, "application/json" | "application/wasm" | "image/svg+xml");
    is_text && length_bytes >= LEAST_BYTES
}

/// Whether a client requests a whole file, and accepts brotli (RFC 9110, *HTTP Semantics*, 2022,
/// section 12.5.3; RFC 7932, *Brotli Compressed Data Format*, 2016).
pub(crate) fn is_wanted(headers: &HeaderMap) -> bool {
    let lists = headers.get_all(ACCEPT_ENCODING).into_iter().filter_map(|list| list.to_str().ok());
    let mut ways = lists.flat_map(|list| list.split(','));
    !headers.contains_key(RANGE) && ways.any(names_brotli)
}

/// Whether an accepted encoding is brotli, without a weight of 0.
fn names_brotli(way: &str) -> bool {
    let mut parts = way.split(';').map(str::trim);
    let is_brotli = parts.next().is_some_and(|name| name.eq_ignore_ascii_case("br"));
    let weight = |part: &str| {
        let (name, weight) = part.split_once('=')?;
        name.eq_ignore_ascii_case("q").then(|| weight.parse::<f64>().ok())?
    };
    is_brotli && parts.all(|part| weight(part).is_none_or(|weight| weight > 0.0))
}

/// The tag of the compressed bytes, which differ from those of the file.
pub(crate) fn tag_of(tag: &str) -> String {
    format!("{}-br\"", tag.trim_end_matches('"'))
}

/// The header for caches: answers depend on the encodings that the client accepts.
pub(crate) const VARIES_BY: HeaderValue = HeaderValue::from_static("accept-encoding");

#[cfg(test)]
#[path = "packed_tests.rs"]
mod tests;
