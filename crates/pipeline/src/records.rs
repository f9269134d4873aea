//! Texts and hashes that the manifest records: what the build writes and `verify` compares.

use corniche_roads::FrcTable;
use corniche_tileset::SettingsRecord;
use sha2::{Digest, Sha256};

/// What every package says of its tiles' numbers.
pub(crate) const TILING: &str = "local quadtree in the working CRS: z from the root, x from the west, y from the \
                                 north; not the web's tile scheme";

/// SHA-256 of settings as JSON.
pub(crate) fn settings_sha256(settings: &SettingsRecord) -> String {
    // A record of numbers and texts has no way to fail to be JSON; the text of its debugging form is as unique.
    let json = serde_json::to_string(settings).unwrap_or_else(|_| format!("{settings:?}"));
    hex(&Sha256::digest(json))
}

/// SHA-256 of an FRC table's text.
pub(crate) fn table_sha256(table: &FrcTable) -> String {
    hex(&Sha256::digest(table.canonical_text()))
}

/// Lower-case hexadecimal.
pub(crate) fn hex(bytes: &[u8]) -> String {
    use std::fmt::Write as _;
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
