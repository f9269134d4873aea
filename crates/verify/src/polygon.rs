//! Checks that the given polygon is the one to which the package was clipped.

use corniche_gis::RegionPolygons;
use corniche_spec::settings_record::polygon_sha256;
use corniche_tileset::Manifest;

use super::error::{Result, VerifyError};

/// Fails if a polygon is needed and missing, or another one is given.
pub(crate) fn check(manifest: &Manifest, polygon: Option<&RegionPolygons>) -> Result<()> {
    match (&manifest.settings.polygon, polygon) {
        (None, None) => Ok(()),
        (Some(recorded), None) => {
            Err(VerifyError::PolygonMissing { expected: recorded.name.clone() })
        }
        (None, Some(_)) => Err(VerifyError::NoPolygon),
        (Some(recorded), Some(given)) if recorded.sha256 == polygon_sha256(given) => Ok(()),
        (Some(recorded), Some(given)) => Err(VerifyError::OtherPolygon {
            path: given.path().to_path_buf(),
            expected: recorded.name.clone(),
        }),
    }
}
