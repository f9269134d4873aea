//! Reliefs as normal maps of the terrain.

use std::fs;

use e2e::{
    build_pass, corniche,
    photo::{build, inputs, photo},
    text,
};
use gdal::{Dataset, raster::Buffer};

use super::{
    export,
    readers::{Relief, read_pictures, read_reliefs},
};

/// Nodes of a tile, and texels, on a side.
const SIDE: usize = 257;

/// Vertices have the normals of the elevation model, so the map adds almost nothing there; between
/// them it adds the detail that triangles lack. Tangents are correct, with and without photos.
#[test]
fn reliefs_are_seen_from_the_vertices() {
    let folder = tempfile::tempdir().unwrap();
    let photo = photo(folder.path(), 0.2, "photo.tif");
    let [with, without] = ["photo.pmtiles", "bare.pmtiles"].map(|name| folder.path().join(name));
    let _ = build(&inputs(&[&photo]), &with, &["--relief", "finest"]);
    build_pass(&without, &["--relief", "finest", "--max-error", "10"]);
    for (package, name) in [(&with, "with.glb"), (&without, "without.glb")] {
        let model = export(package, name, &["--roads", "none"]);
        let reliefs = read_reliefs(&model);
        assert!(reliefs.len() > 4, "{}", reliefs.len());
        assert_eq!(read_pictures(&model).is_empty(), package == &without);
        let (mut at_vertices, mut everywhere) = (Vec::new(), Vec::new());
        for Relief { places, normals, tangents, png } in reliefs {
            let file = folder.path().join("relief.png");
            fs::write(&file, png).unwrap();
            let picture = Dataset::open(&file).unwrap();
            assert_eq!(picture.raster_size(), (SIDE, SIDE));
            let blue: Buffer<u8> = picture.rasterband(3).unwrap().read_band_as().unwrap();
            let tilt = |k: usize| {
                (f64::from(blue.data()[k]) / 255.0 * 2.0 - 1.0).clamp(-1.0, 1.0).acos().to_degrees()
            };
            everywhere.extend((0..SIDE * SIDE).map(tilt));
            for ((place, normal), tangent) in places.iter().zip(&normals).zip(&tangents) {
                let [column, row] = place.map(|share| share * SIDE as f32 - 0.5);
                // Vertices are nodes, and nodes are at the centre of texels.
                assert!([column, row].iter().all(|k| (k - k.round()).abs() < 1e-3), "{place:?}");
                at_vertices.push(tilt(row.round() as usize * SIDE + column.round() as usize));
                let [x, y, z, side] = *tangent;
                let dot = x * normal[0] + y * normal[1] + z * normal[2];
                let length = x * x + y * y + z * z;
                assert!(dot.abs() < 1e-5 && (length - 1.0).abs() < 1e-5 && x > 0.0, "{tangent:?}");
                assert!((side - 1.0).abs() < f32::EPSILON);
            }
        }
        let mean = |angles: &[f64]| angles.iter().sum::<f64>() / angles.len() as f64;
        let (at_vertices, everywhere) = (mean(&at_vertices), mean(&everywhere));
        println!("{name}: {at_vertices:.2}° at vertices, {everywhere:.2}° everywhere");
        assert!(at_vertices < 6.0 && everywhere > 1.7 * at_vertices, "{at_vertices} {everywhere}");
    }
    let plain = export(&without, "none.glb", &["--relief", "none"]);
    assert!(read_reliefs(&plain).is_empty());
}

/// Only GLB has normal maps: a request in another format is an error.
#[test]
fn a_relief_in_a_format_without_normal_maps_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    build_pass(&package, &["--relief", "finest", "--max-error", "20"]);
    for ending in ["ply", "obj"] {
        let model = folder.path().join(format!("model.{ending}"));
        let words = ["export", "mesh", text(&package), "-o", text(&model), "--relief", "on"];
        let ran = corniche(words);
        assert_eq!(ran.code, 2, "{}", ran.err);
        assert!(
            ran.err.contains(&format!(".{ending} does not support normal maps")),
            "{}",
            ran.err
        );
        assert!(!model.exists());
    }
}
