//! A reader of terrain tiles, written from the description of the format:
//! <https://github.com/CesiumGS/quantized-mesh>.

use std::{collections::BTreeMap, f64::consts::PI, fs, io::Read as _, path::Path};

use flate2::read::GzDecoder;
use serde_json::Value;

/// The largest value of u and v.
pub(crate) const LAST: u16 = 32_767;

/// Level, column, and row from the south.
pub(crate) type Name = [u32; 3];

#[derive(Clone)]
pub(crate) struct Tile {
    /// The fields of the header: centre, lowest and highest height, sphere, horizon.
    pub(crate) center_m: [f64; 3],
    pub(crate) range_m: [f64; 2],
    pub(crate) sphere_m: ([f64; 3], f64),
    pub(crate) horizon: [f64; 3],
    pub(crate) uv: Vec<[u16; 2]>,
    /// Heights in steps of the range.
    pub(crate) steps: Vec<u16>,
    pub(crate) triangles: Vec<[usize; 3]>,
    /// Vertices on the west, south, east and north border.
    pub(crate) edges: [Vec<usize>; 4],
    pub(crate) normals: Vec<[f64; 3]>,
    pub(crate) metadata: Option<Value>,
    /// Bounds: west, south, east, north, degrees.
    pub(crate) bounds_deg: [f64; 4],
}

pub(crate) struct Terrain {
    pub(crate) layer: Value,
    pub(crate) tiles: BTreeMap<Name, Tile>,
}

struct Bytes<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Bytes<'_> {
    fn take<const N: usize>(&mut self) -> [u8; N] {
        let taken = self.bytes[self.at..][..N].try_into().unwrap();
        self.at += N;
        taken
    }

    fn double(&mut self) -> f64 {
        f64::from_le_bytes(self.take())
    }

    fn doubles(&mut self) -> [f64; 3] {
        [0; 3].map(|_| self.double())
    }

    fn long(&mut self) -> usize {
        u32::from_le_bytes(self.take()) as usize
    }

    fn short(&mut self) -> u16 {
        u16::from_le_bytes(self.take())
    }

    /// Reads values that are stored as zigzag-coded differences.
    fn differences(&mut self, count: usize) -> Vec<u16> {
        let mut value = 0_i32;
        let mut next = || {
            let coded = i32::from(self.short());
            value += (coded >> 1) ^ -(coded & 1);
            u16::try_from(value).unwrap()
        };
        (0..count).map(|_| next()).collect()
    }
}

impl Tile {
    fn read(bytes: &[u8], bounds_deg: [f64; 4]) -> Self {
        let mut from = Bytes { bytes, at: 0 };
        let center_m = from.doubles();
        let range_m = [0; 2].map(|_| f64::from(f32::from_le_bytes(from.take())));
        let sphere_m = (from.doubles(), from.double());
        let horizon = from.doubles();
        let count = from.long();
        let [u, v, steps] = [0; 3].map(|_| from.differences(count));
        let is_wide = count > 65_536;
        if is_wide {
            from.at = from.at.next_multiple_of(4);
        }
        let index = |from: &mut Bytes<'_>| {
            if is_wide { from.long() } else { usize::from(from.short()) }
        };
        let triangle_count = from.long();
        let mut highest = 0;
        let mut corner = || {
            let code = index(&mut from);
            let corner = highest - code;
            highest += usize::from(code == 0);
            corner
        };
        let triangles = (0..triangle_count).map(|_| [0; 3].map(|_| corner())).collect();
        let edges = [0; 4].map(|_| {
            let count = from.long();
            (0..count).map(|_| index(&mut from)).collect()
        });
        let (mut normals, mut metadata) = (Vec::new(), None);
        while from.at < bytes.len() {
            let [kind] = from.take();
            let length = from.long();
            let end = from.at + length;
            match kind {
                1 => normals = (0..count).map(|_| normal(from.take())).collect(),
                4 => {
                    let length = from.long();
                    assert_eq!(from.at + length, end);
                    metadata = Some(serde_json::from_slice(&bytes[from.at..end]).unwrap());
                    from.at = end;
                }
                other => panic!("extension {other}"),
            }
            assert_eq!(from.at, end);
        }
        assert_eq!(from.at, bytes.len());
        let uv = u.into_iter().zip(v).map(|(u, v)| [u, v]).collect();
        Self {
            center_m,
            range_m,
            sphere_m,
            horizon,
            uv,
            steps,
            triangles,
            edges,
            normals,
            metadata,
            bounds_deg,
        }
    }

    /// Longitude, latitude (degrees) and height of a vertex.
    pub(crate) fn place(&self, vertex: usize) -> [f64; 3] {
        let [west, south, east, north] = self.bounds_deg;
        let [u, v] = self.uv[vertex].map(|step| f64::from(step) / f64::from(LAST));
        let [low, high] = self.range_m;
        let height = low + (high - low) * f64::from(self.steps[vertex]) / f64::from(LAST);
        [west + (east - west) * u, south + (north - south) * v, height]
    }

    /// The geocentric position.
    pub(crate) fn at_m(&self, vertex: usize) -> [f64; 3] {
        geocentric(self.place(vertex))
    }

    /// The vertical at a vertex.
    pub(crate) fn up(&self, vertex: usize) -> [f64; 3] {
        let [lon, lat, _] = self.place(vertex);
        let [low, high] = [0.0, 1.0].map(|height| geocentric([lon, lat, height]));
        std::array::from_fn(|k| high[k] - low[k])
    }

    /// The step of heights, metres.
    pub(crate) fn step_m(&self) -> f64 {
        (self.range_m[1] - self.range_m[0]) / f64::from(LAST)
    }
}

