//! Common helpers of this crate's tests: rasters with known heights, packages built from them by
//! the real pipeline and taken apart, and simple arithmetic on the results.

#![allow(clippy::unwrap_used, reason = "helpers of tests may unwrap")]

pub(crate) mod agreement;
pub(crate) mod extract;
pub(crate) mod layers;
pub(crate) mod parts;
pub(crate) mod rays;
pub(crate) mod seen;
pub(crate) mod terrain;

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use corniche_dem::PlanOptions;
use corniche_geom::{GridFrame, NodeIndex, TileId};
use corniche_pipeline::{BuildError, build};
use corniche_roads::{ClassFilter, FrcTable};
use corniche_spec::{
    BuildSettings, Leftovers, PhotoChoice, PlanSettings, Resources, RoadSettings, TerrainSettings,
};
use corniche_store::Existing;
use corniche_tileset::{FilePackage, Manifest, ReliefLevels, Sections, TilePayload, TileTerrain};
use corniche_tin::Tin;
use corniche_work::Silent;

/// Spacing of the tests' rasters.
pub(crate) const CELL_M: f64 = 10.0;
/// Cells on a side of a tile.
pub(crate) const TILE: i64 = 256;
/// UTM 32 N: the rasters' CRS.
pub(crate) const EPSG: u32 = 32632;

/// A raster of heights whose sample (column, row) is the global node (`west` + column, `north` −
/// row).
pub(crate) struct Raster {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    /// Global index of the first column.
    pub(crate) west: i64,
    /// Global index of the first row.
    pub(crate) north: i64,
    /// Row by row from the north, NaN where there is no data.
    pub(crate) heights_m: Vec<f32>,
    /// Spacing east and north.
    pub(crate) cell_m: [f64; 2],
}

impl Raster {
    /// A raster whose north-west sample is `shift` cells east and south of a corner of tiles.
    pub(crate) fn new(
        [columns, rows]: [usize; 2],
        shift: [i64; 2],
        height_m: impl Fn(i64, i64) -> f32,
    ) -> Self {
        // The position is in the middle of the zone and of Europe.
        let (west, north) = (200 * TILE + shift[0], 2080 * TILE - shift[1]);
        let heights_m = (0..rows as i64)
            .flat_map(|row| (0..columns as i64).map(move |column| (column, row)))
            .map(|(column, row)| height_m(column, row))
            .collect();
        Self { columns, rows, west, north, heights_m, cell_m: [CELL_M; 2] }
    }

    /// The same samples with other cells, east and north.
    pub(crate) fn with_cells(self, cell_m: [f64; 2]) -> Self {
        Self { cell_m, ..self }
    }

    /// x and y of a (column, row) in the raster's CRS, fractions allowed.
    pub(crate) fn position_m(&self, [column, row]: [f64; 2]) -> [f64; 2] {
        let (i, j) = (self.west as f64 + column, self.north as f64 - row);
        [i * self.cell_m[0], j * self.cell_m[1]]
    }

    /// The height of a global node, `None` in voids and outside.
    pub(crate) fn height_m(&self, node: NodeIndex) -> Option<f32> {
        let (column, row) = (node.i - self.west, self.north - node.j);
        let inside =
            (0..self.columns as i64).contains(&column) && (0..self.rows as i64).contains(&row);
        let height_m =
            inside.then(|| self.heights_m[row as usize * self.columns + column as usize])?;
        (!height_m.is_nan()).then_some(height_m)
    }

    /// Writes a GeoTIFF.
    pub(crate) fn write(&self, path: &Path) {
        let values = self.heights_m.iter().map(|h| if h.is_nan() { -9999.0 } else { *h }).collect();
        let first = self.position_m([0.0; 2]);
        write_samples(path, [self.columns, self.rows], (EPSG, first, self.cell_m), values);
    }
}

/// Writes a GeoTIFF of `side` × `side` samples in WGS84, the first at `north_west`, heights by
/// longitude and latitude.
pub(crate) fn write_degrees(
    path: &Path,
    side: usize,
    north_west: [f64; 2],
    step_deg: f64,
    height_m: impl Fn([f64; 2]) -> f64,
) {
    let at = |row: usize, column: usize| {
        [north_west[0] + column as f64 * step_deg, north_west[1] - row as f64 * step_deg]
    };
    let values = (0..side * side).map(|k| height_m(at(k / side, k % side)) as f32).collect();
    write_samples(path, [side, side], (4326, north_west, [step_deg; 2]), values);
}

/// Writes samples of a grid: EPSG code, position of the first sample, spacing. −9999 is nodata.
pub(crate) fn write_samples(
    path: &Path,
    size: [usize; 2],
    (epsg, first, [east, north]): (u32, [f64; 2], [f64; 2]),
    values: Vec<f32>,
) {
    // Pixels are areas: a sample is the centre of its pixel.
    let [x, y] = [first[0] - east / 2.0, first[1] + north / 2.0];
    let raster = corniche_testing::Raster::new(epsg, size, [x, east, 0.0, y, 0.0, -north]);
    raster.nodata(-9999.0).write_values(path, values);
}

