//! Errors of reading a polygon file that elevation data are cut with.

use std::path::PathBuf;

use crate::LibraryError;

/// Why a file gives no polygon to cut elevation data with.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum PolygonError {
    #[error("cannot open the polygon {path:?}")]
    Missing { path: PathBuf, source: std::io::Error },
    #[error("the polygon {path:?} is a pipe or a device; save it to a file first")]
    Stream { path: PathBuf },
    #[error(
        "{path:?} is not a vector file that GDAL can read; it is damaged, cut off, or of an unknown format; GeoJSON, GeoPackage and Shapefile can be read (ogr2ogr converts others)"
    )]
    Open { path: PathBuf, source: Box<LibraryError> },
    #[error("cannot read {path:?}: {advice}")]
    NoDriver { path: PathBuf, advice: String },
    #[error("not all features of the polygon {path:?} can be read; fetch or export it again")]
    Damaged { path: PathBuf, source: Box<LibraryError> },
    #[error(
        "layer {layer:?} of the polygon {path:?} claims to have {claimed} features, and {found} can be read: it is damaged or cut off; fetch or export it again"
    )]
    CutOff { path: PathBuf, layer: String, claimed: u64, found: u64 },
    #[error(
        "{path:?} has no polygon: it is empty; give a file with a polygon or several, which are united"
    )]
    Empty { path: PathBuf },
    #[error(
        "feature {feature} of {path:?} is a {found}, and encloses nothing; give polygons alone (ogr2ogr -where selects features, -nlt CONVERT_TO_LINEAR makes arcs straight)"
    )]
    OtherGeometry { path: PathBuf, feature: u64, found: String },
    #[error(
        "the polygon {path:?} names no coordinate system; give it one: ogr2ogr -a_srs EPSG:n NEW.gpkg {path:?}, or the .prj file beside a Shapefile"
    )]
    NoCrs { path: PathBuf },
    #[error("the coordinate system of the polygon {path:?} cannot be used: {reason}")]
    Crs { path: PathBuf, reason: String },
    #[error(
        "feature {feature} of the polygon {path:?} is not valid ({reason}), so its inside is not known; mend it: ogr2ogr -makevalid NEW.gpkg {path:?}"
    )]
    Invalid { path: PathBuf, feature: u64, reason: String },
    #[error(
        "a ring of feature {feature} of the polygon {path:?} begins at {}, {} and ends at {}, {}; repeat its first position as \
         its last one, which closes it (RFC 7946, section 3.1.6)",
        .first[0], .first[1], .last[0], .last[1]
    )]
    OpenRing { path: PathBuf, feature: u64, first: [f64; 2], last: [f64; 2] },
    #[error(
        "feature {feature} of the polygon {path:?} has an edge over more than half of the earth: if it crosses 180°, cut it there (ogr2ogr -wrapdateline NEW.geojson {path:?})"
    )]
    HalfTheEarth { path: PathBuf, feature: u64 },
    #[error("the polygon {path:?} has more than {limit} corners; simplify it (ogr2ogr -simplify)")]
    TooManyCorners { path: PathBuf, limit: usize },
    #[error(
        "the polygon {path:?} reaches to where {crs} has no positions or is torn apart; cut it to the surroundings of the elevation data (ogr2ogr -clipsrc), or choose another --crs"
    )]
    OutsideCrs { path: PathBuf, crs: String },
    #[error("the polygon {path:?} encloses no area; its corners lie on a line or at one place")]
    NoArea { path: PathBuf },
}
