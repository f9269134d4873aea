//! Photos in 3D Tiles are at the same positions on the ground as in the package.

use std::fs;

use e2e::{
    ground::FromEarth,
    manifest,
    photo::{build, colour, inputs, photo},
};
use gdal::{Dataset, raster::Buffer};
use tempfile::TempDir;

use super::{
    export,
    glb::Glb,
    pass,
    tiles::{Tiles, files_of, has_ending},
};

/// The ground has the colour that the photo has at its longitude and latitude.
#[test]
fn photos_lie_where_they_should() {
    let folder = TempDir::new().unwrap();
    let photo = photo(folder.path(), 0.2, "photo.tif");
    let package = folder.path().join("photo.pmtiles");
    let words = inputs(&[&photo]);
    let _ = build(&words, &package, &["--photo-quality", "95", "--dem-vertical-crs", "EPSG:5773"]);
    let bounds = &manifest(&package)["wgs84_bounds"];
    let bounds = ["min_x", "min_y", "max_x", "max_y"].map(|key| bounds[key].as_f64().unwrap());
    let with = export(&package, "with", &["--style", "photo", "--roads", "none"]);
    let tiles = Tiles::read(&with, &package);
    let to_degrees =
        FromEarth::to(&crate::export_tiles3d::Region { crs: "EPSG:4979".to_owned(), ..pass() });
    let (mut compared, mut off) = (0, 0);
    for (name, path) in files_of(&with).into_iter().filter(|(name, _)| has_ending(name, "glb")) {
        let glb = Glb::read(&path);
        let Some(jpeg) = glb.picture() else { continue };
        let file = folder.path().join("picture.jpg");
        fs::write(&file, jpeg).unwrap();
        let picture = Dataset::open(&file).unwrap();
        let side = picture.raster_size().0;
        let bands: Vec<Buffer<u8>> =
            (1..=3).map(|band| picture.rasterband(band).unwrap().read_band_as().unwrap()).collect();
        // Only the finest tiles have texels that are finer than the photo's waves.
        if !name.starts_with("3/") {
            continue;
        }
        for primitive in &glb.primitives {
            let on_earth: Vec<_> = primitive.at_m.iter().map(|at| tiles.on_earth(*at)).collect();
            let degrees = to_degrees.carry(&on_earth);
            for (place, [lon, lat, _]) in primitive.picture_places.iter().zip(degrees) {
                assert!(place.iter().all(|share| (0.0..=1.0).contains(share)));
                let (u, v) = (
                    (lon - bounds[0]) / (bounds[2] - bounds[0]),
                    (lat - bounds[1]) / (bounds[3] - bounds[1]),
                );
                // Well inside the photo.
                if !(0.23..0.67).contains(&u) || !(0.27..0.76).contains(&v) {
                    continue;
                }
                let [column, row] =
                    place.map(|share| ((share * side as f32) as usize).min(side - 1));
                let expected = colour([lon, lat], bounds);
                compared += 1;
                let differs = (0..3).any(|band| {
                    bands[band].data()[row * side + column].abs_diff(expected[band]) > 16
                });
                off += usize::from(differs);
            }
        }
    }
    assert!(compared > 2000, "{compared}");
    assert!(off * 50 < compared, "{off} of {compared} have another colour");
}
