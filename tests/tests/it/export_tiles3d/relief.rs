//! Normal maps from the package's relief, shaded as by other programs.

use std::{collections::BTreeMap, fs, path::Path};

use e2e::ground::{FromEarth, Region, shares};
use gdal::{Dataset, raster::Buffer};
use tempfile::TempDir;

use super::{
    export,
    glb::{Glb, Primitive},
    pass,
    tiles::{Tiles, files_of, has_ending},
};

/// Only some texels are compared: one of this many columns and rows.
const EVERY: usize = 9;

/// A decoded normal map.
struct Map {
    side: usize,
    texels: Vec<[u8; 3]>,
}

impl Map {
    fn read(png: &[u8], folder: &Path) -> Self {
        let file = folder.join("relief.png");
        fs::write(&file, png).unwrap();
        let picture = Dataset::open(&file).unwrap();
        let side = picture.raster_size().0;
        let bands: Vec<Buffer<u8>> =
            (1..=3).map(|band| picture.rasterband(band).unwrap().read_band_as().unwrap()).collect();
        let texels = (0..side * side).map(|k| [0, 1, 2].map(|band| bands[band].data()[k]));
        Self { side, texels: texels.collect() }
    }

    /// A texel as a direction along tangent, bitangent and normal.
    fn direction(&self, [column, row]: [usize; 2]) -> [f64; 3] {
        self.texels[row * self.side + column].map(|byte| f64::from(byte) / 255.0 * 2.0 - 1.0)
    }
}

/// The slopes of the elevation model at its samples.
struct Slopes {
    heights: Buffer<f32>,
    size: (usize, usize),
    /// West, step, north, step.
    at: [f64; 4],
}

impl Slopes {
    fn read(region: &Region) -> Self {
        let dem = Dataset::open(&region.dem).unwrap();
        let [west, dx, _, north, _, dy] = dem.geo_transform().unwrap();
        let heights = dem.rasterband(1).unwrap().read_band_as().unwrap();
        Self { heights, size: dem.raster_size(), at: [west, dx, north, dy] }
    }

    /// The rise in metres per metre of the sample at a position; `None` between samples, on the
    /// border, and next to voids.
    fn at(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        let [west, dx, north, dy] = self.at;
        let place = [(x - west) / dx - 0.5, (y - north) / dy - 0.5];
        if place.iter().any(|axis| (axis - axis.round()).abs() > 0.01) {
            return None;
        }
        let [column, row] = place.map(|axis| axis.round() as i64);
        let height = |column: i64, row: i64| {
            let [column, row] = [usize::try_from(column).ok()?, usize::try_from(row).ok()?];
            let is_there = column < self.size.0 && row < self.size.1;
            let height = is_there.then(|| self.heights.data()[row * self.size.0 + column])?;
            (height > -1000.0).then_some(f64::from(height))
        };
        let rise = |one: Option<f64>, other: Option<f64>, step: f64| Some((other? - one?) / step);
        Some([
            rise(height(column - 1, row), height(column + 1, row), 2.0 * dx)?,
            rise(height(column, row - 1), height(column, row + 1), 2.0 * dy)?,
        ])
    }
}

fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = vector.iter().map(|axis| axis * axis).sum::<f64>().sqrt();
    vector.map(|axis| axis / length)
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn degrees_between(one: [f64; 3], other: [f64; 3]) -> f64 {
    let dot: f64 = one.iter().zip(other).map(|(a, b)| a * b).sum();
    dot.clamp(-1.0, 1.0).acos().to_degrees()
}

/// Converts a direction of glTF to the root frame.
fn z_up([x, y, z]: [f32; 3]) -> [f64; 3] {
    [x, -z, y].map(f64::from)
}

/// The values that are compared at a texel.
struct Sample {
    /// The position in the root frame.
    at_m: [f64; 3],
    /// Normals that a program shades with: by the vertices, with the map, and with its second axis
    /// reversed.
    by_vertices: [f64; 3],
    by_map: [f64; 3],
    turned: [f64; 3],
}

/// Interpolates normals and tangents across triangles as programs do, at texels whose centre is in
/// a triangle.
fn samples(primitive: &Primitive, map: &Map) -> Vec<Sample> {
    let mut found = Vec::new();
    let side = map.side as f64;
    for corners in primitive.indices.as_chunks::<3>().0 {
        let corners = corners.map(|k| k as usize);
        let at =
            corners.map(|k| primitive.relief_places[k].map(|place| f64::from(place) * side - 0.5));
        let range = |axis: usize| {
            let low = at.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
            let high = at.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
            (low.ceil().max(0.0) as usize)..((high.floor() + 1.0).min(side) as usize)
        };
        for row in range(1).filter(|row| row.is_multiple_of(EVERY)) {
            for column in range(0).filter(|column| column.is_multiple_of(EVERY)) {
                let shares = shares(at, [column as f64, row as f64]);
                if shares.iter().any(|share| *share < 0.0) {
                    continue;
                }
                let mixed = |of: &dyn Fn(usize) -> [f64; 3]| {
                    [0, 1, 2].map(|axis: usize| {
                        (0..3).map(|k| shares[k] * of(corners[k])[axis]).sum::<f64>()
                    })
                };
                let normal = unit(mixed(&|k| z_up(primitive.normals[k])));
                let along = unit(mixed(&|k| {
                    let [x, y, z, side] = primitive.tangents[k];
                    assert!((side - 1.0).abs() < f32::EPSILON);
                    z_up([x, y, z])
                }));
                let aside = cross(normal, along);
                let [x, y, z] = map.direction([column, row]);
                let shaded =
                    |y: f64| unit([0, 1, 2].map(|k| x * along[k] + y * aside[k] + z * normal[k]));
                found.push(Sample {
                    at_m: mixed(&|k| primitive.at_m[k]),
                    by_vertices: normal,
                    by_map: shaded(y),
                    turned: shaded(-y),
                });
            }
        }
    }
    found
}