/// The options of a build.
#[derive(Clone, Copy)]
pub(crate) struct Options {
    /// Working CRS, if it is not the raster's own.
    pub(crate) crs: Option<&'static str>,
    pub(crate) cell_m: Option<f64>,
    pub(crate) max_error_m: f64,
    pub(crate) fill_voids: u32,
    pub(crate) threads: usize,
    pub(crate) height_range_m: Option<[f64; 2]>,
}

impl Options {
    /// Options with the raster's own cell and without filled voids.
    pub(crate) fn plain(max_error_m: f64) -> Self {
        Self {
            crs: None,
            cell_m: None,
            max_error_m,
            fill_voids: 0,
            threads: 2,
            height_range_m: None,
        }
    }
}

/// A package and its content.
pub(crate) struct Built {
    pub(crate) bytes: Vec<u8>,
    pub(crate) manifest: Manifest,
    pub(crate) tiles: BTreeMap<TileId, TilePayload>,
}

/// The settings of a build; the only place where the tests of this crate list all of them.
pub(crate) fn settings(
    dem: PathBuf,
    osm: Option<PathBuf>,
    output: PathBuf,
    options: Options,
) -> BuildSettings {
    BuildSettings {
        plan: PlanSettings {
            dem: vec![dem],
            terrain_of: None,
            osm: osm.into_iter().collect(),
            terrain: TerrainSettings {
                plan: PlanOptions {
                    crs: options.crs.map(str::to_owned),
                    cell: options.cell_m.map(corniche_geom::Cell::from),
                    fill_voids: options.fill_voids,
                    ..PlanOptions::default()
                },
                height_range_m: options.height_range_m,
                max_error_m: Some(options.max_error_m),
                relief: ReliefLevels::Full,
                ..TerrainSettings::default()
            },
            roads: RoadSettings {
                table: table(),
                filter: ClassFilter::usual(),
                simplify_cells: 0.25,
                spans: false,
            },
            photo: PhotoChoice::Off,
            layers: Vec::new(),
            attribution: Vec::new(),
            generator: "tests".to_owned(),
        },
        output,
        existing: Existing::Keep,
        tmp: None,
        leftovers: Leftovers::Discard,
        force: false,
        resources: Resources { threads: options.threads, memory_bytes: 512 << 20 },
    }
}

/// The FRC table of all tests.
pub(crate) fn table() -> FrcTable {
    let classes = [
        ("motorway", 0),
        ("trunk", 1),
        ("primary", 2),
        ("secondary", 3),
        ("tertiary", 4),
        ("unclassified", 5),
        ("residential", 6),
        ("living_street", 6),
        ("service", 7),
        ("track", 7),
    ];
    let classes = classes.map(|(value, class)| (value.to_owned(), class)).to_vec();
    FrcTable::new("test", classes, vec![], 7).unwrap().with_recorded_labels()
}

/// Builds a package from files.
pub(crate) fn build_files(
    dem: &Path,
    osm: Option<&Path>,
    options: Options,
) -> Result<Built, BuildError> {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("built.pmtiles");
    let osm = osm.map(Path::to_path_buf);
    build(&settings(dem.to_path_buf(), osm, output.clone(), options), &Silent)?;
    let package = FilePackage::open(&output).unwrap();
    let payload = |id| package.payload(id, Sections::ALL).unwrap().unwrap();
    let tiles = package.tile_ids().unwrap().into_iter().map(|id| (id, payload(id))).collect();
    Ok(Built { bytes: fs::read(&output).unwrap(), manifest: package.manifest().clone(), tiles })
}

/// Builds terrain from a raster.
pub(crate) fn build_raster(raster: &Raster, options: Options) -> Result<Built, BuildError> {
    let folder = tempfile::tempdir().unwrap();
    let dem = folder.path().join("dem.tif");
    raster.write(&dem);
    build_files(&dem, None, options)
}

impl Built {
    pub(crate) fn frame(&self) -> &GridFrame {
        &self.manifest.frame
    }

    pub(crate) fn quantum_m(&self) -> f64 {
        self.manifest.vertical.quantum_m
    }

    /// The tiles with ground, by id.
    pub(crate) fn grounds(&self) -> impl DoubleEndedIterator<Item = (TileId, &TileTerrain)> {
        self.tiles.iter().filter_map(|(&id, tile)| Some((id, tile.terrain.as_ref()?)))
    }

    pub(crate) fn ground(&self, id: TileId) -> Option<&TileTerrain> {
        self.tiles.get(&id)?.terrain.as_ref()
    }

    /// The global node under each vertex of a tile's TIN.
    pub(crate) fn nodes(&self, id: TileId, tin: &Tin) -> Vec<NodeIndex> {
        let (corner, stride) = (self.frame().tile_corner(id), self.frame().stride(id.z()));
        let node = |column: u16, row: u16| NodeIndex {
            i: corner.i + i64::from(column) * stride,
            j: corner.j - i64::from(row) * stride,
        };
        tin.vertices().iter().map(|vertex| node(vertex.column, vertex.row)).collect()
    }
}
