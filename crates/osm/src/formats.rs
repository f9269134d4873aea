//! Recognises files of other formats by their first bytes, and says how to convert them.

use std::path::Path;

/// The number of bytes of a file that are examined.
pub(crate) const START_BYTES: u64 = 4096;

const TO_PBF: &str = "convert it with: osmium cat IN -o OUT.osm.pbf";
const UNPACK: &str =
    "unpack it; if it contains OSM data, convert them with: osmium cat IN -o OUT.osm.pbf";
const CHANGE: &str = "apply it to the extract that it belongs to: \
                      osmium apply-changes IN.osm.pbf CHANGES -o OUT.osm.pbf";
const HISTORY: &str =
    "extract one point in time: osmium time-filter IN 2026-01-01T00:00:00Z -o OUT.osm.pbf";
const FETCH: &str = "its download failed; download the extract again";
const PULL: &str = "download the file that it points to: git lfs pull";
const OTHER: &str = "pass an OpenStreetMap extract in the .osm.pbf format";

/// The first bytes of other file formats, each with the format's name and the advice.
const MAGIC: [(&[u8], &str, &str); 19] = [
    (b"version https://git-lfs", "a Git LFS pointer", PULL),
    (b"\x1f\x8b", "compressed with gzip", TO_PBF),
    (b"BZh", "compressed with bzip2", TO_PBF),
    (b"PK\x03\x04", "a zip archive", UNPACK),
    (b"\x28\xb5\x2f\xfd", "compressed with zstd", UNPACK),
    (b"\xfd7zXZ\0", "compressed with xz", UNPACK),
    (b"\x04\x22\x4d\x18", "compressed with LZ4", UNPACK),
    (b"7z\xbc\xaf\x27\x1c", "a 7-Zip archive", UNPACK),
    (b"\xff\xe0\x04o5m2", "o5m", TO_PBF),
    (b"\xff\xe0\x04o5c2", "a change file (o5c)", CHANGE),
    (b"PMTiles", "a tile package (PMTiles)", OTHER),
    (b"SQLite format 3\0", "an SQLite database (GeoPackage, MBTiles)", OTHER),
    (b"\0\0\x27\x0a", "a shapefile", OTHER),
    (b"II*\0", "a TIFF", OTHER),
    (b"MM\0*", "a TIFF", OTHER),
    (b"II+\0", "a BigTIFF", OTHER),
    (b"MM\0+", "a BigTIFF", OTHER),
    (b"{", "JSON", OTHER),
    (b"[", "JSON", OTHER),
];

/// Returns the actual format of the file and an advice; `None` if the file may be `.osm.pbf`.
pub(crate) fn other_format(path: &Path, start: &[u8]) -> Option<(&'static str, &'static str)> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    let advice = |usual| match () {
        () if usual == TO_PBF && name.contains(".osc") => CHANGE,
        () if usual == TO_PBF && name.contains(".osh") => HISTORY,
        () => usual,
    };
    if is_blob_header(start) {
        return None;
    }
    if let Some(text) = utf16(start) {
        let (found, usual) = match text.trim_start() {
            text if text.starts_with('<') => markup(text.as_bytes()),
            _ => ("text in UTF-16", OTHER),
        };
        return Some((found, advice(usual)));
    }
    let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start).trim_ascii_start();
    if text.starts_with(b"<") {
        let (found, usual) = markup(text);
        return Some((found, advice(usual)));
    }
    let is_magic = |magic: &[u8]| start.starts_with(magic) || text.starts_with(magic);
    if let Some(&(_, found, usual)) = MAGIC.iter().find(|(magic, ..)| is_magic(magic)) {
        return Some((found, advice(usual)));
    }
    if is_opl(text) {
        return Some(("OPL", advice(TO_PBF)));
    }
    let is_text = !start.iter().any(|&byte| byte < b'\t' || byte == 0x7f);
    Some((if is_text { "text" } else { "a file of unknown format" }, OTHER))
}

/// Decodes text whose first two bytes say that it is UTF-16.
fn utf16(start: &[u8]) -> Option<String> {
    let to_unit = match start.first_chunk()? {
        b"\xff\xfe" => u16::from_le_bytes,
        b"\xfe\xff" => u16::from_be_bytes,
        _ => return None,
    };
    let units = start[2..].as_chunks().0.iter().map(|&pair| to_unit(pair));
    let text: String =
        char::decode_utf16(units).map(|char| char.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
    (!text.contains('\0')).then_some(text)
}

/// Distinguishes files that begin with `<` by their first element.
fn markup(text: &[u8]) -> (&'static str, &'static str) {
    let mut rest = text;
    // Skip declarations, comments and document types.
    while let [b'<', b'?' | b'!', kind, ..] = rest {
        if kind.eq_ignore_ascii_case(&b'd') && rest[1] == b'!' {
            break;
        }
        let end = if rest.starts_with(b"<!--") { &b"-->"[..] } else { b">" };
        let Some(at) = rest.windows(end.len()).position(|window| window == end) else { break };
        rest = rest[at + end.len()..].trim_ascii_start();
    }
    let is = |name: &[u8]| rest.get(..name.len()).is_some_and(|own| own.eq_ignore_ascii_case(name));
    if is(b"<osmChange") {
        ("a change file (osmChange XML)", CHANGE)
    } else if is(b"<html") || is(b"<!doctype html") {
        ("an HTML page", FETCH)
    } else if is(b"<osm") || rest.is_empty() {
        ("XML", TO_PBF)
    } else {
        ("XML without OpenStreetMap data", OTHER)
    }
}

/// Whether the text begins like OPL: an object's letter and id, then a space: `w10 v1 …` (*OPL File
/// Format*, libosmium manual).
fn is_opl(text: &[u8]) -> bool {
    let line = text.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let Some((b'n' | b'w' | b'r', rest)) = line.split_first() else { return false };
    let id = rest.split(|&byte| byte == b' ').next().unwrap_or_default();
    let digits = id.strip_prefix(b"-").unwrap_or(id);
    !digits.is_empty() && digits.iter().all(u8::is_ascii_digit)
}

/// Whether the file may begin with the frame of a blob, followed by the blob's type, which every
/// writer puts first.
///
/// ```text
///  0 0 size size │ 0x0a len │ O S M H e a d e r       a file cut off before that may still be one
/// ```
fn is_blob_header(start: &[u8]) -> bool {
    let is_size = start.iter().take(2).all(|&byte| byte == 0);
    let is_type_field = start.get(4).is_none_or(|&key| key == 0x0a);
    let len = start.get(5).copied().map_or(0, usize::from);
    let kind = &start[start.len().min(6)..start.len().min(6 + len)];
    is_size && is_type_field && kind.iter().all(u8::is_ascii_graphic)
}
