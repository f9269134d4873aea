//! Errors of elevation files name the file and say what to do.

use std::fs;

use corniche_dem::{Dem, OpenDemError, OpenOptions, PlanOptions};

use crate::fixture::{Raster, all, check_refused, check_words, open, options};

const UTM: [f64; 6] = [500_000.0, 10.0, 0.0, 5_200_000.0, 0.0, -10.0];

#[test]
fn errors_name_the_file_and_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("empty.tif"), b"").unwrap();
    fs::write(path("noise.tif"), b"no raster at all").unwrap();
    let pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 25934402\n";
    fs::write(path("pointer.hgt"), pointer).unwrap();
    fs::write(path("N47E009.hgt"), vec![1; 1_400_000]).unwrap();
    fs::write(path("alps.hgt"), vec![1; 2_884_802]).unwrap();
    fs::write(path("N47E010.hgt"), vec![1; 2_884_803]).unwrap();
    fs::write(path("page.tif"), "\n<!DOCTYPE html>\n<html>404 Not Found</html>").unwrap();
    let report = "<?xml version=\"1.0\"?><ows:ExceptionReport version=\"2.0.0\"/>";
    fs::write(path("report.tif"), report).unwrap();
    Raster::new(0, [6, 5], UTM).write(folder.path(), "bare.tif", |_| 1.0_f32);
    Raster::new(32632, [6, 5], [0.0; 6]).write(folder.path(), "nowhere.tif", |_| 1.0_f32);
    for (name, words) in [
        ("missing.tif", "cannot open"),
        ("empty.tif", "0 bytes"),
        ("noise.tif", "not a raster"),
        ("pointer.hgt", "a Git LFS pointer"),
        ("pointer.hgt", "git lfs pull"),
        ("N47E009.hgt", "has 1400000 bytes; whole .hgt files have 2884802"),
        ("N47E010.hgt", "has 2884803 bytes"),
        ("alps.hgt", "like N47E009.hgt"),
        ("page.tif", "an HTML page; its download failed"),
        ("report.tif", "an error report of a server"),
        ("bare.tif", "--dem-crs"),
        ("nowhere.tif", "georeference"),
    ] {
        let error = Dem::open(&[path(name)], &OpenOptions::default()).unwrap_err().to_string();
        assert!(error.contains(name) && error.contains(words), "{error}");
    }
    assert!(matches!(Dem::open(&[], &OpenOptions::default()), Err(OpenDemError::NoFiles)));
    let not_a_file =
        Dem::open(&[folder.path().to_path_buf()], &OpenOptions::default()).unwrap_err();
    assert!(not_a_file.to_string().contains("not a file"));
    let nonsense = OpenOptions { dem_crs: Some("Atlantis".to_owned()), ..OpenOptions::default() };
    let error = Dem::open(&[path("bare.tif")], &nonsense).unwrap_err().to_string();
    assert!(error.contains("--dem-crs") && error.contains("Atlantis"), "{error}");
}

#[test]
fn a_file_cut_off_behind_our_back_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path =
        Raster::new(32632, [400, 400], UTM).write(folder.path(), "cut.tif", |at| at[0] as f32);
    let dem = open(std::slice::from_ref(&path));
    let plan = dem.plan(&options()).unwrap();
    let bytes = fs::read(&path).unwrap();
    fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    let error = dem.reader(&plan).window(all(&plan)).unwrap_err().to_string();
    assert!(error.contains("cut.tif"), "{error}");
}

#[test]
fn names_of_coordinate_systems_are_refused_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let file = Raster::new(32632, [6, 5], UTM).write(folder.path(), "a.tif", |_| 1.0_f32);
    let dem = open(&[file]);
    for (text, words) in [
        ("nonsense", "EPSG:n or WKT"),
        ("EPSG:999999", "EPSG:n or WKT"),
        ("", "EPSG:n or WKT"),
        ("PROJCS[\"half a", "EPSG:n or WKT"),
        ("EPSG:5773", "neither projected nor geographic"),
        ("EPSG:4326", "neither a projected coordinate system"),
        ("EPSG:4269", "nor the CRS of the DEM"),
    ] {
        let asked = PlanOptions { crs: Some(text.to_owned()), ..options() };
        let error = dem.plan(&asked).unwrap_err();
        check_words(&error, &["--crs", words]);
    }
    // Far from where the projection reaches.
    let asked = PlanOptions { crs: Some("EPSG:5042".to_owned()), ..options() };
    assert!(
        dem.plan(&asked).is_ok(),
        "the south polar stereographic reaches all but the north pole"
    );
}

#[test]
fn a_file_that_lies_nowhere_is_named_also_among_others() {
    let folder = tempfile::tempdir().unwrap();
    let here = Raster::new(32632, [6, 5], UTM).write(folder.path(), "here.tif", |_| 1.0_f32);
    let nowhere = Raster::new(32632, [6, 5], [1e12, 10.0, 0.0, 1e12, 0.0, -10.0]).write(
        folder.path(),
        "nowhere.tif",
        |_| 1.0_f32,
    );
    let words = ["nowhere.tif", "nowhere on earth", "EPSG:32632", "-a_srs"];
    check_refused(std::slice::from_ref(&nowhere), &OpenOptions::default(), &words);
    check_refused(&[here, nowhere], &OpenOptions::default(), &words);
    // On earth, but where a gnomonic projection about the other file does not reach.
    let square = |west: f64, name: &str| {
        Raster::new(4326, [6, 5], [west, 0.1, 0.0, 0.0, 0.0, -0.1]).write(
            folder.path(),
            name,
            |_| 1.0_f32,
        )
    };
    let dem = open(&[square(9.0, "near.tif"), square(119.0, "far.tif")]);
    let gnomonic = "+proj=gnom +lat_0=0 +lon_0=9 +datum=WGS84 +units=m +type=crs";
    let asked = PlanOptions {
        crs: Some(gnomonic.to_owned()),
        cell: Some(10_000.0_f64.into()),
        ..options()
    };
    check_words(&dem.plan(&asked).unwrap_err(), &["far.tif", "no position in", "--crs"]);
}