/// Normals of the elevation model at samples, in the root frame; `None` where it has none.
fn expected(samples: &[Sample], tiles: &Tiles, region: &Region) -> Vec<Option<[f64; 3]>> {
    const STEP_M: f64 = 1.0;
    let slopes = Slopes::read(region);
    let beside = |at: [f64; 3]| {
        let moved = [0, 1, 2].map(|axis| {
            let mut moved = at;
            moved[axis] += STEP_M;
            moved
        });
        [at, moved[0], moved[1], moved[2]].map(|at| tiles.on_earth(at))
    };
    let on_earth: Vec<_> = samples.iter().flat_map(|sample| beside(sample.at_m)).collect();
    let in_crs = FromEarth::to(region).carry(&on_earth);
    let points = in_crs.as_chunks::<4>().0;
    points
        .iter()
        .map(|[at, moved @ ..]| {
            let [east, north] = slopes.at([at[0], at[1]])?;
            // The height above the tangent plane grows fastest along its normal.
            let above = |point: &[f64; 3]| point[2] - east * point[0] - north * point[1];
            Some(unit([0, 1, 2].map(|axis: usize| above(&moved[axis]) - above(at))))
        })
        .collect()
}

/// Shaded with its map, the ground has the slopes of the elevation model, which its vertices do not
/// have; and both sides of a border are equal.
#[test]
fn relief_is_that_of_the_elevation_model() {
    let folder = TempDir::new().unwrap();
    let package = folder.path().join("pass.pmtiles");
    let options = ["--dem-vertical-crs", "EPSG:5773", "--relief", "finest", "--max-error", "20"];
    e2e::build_pass(&package, &options);
    let exported = export(&package, "tiles", &["--roads", "none"]);
    let tiles = Tiles::read(&exported, &package);
    let [mut vertices, mut map, mut turned] = [const { Vec::new() }; 3];
    let mut borders: BTreeMap<[u64; 3], Vec<[u8; 3]>> = BTreeMap::new();
    for (_, path) in files_of(&exported).into_iter().filter(|(name, _)| has_ending(name, "glb")) {
        let glb = Glb::read(&path);
        let Some(png) = glb.relief() else {
            assert!(glb.primitives.iter().all(|part| part.tangents.is_empty()));
            continue;
        };
        let relief = Map::read(png, folder.path());
        assert_eq!(relief.side, 257);
        for primitive in &glb.primitives {
            assert_eq!(primitive.relief_places.len(), primitive.at_m.len());
            for (at, place) in primitive.at_m.iter().zip(&primitive.relief_places) {
                let [column, row] = place.map(|share| (share * 257.0) as usize);
                let is_on_border = [column, row].iter().any(|k| [0, 256].contains(k));
                if primitive.name == "terrain" && is_on_border {
                    let key = at.map(f64::to_bits);
                    borders.entry(key).or_default().push(relief.texels[row * 257 + column]);
                }
            }
        }
        let terrain = glb.primitives.iter().find(|part| part.name == "terrain").unwrap();
        let samples = samples(terrain, &relief);
        for (sample, normal) in samples.iter().zip(expected(&samples, &tiles, &pass())) {
            let Some(normal) = normal else { continue };
            vertices.push(degrees_between(sample.by_vertices, normal));
            map.push(degrees_between(sample.by_map, normal));
            turned.push(degrees_between(sample.turned, normal));
        }
    }
    let mean = |angles: &[f64]| angles.iter().sum::<f64>() / angles.len() as f64;
    let [by_vertices, by_map, by_turned] = [&vertices, &map, &turned].map(|angles| mean(angles));
    println!(
        "{} texels: {by_map:.2}° with the map, {by_vertices:.2}° by vertices, {by_turned:.2}° with an axis turned",
        map.len()
    );
    assert!(map.len() > 5000, "{}", map.len());
    assert!(by_map < 2.0 && by_map * 3.0 < by_vertices, "{by_map} {by_vertices}");
    assert!(by_turned > by_vertices, "{by_turned}");
    let shared: Vec<_> = borders.values().filter(|texels| texels.len() > 1).collect();
    assert!(shared.len() > 100, "{}", shared.len());
    for texels in shared {
        assert!(texels.iter().all(|texel| *texel == texels[0]), "{texels:?}");
    }
    // The same ground without a map.
    let none = export(&package, "none", &["--roads", "none", "--relief", "none"]);
    for (_, path) in files_of(&none).into_iter().filter(|(name, _)| has_ending(name, "glb")) {
        let glb = Glb::read(&path);
        assert!(glb.relief().is_none() && glb.document.get("textures").is_none());
    }
}
