//! Datums, bands and feet: facts that an elevation file lacks are reported, requested or lead to an
//! error, and are never guessed silently.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use corniche_testing::Raster;
use e2e::{Ran, built_in_parts, corniche, manifest, text, write_ascii_grid};
use gdal::{
    DriverManager, Metadata as _,
    spatial_ref::SpatialRef,
    vector::{Geometry, LayerAccess as _, LayerOptions},
};
use serde_json::json;

fn height([x, y]: [f64; 2]) -> f32 {
    (300.0 + (x / 100.0).sin() * 40.0 + (y / 130.0).cos() * 30.0) as f32
}

/// A raster of 40 × 40 samples in a CRS.
fn raster(folder: &Path, epsg: u32, [x, y]: [f64; 2], cell: f64) -> PathBuf {
    let frame = [x, cell, 0.0, y, 0.0, -cell];
    Raster::new(epsg, [40, 40], frame).write(folder, &format!("{epsg}.tif"), height)
}

fn build(dem: &Path, package: &Path, options: &[&str]) -> Ran {
    let line = ["build", "--dem", text(dem), "-O", "-o", text(package), "--quiet"];
    corniche([&line[..], options].concat())
}

fn verified(package: &Path, dem: &Path) {
    let ran = corniche(["verify", text(package), "--dem", text(dem), "--quiet"]);
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
}

/// Accuracies are those of the EPSG registry: ETRS89 to WGS 84 (1), CH1903+ to WGS 84 (1).
#[test]
fn the_way_to_wgs84_and_its_accuracy_are_recorded_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    for (epsg, corner, name) in [
        (25832, [500_000.0, 5_200_000.0], "ETRS89 to WGS 84 (1)"),
        (2056, [2_600_000.0, 1_200_000.0], "CH1903+ to WGS 84 (1)"),
    ] {
        let dem = raster(folder.path(), epsg, corner, 30.0);
        let ran = build(&dem, &package, &[]);
        assert_eq!((ran.code, &*ran.err), (0, ""), "{epsg}");
        let from = format!("EPSG:{epsg}");
        let record =
            json!([{ "from": from, "to": "EPSG:4326", "operation": name, "accuracy_m": 1.0 }]);
        assert_eq!(manifest(&package)["datum_operations"], record);
        let told = corniche(["info", text(&package)]).out;
        let line = format!("positions    {from} to EPSG:4326 by {name}, accurate to 1 m");
        assert!(told.contains(&line), "{told}");
        verified(&package, &dem);
    }
    // For a file in another CRS than the package's, both operations are recorded: that of roads,
    // and that of the file.
    let dem = raster(folder.path(), 2056, [2_600_000.0, 1_200_000.0], 30.0);
    assert_eq!(build(&dem, &package, &["--crs", "EPSG:25832"]).code, 0);
    let made = manifest(&package);
    let ways: Vec<_> =
        (0..2).map(|k| made["datum_operations"][k]["from"].as_str().unwrap()).collect();
    assert_eq!(ways, ["EPSG:25832", "EPSG:2056"]);
    verified(&package, &dem);
    // On the datum of WGS84 there is nothing to record.
    let dem = raster(folder.path(), 32632, [500_000.0, 5_200_000.0], 30.0);
    assert_eq!(build(&dem, &package, &[]).code, 0);
    assert!(manifest(&package).get("datum_operations").is_none());
    assert!(!corniche(["info", text(&package)]).out.contains("positions "));
}

/// NAD27 in Utah. If the NADCON grids are installed, PROJ uses them, and there is no warning.
#[test]
fn a_missing_grid_is_told_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    let dem = raster(folder.path(), 26712, [420_000.0, 4_500_000.0], 30.0);
    let ran = build(&dem, &package, &[]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let record = &manifest(&package)["datum_operations"][0];
    assert!(record["operation"].as_str().unwrap().starts_with("NAD27 to WGS 84"), "{record}");
    if record["accuracy_m"].as_f64().unwrap() > 2.5 {
        for word in ["us_noaa_", "accurate to 7 m", "projsync", "EPSG:26712"] {
            assert!(ran.err.contains(word), "{}", ran.err);
        }
        assert_eq!(ran.err.lines().filter(|line| line.contains("NAD27")).count(), 1, "{}", ran.err);
    }
    verified(&package, &dem);
}

/// A local datum on the ellipsoid of Bessel, as a `.prj` file has it.
const LOCAL: &str = "PROJCS[\"Local\",GEOGCS[\"GCS_Local\",DATUM[\"D_Local_Survey\",SPHEROID[\"Bessel_1841\",6377397.155,\
    299.1528128]],PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]],PROJECTION[\"Gauss_Kruger\"],\
    PARAMETER[\"False_Easting\",4500000.0],PARAMETER[\"False_Northing\",0.0],PARAMETER[\"Central_Meridian\",12.0],\
    PARAMETER[\"Scale_Factor\",1.0],PARAMETER[\"Latitude_Of_Origin\",0.0],UNIT[\"Meter\",1.0]]";

