//! A whole tileset, read from its documents.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
    rc::Rc,
};

use e2e::ground::{FromEarth, Ground, Region, shares};
use gdal::{Dataset, raster::Buffer};
use serde_json::Value;

use super::glb::Glb;

/// A list of triangles with its name.
#[derive(Clone)]
pub(crate) struct NamedTriangles {
    pub(crate) name: String,
    /// Positions in the root frame, metres.
    pub(crate) at_m: Vec<[f64; 3]>,
    pub(crate) triangles: Vec<[usize; 3]>,
    /// Ways of the vertices; empty for the ground.
    pub(crate) ways: Vec<i64>,
}

#[derive(Clone)]
pub(crate) struct Tile {
    pub(crate) name: String,
    pub(crate) parts: Vec<NamedTriangles>,
    pub(crate) ground: Rc<Ground>,
    pub(crate) error_m: f64,
    bounding_box: Vec<f64>,
    above: Option<String>,
}

#[derive(Clone)]
pub(crate) struct Tiles {
    pub(crate) tiles: Vec<Tile>,
    /// The matrix, by columns.
    pub(crate) to_earth: [f64; 16],
}

/// All files in a folder and its subfolders, by their relative names.
pub(crate) fn files_of(folder: &Path) -> BTreeMap<String, PathBuf> {
    let mut found = BTreeMap::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_str().unwrap().to_owned();
                found.insert(name, path);
            }
        }
    }
    found
}

/// Whether a file's name has this extension.
pub(crate) fn has_ending(name: &str, ending: &str) -> bool {
    Path::new(name).extension().is_some_and(|own| own == ending)
}

impl Tiles {
    pub(crate) fn read(folder: &Path, package: &Path) -> Self {
        let document: Value =
            serde_json::from_slice(&fs::read(folder.join("tileset.json")).unwrap()).unwrap();
        assert_eq!(document["asset"]["version"], "1.1");
        let root = &document["root"];
        let to_earth: Vec<f64> =
            root["transform"].as_array().unwrap().iter().map(|n| n.as_f64().unwrap()).collect();
        let mut tiles = Self { tiles: Vec::new(), to_earth: to_earth.try_into().unwrap() };
        tiles.add(root, folder, package, None);
        // Every tile file is listed.
        let stored = files_of(folder).into_keys().filter(|name| has_ending(name, "glb")).count();
        assert_eq!(stored, tiles.tiles.len());
        tiles
    }

    fn add(&mut self, tile: &Value, folder: &Path, package: &Path, above: Option<&str>) {
        let uri = tile["content"]["uri"].as_str().unwrap();
        let path = folder.join(uri);
        if has_ending(uri, "json") {
            let document: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
            for same in ["boundingVolume", "geometricError"] {
                assert_eq!(document["root"][same], tile[same]);
            }
            return self.add(&document["root"], path.parent().unwrap(), package, above);
        }
        let properties = &tile["metadata"]["properties"];
        let name = properties["tile"].as_str().unwrap().to_owned();
        let glb = Glb::read(&path);
        let ways = glb.ways();
        let texts = if ways.is_empty() { Vec::new() } else { glb.texts("name") };
        assert_eq!(texts.len(), ways.len());
        let parts = glb
            .primitives
            .iter()
            .map(|primitive| NamedTriangles {
                name: primitive.name.clone(),
                at_m: primitive.at_m.clone(),
                triangles: primitive
                    .indices
                    .as_chunks::<3>()
                    .0
                    .iter()
                    .map(|corners| corners.map(|k| k as usize))
                    .collect(),
                ways: primitive.features.iter().map(|row| ways[*row as usize]).collect(),
            })
            .collect();
        for primitive in &glb.primitives {
            assert!(primitive.normals.iter().all(|normal| {
                let length: f32 = normal.iter().map(|axis| axis * axis).sum();
                // Normals point upwards, except on the sides of bridges, and have length one.
                (length - 1.0).abs() < 1e-5 && (normal[1] > 0.0 || primitive.name == "bridge_slab")
            }));
        }
        let error_m = tile["geometricError"].as_f64().unwrap();
        assert!(error_m > properties["error_bound_m"].as_f64().unwrap());
        self.tiles.push(Tile {
            ground: Rc::new(Ground::read(package, &name)),
            parts,
            error_m,
            bounding_box: tile["boundingVolume"]["box"]
                .as_array()
                .unwrap()
                .iter()
                .map(|n| n.as_f64().unwrap())
                .collect(),
            above: above.map(str::to_owned),
            name: name.clone(),
        });
        for child in tile["children"].as_array().unwrap_or(&Vec::new()) {
            self.add(child, folder, package, Some(&name));
        }
    }

