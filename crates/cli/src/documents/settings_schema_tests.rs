//! The schema of a package's settings, from the table of all settings. The record has its own
//! serialization; the types here exist only for the schema.

use corniche_settings::SettingsRecord;
use serde_json::json;

/// A cell, east and north.
type Cell = [f64; 2];
/// The name of a choice of levels.
type ReliefLevels = String;
type PolygonRecord = PolygonDocument;
type LayerTableRecord = LayerTableDocument;
type PhotoRecord = PhotoDocument;

/// The polygon that the package was clipped to.
#[derive(schemars::JsonSchema)]
#[expect(dead_code, reason = "only its schema is wanted")]
pub(crate) struct PolygonDocument {
    /// File name without folders.
    name: String,
    /// SHA-256 of its coordinate system and vertices, independent of the format of the file.
    sha256: String,
}

/// The table of a layer.
#[derive(schemars::JsonSchema)]
#[expect(dead_code, reason = "only its schema is wanted")]
pub(crate) struct LayerTableDocument {
    /// The id of the layer.
    id: String,
    /// SHA-256 of the table as JSON.
    sha256: String,
}

/// How the photos of a package are stored.
#[derive(schemars::JsonSchema)]
#[expect(dead_code, reason = "only its schema is wanted")]
pub(crate) struct PhotoDocument {
    /// A cell of the finest level has 2^levels texels along each side.
    levels: u8,
    /// JPEG quality, from 1 to 100.
    quality: u8,
}

macro_rules! schema {
    ($($section:ident {
        $(#[$($attr:tt)*])*
        [$($flags:tt)*] $key:ident: $type:ty
        $(, left_out $left_out:literal)? $(, within $range:expr)?
        $(, at $($path:ident).+ $(, usual $usual:expr)?)?
    })*) => {
        /// Settings that determine the bytes of a package.
        #[derive(schemars::JsonSchema)]
        #[schemars(transform = with_keys_in_order)]
        #[expect(dead_code, reason = "only its schema is wanted")]
        pub(crate) struct SettingsDocument {
            $($(#[$($attr)*])* $(#[serde(skip_serializing_if = $left_out)])? $key: $type,)*
        }
    };
}

corniche_settings::recorded! { [schema] }

/// Keys that are always present are in the order of the manifest.
fn with_keys_in_order(schema: &mut schemars::Schema) {
    let Some(required) = schema.get_mut("required") else { return };
    let told = required.take();
    let is_told = |key: &&str| *key == "relief" || told.as_array().unwrap().contains(&json!(key));
    *required = SettingsRecord::keys().into_iter().filter(is_told).collect();
}
