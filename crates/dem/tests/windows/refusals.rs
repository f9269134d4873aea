use std::fs;

use corniche_dem::{Dem, DemError, OpenOptions};

use crate::fixture::{Raster, all, open, options};

const UTM: [f64; 6] = [500_000.0, 10.0, 0.0, 5_200_000.0, 0.0, -10.0];

#[test]
fn errors_name_the_file_and_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("empty.tif"), b"").unwrap();
    fs::write(path("noise.tif"), b"no raster at all").unwrap();
    Raster::new(0, [6, 5], UTM).write(folder.path(), "bare.tif", |_| 1.0_f32);
    Raster::new(32632, [6, 5], [0.0; 6]).write(folder.path(), "nowhere.tif", |_| 1.0_f32);
    for (name, words) in [
        ("missing.tif", "cannot open"),
        ("empty.tif", "0 bytes"),
        ("noise.tif", "not a raster"),
        ("bare.tif", "--dem-crs"),
        ("nowhere.tif", "georeference"),
    ] {
        let error = Dem::open(&[path(name)], &OpenOptions::default()).unwrap_err().to_string();
        assert!(error.contains(name) && error.contains(words), "{error}");
    }
    assert!(matches!(Dem::open(&[], &OpenOptions::default()), Err(DemError::NoFiles)));
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
    let error = dem.reader(&plan).unwrap().window(all(&plan)).unwrap_err().to_string();
    assert!(error.contains("cut.tif"), "{error}");
}