    pub(crate) fn levels(&self) -> impl Iterator<Item = u64> {
        let level = |tile: &Tile| tile.name.split('/').next().unwrap().parse().unwrap();
        self.tiles.iter().map(level).collect::<BTreeSet<u64>>().into_iter()
    }

    pub(crate) fn part_names(&self) -> BTreeSet<String> {
        self.tiles.iter().flat_map(|tile| &tile.parts).map(|part| part.name.clone()).collect()
    }

    pub(crate) fn on_earth(&self, at: [f64; 3]) -> [f64; 3] {
        let m = &self.to_earth;
        [0, 1, 2].map(|row| m[row] * at[0] + m[4 + row] * at[1] + m[8 + row] * at[2] + m[12 + row])
    }

    pub(crate) fn for_each_vertex(&mut self, mut change: impl FnMut(usize, &mut [f64; 3])) {
        for part in self.tiles.iter_mut().flat_map(|tile| &mut tile.parts) {
            for (number, at) in part.at_m.iter_mut().enumerate() {
                change(number, at);
            }
        }
    }

    pub(crate) fn halve_errors(&mut self) {
        for tile in &mut self.tiles {
            tile.error_m /= 2.0;
        }
    }

    /// Places each tile on the earth with one matrix, as if a square of the CRS were a square of
    /// the earth.
    pub(crate) fn by_one_matrix_a_tile(&mut self, region: &Region) {
        let from_earth = FromEarth::to(region);
        let tiles = std::mem::take(&mut self.tiles);
        for mut tile in tiles {
            for part in &mut tile.parts {
                let on_earth: Vec<[f64; 3]> =
                    part.at_m.iter().map(|at| self.on_earth(*at)).collect();
                let in_crs = from_earth.carry(&on_earth);
                let ([x0, y0, z0], at0) = (in_crs[0], part.at_m[0]);
                for (at, [x, y, z]) in part.at_m.iter_mut().zip(in_crs) {
                    *at = [at0[0] + x - x0, at0[1] + y - y0, at0[2] + z - z0];
                }
            }
            self.tiles.push(tile);
        }
    }

    /// Draws the package's own triangles, as if their edges were straight on the earth.
    pub(crate) fn undivide(&mut self, region: &Region) {
        let from_earth = FromEarth::to(region);
        let tiles = std::mem::take(&mut self.tiles);
        for mut tile in tiles {
            let at_m: Vec<[f64; 3]> = tile
                .parts
                .iter()
                .filter(|part| part.name != "skirt")
                .flat_map(|part| part.at_m.clone())
                .collect();
            let on_earth: Vec<[f64; 3]> = at_m.iter().map(|at| self.on_earth(*at)).collect();
            let in_crs = from_earth.carry(&on_earth);
            let vertex_at = |corner: &[f64; 3]| {
                let far = |at: &[f64; 3]| (at[0] - corner[0]).hypot(at[1] - corner[1]);
                let nearest = (0..in_crs.len())
                    .min_by(|one, other| far(&in_crs[*one]).total_cmp(&far(&in_crs[*other])));
                let nearest = nearest.unwrap();
                assert!(far(&in_crs[nearest]) < 0.01, "a corner of the package is no vertex");
                at_m[nearest]
            };
            tile.parts = vec![NamedTriangles {
                name: "terrain".to_owned(),
                at_m: tile.ground.corners.iter().map(vertex_at).collect(),
                triangles: tile.ground.triangles.clone(),
                ways: Vec::new(),
            }];
            self.tiles.push(tile);
        }
    }

