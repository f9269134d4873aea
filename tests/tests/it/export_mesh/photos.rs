//! Photos in models are at the same positions on the ground as in the package.

use std::fs;

use e2e::{
    manifest,
    photo::{build, colour, inputs, photo},
    root, text,
};
use gdal::{
    Dataset,
    raster::Buffer,
    spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef},
};
use serde_json::Value;

use super::{
    export, origin,
    readers::{Pictured, read_glb, read_pictures},
};

/// The ground has the colour that the photo has at its longitude and latitude, also between roads
/// as surfaces.
#[test]
fn photos_lie_where_they_should() {
    let folder = tempfile::tempdir().unwrap();
    let photo = photo(folder.path(), 0.2, "photo.tif");
    let package = folder.path().join("photo.pmtiles");
    let _ = build(&inputs(&[&photo]), &package, &["--photo-quality", "95"]);
    let found = manifest(&package);
    let bounds = &found["wgs84_bounds"];
    let bounds = ["min_x", "min_y", "max_x", "max_y"].map(|key| bounds[key].as_f64().unwrap());
    let pair = |value: &Value| [0, 1].map(|axis: usize| value[axis].as_f64().unwrap());
    let scale = pair(&found["scale"]["center"]);
    let [east_m, north_m] = origin(&package, &[]);
    let path = export(&package, "m.glb", &["--style", "photo", "--roads", "surfaces"]);
    let to_degrees = {
        let [from, to] = [32632, 4326].map(|code| {
            let mut reference = SpatialRef::from_epsg(code).unwrap();
            reference.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
            reference
        });
        CoordTransform::new(&from, &to).unwrap()
    };
    let pictures = read_pictures(&path);
    assert!(pictures.len() > 4, "{}", pictures.len());
    let (mut compared, mut off) = (0, 0);
    for Pictured { corners, places, jpeg } in pictures {
        let file = folder.path().join("picture.jpg");
        fs::write(&file, jpeg).unwrap();
        let picture = Dataset::open(&file).unwrap();
        let side = picture.raster_size().0;
        let bands: Vec<Buffer<u8>> =
            (1..=3).map(|band| picture.rasterband(band).unwrap().read_band_as().unwrap()).collect();
        assert_eq!(corners.len(), places.len());
        for (at, place) in corners.iter().zip(places) {
            assert!(place.iter().all(|share| (0.0..=1.0).contains(share)));
            let (mut x, mut y) = ([east_m + at[0] * scale[0]], [north_m + at[1] * scale[1]]);
            to_degrees.transform_coords(&mut x, &mut y, &mut []).unwrap();
            let (lon, lat) = (x[0], y[0]);
            let (u, v) = (
                (lon - bounds[0]) / (bounds[2] - bounds[0]),
                (lat - bounds[1]) / (bounds[3] - bounds[1]),
            );
            // Well inside the photo.
            if !(0.23..0.67).contains(&u) || !(0.27..0.76).contains(&v) {
                continue;
            }
            let [column, row] = place.map(|share| ((share * side as f32) as usize).min(side - 1));
            let expected = colour([lon, lat], bounds);
            compared += 1;
            let differs = (0..3)
                .any(|band| bands[band].data()[row * side + column].abs_diff(expected[band]) > 16);
            off += usize::from(differs);
        }
    }
    assert!(compared > 2000, "{compared}");
    assert!(off * 50 < compared, "{off} of {compared} have another colour");
    // A style without photos has none, and the same ground.
    let style = folder.path().join("plain.toml");
    let atlas = fs::read_to_string(root().join("config/styles/road-atlas.toml")).unwrap();
    fs::write(&style, format!("photo = 0\n{atlas}")).unwrap();
    let plain = export(&package, "p.glb", &["--style", text(&style), "--roads", "surfaces"]);
    assert!(read_pictures(&plain).is_empty());
    assert_eq!(read_glb(&plain).corners.len(), read_glb(&path).corners.len());
}
