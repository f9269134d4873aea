//! The binary container of glTF: header, document and one chunk of bytes.

use std::io::{self, Write};

use serde_json::Value;

const HEADER_BYTES: u64 = 12;
const CHUNK_HEADER_BYTES: u64 = 8;

/// The length of a chunk is a multiple of this.
pub(crate) const CHUNK_ALIGNMENT: usize = 4;

/// Writes a binary glTF: its document, and `length` bytes, a multiple of [`CHUNK_ALIGNMENT`], that `put` writes.
pub(crate) fn write_container<W: Write + ?Sized>(
    into: &mut W,
    document: &Value,
    length: u64,
    put: impl FnOnce(&mut W) -> io::Result<()>,
) -> io::Result<()> {
    let mut json = document.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(CHUNK_ALIGNMENT), b' ');
    let total = HEADER_BYTES + 2 * CHUNK_HEADER_BYTES + json.len() as u64 + length;
    let too_large = |_| io::Error::new(io::ErrorKind::FileTooLarge, "a GLB ends at 4 GiB");
    let number = |bytes: u64| u32::try_from(bytes).map(u32::to_le_bytes).map_err(too_large);
    into.write_all(b"glTF")?;
    into.write_all(&2_u32.to_le_bytes())?;
    into.write_all(&number(total)?)?;
    into.write_all(&number(json.len() as u64)?)?;
    into.write_all(b"JSON")?;
    into.write_all(&json)?;
    into.write_all(&number(length)?)?;
    into.write_all(b"BIN\0")?;
    put(into)
}