/// An ASCII grid with a `.prj` of a local datum on the Bessel ellipsoid, which differs from WGS84
/// by 100 m and more.
#[test]
fn one_datum_is_taken_for_another_only_where_that_is_allowed() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    let dem = folder.path().join("local.asc");
    let place = "xllcorner 4500000\nyllcorner 5400000\ncellsize 30";
    write_ascii_grid(&dem, [40, 40], place, |column, row| {
        f64::from(height([column as f64, row as f64]))
    });
    fs::write(dem.with_extension("prj"), LOCAL).unwrap();
    for command in ["build", "plan"] {
        let output = folder.path().join(format!("{command}.pmtiles"));
        let ran = corniche([command, "--dem", text(&dem), "-o", text(&output)]);
        assert_eq!(ran.code, 2, "{command}: {}", ran.err);
        for word in ["local.asc", "datum", "100 m", "-a_srs", "--allow-ballpark"] {
            assert!(ran.err.contains(word), "{command}: {}", ran.err);
        }
        assert!(!output.exists(), "{command}");
    }
    let ran = build(&dem, &package, &["--allow-ballpark"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.err.contains("unknown accuracy"), "{}", ran.err);
    assert_eq!(manifest(&package)["datum_operations"][0]["ballpark"], json!(true));
    let told = corniche(["info", text(&package)]).out;
    assert!(told.contains("a ballpark transformation"), "{told}");
    verified(&package, &dem);
    // Parts of a plan that allows ballpark transformations need no permission of their own.
    let planned = corniche(["plan", "--dem", text(&dem), "--allow-ballpark"]);
    assert!(planned.out.contains("a ballpark transformation"), "{}", planned.out);
    let parts = built_in_parts(folder.path(), &["--dem", text(&dem), "--allow-ballpark"]);
    assert!(parts == fs::read(&package).unwrap(), "parts make another package");
}

/// State Plane, US survey feet: heights without a unit may be feet as well.
#[test]
fn heights_without_a_unit_beside_coordinates_in_feet_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    for (epsg, corner) in [(2229, [6_400_000.0, 1_850_000.0]), (2269, [7_600_000.0, 680_000.0])] {
        let dem = raster(folder.path(), epsg, corner, 100.0);
        let ran = build(&dem, &package, &[]);
        assert_eq!(ran.code, 0, "{}", ran.err);
        let name = format!("{epsg}.tif");
        for word in [name.as_str(), "read as metres", "--dem-vertical-crs", "EPSG:6360"] {
            assert!(ran.err.contains(word), "{epsg}: {}", ran.err);
        }
        let ran = build(&dem, &package, &["--dem-vertical-crs", "EPSG:6360"]);
        assert!(ran.code == 0 && !ran.err.contains("read as metres"), "{}", ran.err);
        // 300 ± 70 feet.
        let range = &manifest(&package)["vertical"]["range_m"];
        assert!(range[1].as_f64().unwrap() < 370.0 * 0.305, "{range}");
    }
}

/// If several bands are no colours, the user must select the one with the heights.
#[test]
fn of_several_bands_one_is_to_be_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    let frame = [500_000.0, 30.0, 0.0, 5_200_000.0, 0.0, -30.0];
    let both = Raster::new(32632, [40, 40], frame)
        .bands(2)
        .tagged(|dataset| {
            dataset.rasterband(2).unwrap().set_description("standard deviation").unwrap();
        })
        .write(folder.path(), "two.tif", height);
    let ran = build(&both, &package, &[]);
    assert_eq!(ran.code, 2, "{}", ran.err);
    for word in ["two.tif", "1 (no name, Float32)", "2 \"standard deviation\"", "--dem-band"] {
        assert!(ran.err.contains(word), "{}", ran.err);
    }
    let ran = build(&both, &package, &["--dem-band", "3"]);
    assert!(ran.code == 2 && ran.err.contains("2 bands"), "{}", ran.err);
    assert_eq!(build(&both, &package, &["--dem-band", "1"]).code, 0);
    let chosen = manifest(&package);
    assert_eq!(chosen["settings"]["dem_band"], json!(1));
    verified(&package, &both);
    // The package equals that of a file with this band only, and zeros in the other band.
    let dem = raster(folder.path(), 32632, [500_000.0, 5_200_000.0], 30.0);
    assert_eq!(build(&dem, &package, &[]).code, 0);
    assert_eq!(chosen["vertical"], manifest(&package)["vertical"]);
    assert!(manifest(&package)["settings"].get("dem_band").is_none());
    assert_eq!(build(&both, &package, &["--dem-band", "2"]).code, 0);
    assert_eq!(manifest(&package)["vertical"]["range_m"], json!([0.0, 0.0]));
}