/// A direction from its octahedron code, 8 bits per axis.
fn normal(coded: [u8; 2]) -> [f64; 3] {
    let [p, q] = coded.map(|axis| f64::from(axis) / 255.0 * 2.0 - 1.0);
    let z = 1.0 - p.abs() - q.abs();
    let fold = |one: f64, other: f64| (1.0 - other.abs()) * if one < 0.0 { -1.0 } else { 1.0 };
    let [x, y] = if z < 0.0 { [fold(p, q), fold(q, p)] } else { [p, q] };
    let length = (x * x + y * y + z * z).sqrt();
    [x, y, z].map(|axis| axis / length)
}

/// Geocentric coordinates on WGS84, from its defining constants.
pub(crate) fn geocentric([lon, lat, height]: [f64; 3]) -> [f64; 3] {
    let (a, f) = (6_378_137.0, 1.0 / 298.257_223_563);
    let e2 = f * (2.0 - f);
    let (lon, lat) = (f64::to_radians(lon), f64::to_radians(lat));
    let n = a / (1.0 - e2 * lat.sin() * lat.sin()).sqrt();
    [
        (n + height) * lat.cos() * lon.cos(),
        (n + height) * lat.cos() * lon.sin(),
        (n * (1.0 - e2) + height) * lat.sin(),
    ]
}

/// West, south, east and north of a tile.
pub(crate) fn bounds_deg([level, x, y]: Name, projection: &str) -> [f64; 4] {
    let rows = f64::from(1_u32 << level);
    let [x, y] = [x, y].map(f64::from);
    match projection {
        "EPSG:4326" => {
            let side = 180.0 / rows;
            [x * side - 180.0, y * side - 90.0, (x + 1.0) * side - 180.0, (y + 1.0) * side - 90.0]
        }
        "EPSG:3857" => {
            // The inverse of Mercator's formula: latitude = 2 atan(exp(y)) − 90°.
            let lat = |row: f64| {
                let northing = PI * (2.0 * row / rows - 1.0);
                (2.0 * northing.exp().atan() - PI / 2.0).to_degrees()
            };
            let side = 360.0 / rows;
            [x * side - 180.0, lat(y), (x + 1.0) * side - 180.0, lat(y + 1.0)]
        }
        other => panic!("{other}"),
    }
}

/// The numbers in the names of the files and folders in a folder, without their extensions.
fn numbers(folder: &Path) -> Vec<(u32, std::path::PathBuf)> {
    let entries = fs::read_dir(folder).unwrap().flatten().map(|entry| entry.path());
    let number = |path: &Path| path.file_stem()?.to_str()?.parse().ok();
    entries.filter_map(|path| Some((number(&path)?, path))).collect()
}

impl Terrain {
    pub(crate) fn read(folder: &Path) -> Self {
        let layer: Value =
            serde_json::from_slice(&fs::read(folder.join("layer.json")).unwrap()).unwrap();
        let projection = layer["projection"].as_str().unwrap();
        let mut tiles = BTreeMap::new();
        for (level, folder) in numbers(folder) {
            for (x, folder) in numbers(&folder) {
                for (y, path) in numbers(&folder) {
                    let mut bytes = fs::read(path).unwrap();
                    if bytes.starts_with(&[0x1f, 0x8b]) {
                        let packed = std::mem::take(&mut bytes);
                        GzDecoder::new(&packed[..]).read_to_end(&mut bytes).unwrap();
                    }
                    let name = [level, x, y];
                    tiles.insert(name, Tile::read(&bytes, bounds_deg(name, projection)));
                }
            }
        }
        Self { layer, tiles }
    }

    pub(crate) fn levels(&self) -> u32 {
        self.tiles.keys().map(|[level, ..]| level + 1).max().unwrap()
    }
}