    /// The longest edge of the ground.
    pub(crate) fn longest_edge_m(&self) -> f64 {
        let mut longest: f64 = 0.0;
        for part in self.tiles.iter().flat_map(|tile| &tile.parts) {
            if part.name == "skirt" {
                continue;
            }
            for corners in &part.triangles {
                for k in 0..3 {
                    let [a, b] = [corners[k], corners[(k + 1) % 3]].map(|at| part.at_m[at]);
                    longest = longest.max((a[0] - b[0]).hypot(a[1] - b[1]));
                }
            }
        }
        longest
    }

    /// Boxes contain the vertices of their tiles and of all descendants; errors never grow
    /// downwards.
    pub(crate) fn check_tree(&self) -> Result<(), String> {
        let by_name: BTreeMap<&str, &Tile> =
            self.tiles.iter().map(|tile| (tile.name.as_str(), tile)).collect();
        for tile in &self.tiles {
            let mut holder = Some(tile);
            while let Some(outer) = holder {
                if outer.error_m < tile.error_m {
                    return Err(format!("{} has a smaller error than {}", outer.name, tile.name));
                }
                let all = tile.parts.iter().flat_map(|part| &part.at_m);
                if let Some(at) = all.clone().find(|at| !outer.holds(**at)) {
                    return Err(format!("{at:?} of {} is outside of {}", tile.name, outer.name));
                }
                holder = outer.above.as_ref().map(|name| by_name[name.as_str()]);
            }
        }
        Ok(())
    }

    /// No node of the elevation model is farther from a tile's ground than its error.
    pub(crate) fn check_against_dem(&self, region: &Region) -> Result<(), String> {
        let from_earth = FromEarth::to(region);
        let dem = Dataset::open(&region.dem).unwrap();
        let [east_m, north_m] = region.metres_per_unit;
        let [west, dx, _, north, _, dy] = dem.geo_transform().unwrap();
        let ([west, dx], [north, dy]) =
            ([west, dx].map(|x| x * east_m), [north, dy].map(|y| y * north_m));
        let (columns, rows) = dem.raster_size();
        let band = dem.rasterband(1).unwrap();
        let no_data = band.no_data_value().map(|value| value as f32);
        let heights: Buffer<f32> = band.read_band_as().unwrap();
        for tile in &self.tiles {
            let mut largest: f64 = 0.0;
            for part in tile.parts.iter().filter(|part| part.name != "skirt") {
                let on_earth: Vec<_> = part.at_m.iter().map(|at| self.on_earth(*at)).collect();
                let in_crs = from_earth.carry(&on_earth);
                for corners in &part.triangles {
                    let corners = corners.map(|k| in_crs[k]);
                    let plan = corners.map(|[x, y, _]| [x, y]);
                    // Samples are at the centre of the file's cells.
                    let at = plan.map(|[x, y]| [(x - west) / dx - 0.5, (y - north) / dy - 0.5]);
                    let range = |axis: usize, limit: usize| {
                        let low = at.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
                        let high = at.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
                        (low.ceil().max(0.0) as usize)
                            ..((high.floor() + 1.0).max(0.0) as usize).min(limit)
                    };
                    for row in range(1, rows) {
                        for column in range(0, columns) {
                            let height = heights.data()[row * columns + column];
                            let shares = shares(at, [column as f64, row as f64]);
                            if Some(height) == no_data || shares.iter().any(|share| *share < 0.0) {
                                continue;
                            }
                            let own: f64 = (0..3).map(|k| shares[k] * corners[k][2]).sum();
                            largest = largest.max((own - f64::from(height)).abs());
                        }
                    }
                }
            }
            if largest > tile.error_m {
                return Err(format!("{}: {largest} m, not {}", tile.name, tile.error_m));
            }
        }
        Ok(())
    }
}

impl Tile {
    fn holds(&self, at: [f64; 3]) -> bool {
        let b = &self.bounding_box;
        let from = [0, 1, 2].map(|k| at[k] - b[k]);
        (1..4).all(|axis| {
            let half = &b[3 * axis..3 * axis + 3];
            let along: f64 = (0..3).map(|k| from[k] * half[k]).sum();
            let length_2: f64 = half.iter().map(|part| part * part).sum();
            along.abs() <= length_2
        })
    }
}