/// Photos and polygons are converted to the datum of the ground in the same way.
#[test]
fn photos_and_polygons_of_an_unknown_datum_are_refused_too() {
    let folder = tempfile::tempdir().unwrap();
    let [package, polygon] = ["out.pmtiles", "part.gpkg"].map(|name| folder.path().join(name));
    let dem = raster(folder.path(), 31468, [4_500_000.0, 5_403_000.0], 75.0);
    let local = LOCAL.replace("Gauss_Kruger", "Transverse_Mercator");
    let local = SpatialRef::from_wkt(&local).unwrap();
    let photo = Raster::new(0, [40, 40], [4_500_000.0, 75.0, 0.0, 5_403_000.0, 0.0, -75.0])
        .bands(3)
        .created(&["PHOTOMETRIC=RGB"])
        .tagged(|dataset| dataset.set_spatial_ref(&local).unwrap())
        .write(folder.path(), "photo.tif", |_| 100_u8);
    let driver = DriverManager::get_driver_by_name("GPKG").unwrap();
    let mut vectors = driver.create_vector_only(&polygon).unwrap();
    let layer = LayerOptions { srs: Some(&local), ..LayerOptions::default() };
    let corners = "4500600 5400600, 4502000 5400600, 4502000 5402000, 4500600 5400600";
    let triangle = Geometry::from_wkt(&format!("POLYGON(({corners}))")).unwrap();
    vectors.create_layer(layer).unwrap().create_feature(triangle).unwrap();
    vectors.close().unwrap();
    for (option, file) in [("--photo", &photo), ("--polygon", &polygon)] {
        let ran = build(&dem, &package, &[option, text(file)]);
        assert_eq!(ran.code, 2, "{option}: {}", ran.err);
        let name = file.file_name().unwrap().to_str().unwrap();
        for word in [name, "datum", "--allow-ballpark"] {
            assert!(ran.err.contains(word), "{option}: {}", ran.err);
        }
        let ran = build(&dem, &package, &[option, text(file), "--allow-ballpark"]);
        assert_eq!(ran.code, 0, "{option}: {}", ran.err);
        assert!(ran.err.contains(name) && ran.err.contains("unknown accuracy"), "{}", ran.err);
    }
    assert_eq!(build(&dem, &package, &[]).code, 0);
    // For lines: here the outline of the triangle.
    let picture = folder.path().join("map.png");
    for command in [
        &["profile", text(&package), "--line", text(&polygon)][..],
        &["render", text(&package), "-o", text(&picture), "--overlay", text(&polygon)],
        &["match", text(&package), "--photo", text(&photo)],
    ] {
        let ran = corniche(command);
        assert_eq!(ran.code, 2, "{command:?}: {}", ran.err);
        for word in ["datum", "--allow-ballpark"] {
            assert!(ran.err.contains(word), "{command:?}: {}", ran.err);
        }
        let allowed = corniche([command, &["--allow-ballpark"]].concat());
        assert!(!allowed.err.contains("--allow-ballpark"), "{command:?}: {}", allowed.err);
        assert!(allowed.err.contains("unknown accuracy"), "{command:?}: {}", allowed.err);
    }
}

/// Lines in NAD27, where grids may be missing, are converted, and this is reported.
#[test]
fn lines_whose_datum_has_a_better_operation_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let [package, lines] = ["out.pmtiles", "lines.gpkg"].map(|name| folder.path().join(name));
    let dem = raster(folder.path(), 26912, [420_000.0, 4_500_000.0], 30.0);
    assert_eq!(build(&dem, &package, &[]).code, 0);
    let driver = DriverManager::get_driver_by_name("GPKG").unwrap();
    let mut vectors = driver.create_vector_only(&lines).unwrap();
    let system = SpatialRef::from_epsg(26712).unwrap();
    let layer = LayerOptions { srs: Some(&system), ..LayerOptions::default() };
    let line = Geometry::from_wkt("LINESTRING(420300 4499500, 420800 4499000)").unwrap();
    vectors.create_layer(layer).unwrap().create_feature(line).unwrap();
    vectors.close().unwrap();
    let ran = corniche(["profile", text(&package), "--line", text(&lines)]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    // If the grids are installed, there is nothing to report.
    if !ran.err.is_empty() {
        for word in ["lines.gpkg", "EPSG:26712", "us_noaa_", "projsync"] {
            assert!(ran.err.contains(word), "{}", ran.err);
        }
    }
}
