//! Two vertical systems have the same datum if its name is the same; systems without a named datum
//! only if they are identical.

use std::path::{Path, PathBuf};

use corniche_dem::OpenOptions;
use gdal::raster::RasterCreationOptions;
use gdal::spatial_ref::SpatialRef;
use gdal::{Dataset, DriverManager};

use crate::fixture::{Raster, UTM, check_refused};
use crate::vertical::{given, vertical};

/// A virtual file beside a file, in a coordinate system that GeoTIFF has no keys for.
pub(crate) fn relabelled(path: &Path, wkt: &str) -> PathBuf {
    let own = path.with_extension("vrt");
    let driver = DriverManager::get_driver_by_name("VRT").unwrap();
    let source = Dataset::open(path).unwrap();
    let mut copy = source.create_copy(&driver, &own, &RasterCreationOptions::default()).unwrap();
    copy.set_spatial_ref(&SpatialRef::from_wkt(wkt).unwrap()).unwrap();
    copy.close().unwrap();
    own
}

/// "Unknown" is not a datum that two systems could share.
#[test]
fn systems_without_a_datum_are_the_same_only_word_for_word() {
    let folder = tempfile::tempdir().unwrap();
    let frame = |column: f64| [UTM[0] + 10.0 * column, 10.0, 0.0, UTM[3], 0.0, -10.0];
    let half = |file: &str, column: f64| {
        Raster::new(32632, [30, 50], frame(column)).write(folder.path(), file, |_| 500.0_f32)
    };
    let files = [half("west.tif", 0.0), half("east.tif", 30.0)];
    let own = |name: &str, datum: &str| {
        format!(
            "VERTCRS[\"{name}\",VDATUM[\"{datum}\"],CS[vertical,1],\
             AXIS[\"gravity-related height (H)\",up],LENGTHUNIT[\"metre\",1]]"
        )
    };
    let named = |file: &str, name: &str, datum: &str| {
        let text = own(name, datum);
        let utm = SpatialRef::from_epsg(32632).unwrap().to_wkt().unwrap();
        let text = format!("COMPOUNDCRS[\"both\",{utm},{text}]");
        let column = if file.starts_with("west") { 0.0 } else { 30.0 };
        relabelled(&half(file, column), &text)
    };
    for datum in ["", "unknown", "Unknown", "unnamed", "unnamed datum", "Not specified"] {
        let text = own("harbour height", datum);
        let (found, words) = vertical(&files, &given(&text, &text));
        assert_eq!(found.as_deref(), Some("harbour height"), "{datum}");
        assert!(words.ends_with("as in the files"), "{words}");
        let words = ["west.tif", "harbour height", "castle height", "--vertical-shift"];
        check_refused(&files, &given(&text, &own("castle height", datum)), &words);
        check_refused(&files, &given(&text, "EPSG:5703"), &["west.tif", "harbour", "NAVD88"]);
        check_refused(&files, &given("EPSG:5703", &text), &["west.tif", "harbour", "NAVD88"]);
        let west = named("west.tif", "harbour height", datum);
        let east = |name: &str| named("east.tif", name, datum);
        let plain = OpenOptions::default();
        let words = ["west.vrt", "east.vrt", "harbour height", "castle height", "no datum"];
        check_refused(&[west.clone(), east("castle height")], &plain, &words);
        let alike = vertical(&[west, east("harbour height")], &plain);
        assert_eq!(alike, (Some("harbour height".to_owned()), "as in the files".to_owned()));
    }
    // A named datum is the same, whatever the name of the system on it.
    let (one, other) = (own("harbour height", "Harbour gauge"), own("harbour", "Harbour gauge"));
    assert!(vertical(&files, &given(&one, &other)).1.contains("as in the files"));
}

/// WGS 84 / UTM with a third axis.
fn utm_3d(zone: u32) -> String {
    let angle = "ANGLEUNIT[\"degree\",0.0174532925199433]";
    let metre = "LENGTHUNIT[\"metre\",1]";
    format!(
        "PROJCRS[\"WGS 84 / UTM zone {zone}N\",BASEGEOGCRS[\"WGS 84\",DATUM[\"World Geodetic System 1984\",\
         ELLIPSOID[\"WGS 84\",6378137,298.257223563,{metre}]],PRIMEM[\"Greenwich\",0,{angle}]],\
         CONVERSION[\"UTM zone {zone}N\",METHOD[\"Transverse Mercator\",ID[\"EPSG\",9807]],\
         PARAMETER[\"Latitude of natural origin\",0,{angle}],\
         PARAMETER[\"Longitude of natural origin\",{},{angle}],\
         PARAMETER[\"Scale factor at natural origin\",0.9996,SCALEUNIT[\"unity\",1]],\
         PARAMETER[\"False easting\",500000,{metre}],PARAMETER[\"False northing\",0,{metre}]],\
         CS[Cartesian,3],AXIS[\"(E)\",east,ORDER[1],{metre}],AXIS[\"(N)\",north,ORDER[2],{metre}],\
         AXIS[\"ellipsoidal height (h)\",up,ORDER[3],{metre}]]",
        6 * i64::from(zone) - 183
    )
}

/// Heights above one ellipsoid are equal, regardless of the UTM zone.
#[test]
fn ellipsoidal_heights_of_two_zones_agree() {
    let folder = tempfile::tempdir().unwrap();
    let file = |zone: u32, east: f64| {
        let frame = [east, 10.0, 0.0, UTM[3], 0.0, -10.0];
        let bare = Raster::new(32600 + zone, [60, 50], frame).write(
            folder.path(),
            &format!("{zone}.tif"),
            |_| 700.0_f32,
        );
        relabelled(&bare, &utm_3d(zone))
    };
    let files = [file(32, 700_000.0), file(33, 300_000.0)];
    let (datum, words) = vertical(&files, &OpenOptions::default());
    assert_eq!(datum.as_deref(), Some("ellipsoidal height (WGS 84)"));
    assert_eq!(words, "as in the files");
    // They are also those of the geographic system: no conversion is needed.
    let words = vertical(&files, &given("", "EPSG:4979")).1;
    assert_eq!(words, "ellipsoidal height (WGS 84), as in the files");
    // Another datum differs.
    let other = Raster::new(32632, [60, 50], UTM).write(folder.path(), "other.tif", |_| 500.0_f32);
    let both = [files[0].clone(), other];
    let words = ["32.vrt", "other.tif", "WGS 84", "ETRS89"];
    check_refused(&both, &given("EPSG:4937", ""), &words);
}
