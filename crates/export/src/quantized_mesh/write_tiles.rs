//! Writes a package as quantized-mesh terrain tiles into an empty folder.

use std::{
    collections::BTreeSet,
    fs,
    io::{self, Write as _},
    path::Path,
};

use corniche_geom::{TILE_CELLS, wgs84::radii_m};
use corniche_tileset::{FilePackage, LevelRecord, Manifest};
use corniche_tin::TriangulateError;
use corniche_work::{Observer, Stage, workers::make_all};
use flate2::{Compression, write::GzEncoder};
use spade::InsertionError;

use super::{
    available::{TileRectangle, blocks},
    comparison::{Comparison, Point, PointFrame},
    encode::encode,
    ground::{GroundReader, SharedGroundCache},
    layer::{LAYER, layer, metadata},
    mesh::{Mesh, MeshDeviation, SHARE_OF_SAMPLES, SHARE_OF_VERTICES, tin_of},
    quantized_mesh_request::{
        QuantizedMeshLevel, QuantizedMeshPlan, QuantizedMeshRequest, QuantizedMeshSummary,
    },
    raster::{HeightRaster, SourceLevel},
    tiling::{RasterNodes, TerrainTile, Tiling},
};
use crate::{
    error::{QuantizedMeshError, SelectionError},
    places::{FeatureCoordinates, Places},
};

/// The fewest and the most cells along a tile's sides. Detail between raster nodes is found at
/// vertices and edges of the package's triangles.
const CELLS: [i64; 2] = [16, 64];
/// The most cells of the package per cell of a tile, while tiles have few enough cells.
const PACKAGE_CELLS: f64 = 2.0;
/// If a tile covers this many of the package's tiles in a row, it is created alone, not
/// concurrently with others.
const WIDE_TILES: i64 = 4;
/// The fewest and the most parts of a cell on borders and where the ground ends.
const PARTS: [f64; 2] = [4.0, 32.0];

/// Writes a package as terrain tiles into an empty folder, as planned. After an error the content
/// of the folder is incomplete.
///
/// # Errors
/// When heights above the ellipsoid cannot be computed, the package has no ground or is corrupt, or
/// something cannot be written.
pub fn export_quantized_mesh(
    package: &FilePackage,
    (request, plan): (&QuantizedMeshRequest, QuantizedMeshPlan),
    folder: &Path,
    observer: &dyn Observer,
) -> Result<QuantizedMeshSummary, QuantizedMeshError> {
    let manifest = package.manifest();
    let (finest, candidates) = (plan.finest(), plan.candidates);
    let mut heights = Places::new(manifest, request.coordinates)?.heights;
    if request.coordinates == FeatureCoordinates::Wgs84 {
        heights = format!("{heights} (in the package: {})", manifest.vertical.datum);
    }
    let job = Job { package, kept: &SharedGroundCache::new(), request, finest };
    let make = |tiles: &[TerrainTile], available: Available<'_>| {
        job.write_all((tiles, available), folder, observer)
    };
    let total = with_ancestors(request.tiling, &candidates).len() as u64;
    observer.begin(Stage::ExportTiles, Some(total));
    // The tiles of the finest level determine which tiles have ground.
    let made = make(&in_curve_order(&candidates), None)?;
    if made.is_empty() {
        return Err(SelectionError::no_ground(package).into());
    }
    let finest_tiles: BTreeSet<TerrainTile> = made.iter().map(|(tile, _)| *tile).collect();
    let tiles = with_ancestors(request.tiling, &finest_tiles);
    let above = tiles.difference(&finest_tiles).copied().collect();
    let available = blocks(&tiles);
    let above = in_curve_order(&above);
    let done = candidates.len() as u64;
    observer.reached(Stage::ExportTiles, done, done + above.len() as u64);
    let coarser = make(&above, Some(&available))?;
    observer.end(Stage::ExportTiles);
    let mut levels: Vec<QuantizedMeshLevel> =
        (0..=finest).map(|level| job.empty_level(level)).collect();
    let mut deviations = vec![MeshDeviation::default(); levels.len()];
    for (tile, made) in made.iter().chain(&coarser) {
        let level = usize::from(tile.z);
        levels[level].tiles += 1;
        levels[level].triangles += made.triangles;
        levels[level].bytes += made.bytes;
        deviations[level].add(&made.deviation);
    }
    for (level, deviation) in levels.iter_mut().zip(&deviations) {
        level.places = deviation.places;
        level.deviation_m = deviation.largest_m;
        level.deviation_rms_m = (deviation.squares_m2 / deviation.places.max(1) as f64).sqrt();
    }
    let summary = QuantizedMeshSummary { levels, heights };
    let text = serde_json::to_vec_pretty(&layer(manifest, request, &available, &summary));
    fs::write(folder.join(LAYER), text.map_err(io::Error::from)?)?;
    Ok(summary)
}

/// Returns the tiles, all tiles above them, and the roots, which a viewer requests in any case.
pub(crate) fn with_ancestors(
    tiling: Tiling,
    tiles: &BTreeSet<TerrainTile>,
) -> BTreeSet<TerrainTile> {
    let mut all: BTreeSet<TerrainTile> = tiling.roots().collect();
    for tile in tiles {
        let mut next = Some(*tile);
        while let Some(tile) = next.filter(|tile| all.insert(*tile)) {
            next = tile.parent();
        }
    }
    all
}

/// Sorts the finest tiles first, and neighbours together, so that tiles of the package are read
/// seldom.
fn in_curve_order(tiles: &BTreeSet<TerrainTile>) -> Vec<TerrainTile> {
    let key = |tile: &TerrainTile| {
        let bits = (0..32).map(|bit| {
            u64::from(tile.x >> bit & 1) << (2 * bit)
                | u64::from(tile.y >> bit & 1) << (2 * bit + 1)
        });
        (u8::MAX - tile.z, bits.sum::<u64>())
    };
    let mut ordered: Vec<TerrainTile> = tiles.iter().copied().collect();
    ordered.sort_by_key(key);
    ordered
}

/// An encoded tile.
struct EncodedMesh {
    triangles: u64,
    /// The size of its file.
    bytes: u64,
    deviation: MeshDeviation,
}

/// The available tiles beneath tiles that are written even without ground; `None` if tiles without
/// ground are skipped.
type Available<'a> = Option<&'a [Vec<TileRectangle>]>;

struct Job<'a> {
    package: &'a FilePackage,
    kept: &'a SharedGroundCache,
    request: &'a QuantizedMeshRequest,
    /// The finest level.
    finest: u8,
}

/// Returns a file's bytes, compressed if requested.
fn packed(request: &QuantizedMeshRequest, bytes: Vec<u8>) -> io::Result<Vec<u8>> {
    if !request.gzip {
        return Ok(bytes);
    }
    let mut packed = GzEncoder::new(Vec::new(), Compression::default());
    packed.write_all(&bytes)?;
    packed.finish()
}

/// Returns the mean file size of some tiles of the finest level with ground, which are created for
/// this purpose; `None` if none of them has ground.
pub(crate) fn mean_bytes(
    package: &FilePackage,
    (request, finest): (&QuantizedMeshRequest, u8),
    tiles: &[TerrainTile],
) -> Result<Option<f64>, QuantizedMeshError> {
    let job = Job { package, kept: &SharedGroundCache::new(), request, finest };
    let ground = job.ground()?;
    let (mut files, mut bytes) = (0_u32, 0.0);
    for tile in tiles {
        if let Some((made, _)) = job.tile(*tile, &ground, None)? {
            files += 1;
            bytes += made.bytes as f64;
        }
    }
    Ok((files > 0).then(|| bytes / f64::from(files)))
}

impl<'a> Job<'a> {
    /// Creates tiles and writes each to its file; tiles without ground are skipped, unless they are
    /// requested.
    fn write_all(
        &self,
        (tiles, available): (&[TerrainTile], Available<'_>),
        folder: &Path,
        observer: &dyn Observer,
    ) -> Result<Vec<(TerrainTile, EncodedMesh)>, QuantizedMeshError> {
        let Self { package, request, .. } = self;
        let is_narrow = |tile: &TerrainTile| !is_wide(package.manifest(), request.tiling, tile.z);
        let (narrow, wide) = tiles.split_at(tiles.partition_point(is_narrow));
        let mut made = Vec::with_capacity(tiles.len());
        for (part, threads) in [(narrow, request.threads), (wide, 1)] {
            made.extend(make_all(
                (observer, Stage::ExportTiles),
                threads,
                part,
                || self.ground(),
                |ground, tile| {
                    let Some((made, file)) = self.tile(*tile, ground, available)? else {
                        return Ok(None);
                    };
                    let TerrainTile { z, x, y } = tile;
                    let column = folder.join(z.to_string()).join(x.to_string());
                    fs::create_dir_all(&column)?;
                    fs::write(column.join(format!("{y}.terrain")), file)?;
                    Ok(Some(made))
                },
            )?);
        }
        Ok(tiles.iter().zip(made).filter_map(|(tile, made)| Some((*tile, made?))).collect())
    }

    fn ground(&self) -> Result<GroundReader<'a>, QuantizedMeshError> {
        let places = Places::new(self.package.manifest(), self.request.coordinates)?;
        Ok(GroundReader::new(self.package, self.kept, places))
    }

    /// The error to which a level is meshed: the one that a viewer assumes. The finest level has
    /// the package's full detail if its raster is as fine, because nothing finer follows it.
    fn error_m(&self, level: u8) -> f64 {
        let (manifest, tiling) = (self.package.manifest(), self.request.tiling);
        let assumed_m = tiling.level_error_m(level);
        let of_package_m = manifest.levels.last().map_or(0.0, |finest| finest.geometric_error_m);
        let [side_m, cell_m] = side_and_cell_m(manifest, tiling, level);
        let has_all = level == self.finest && has_cells_of(side_m, cell_m);
        if has_all && of_package_m > 0.0 { assumed_m.min(of_package_m) } else { assumed_m }
    }

    fn tile(
        &self,
        tile: TerrainTile,
        ground: &GroundReader<'_>,
        available: Available<'_>,
    ) -> Result<Option<(EncodedMesh, Vec<u8>)>, QuantizedMeshError> {
        let tiling = self.request.tiling;
        let error_m = self.error_m(tile.z);
        let nodes = nodes(self.package.manifest(), tiling, tile.z);
        let raster = HeightRaster::sample(nodes, tile, ground)?;
        let level = self.sampled_level(error_m);
        let samples = raster.samples(level, ground)?;
        let frame = PointFrame::new(nodes.square_of(tile));
        let mut bends =
            ground.bends(nodes.corners_deg(tile), level.level, |place| frame.point(place))?;
        let is_empty = samples.is_empty() && !bends.points.iter().any(Point::is_in_tile);
        if available.is_none() && is_empty {
            return Ok(None);
        }
        let failed = |source| QuantizedMeshError::Triangulate { tile: tile.to_string(), source };
        let tin = tin_of(&raster, error_m).map_err(failed)?;
        let inserted = |source| failed(TriangulateError::Insert(source));
        let mut mesh = Mesh::new(&raster, &tin).map_err(inserted)?;
        for border in &samples.borders {
            mesh.refine_border(&raster, border, error_m).map_err(inserted)?;
        }
        bends.points.reserve_exact(samples.inside.len());
        bends.points.extend(samples.inside.iter().map(|sample| frame.point(sample.place)));
        let mut comparison = Comparison::new(frame, bends, &mesh);
        let limit_m = error_m * SHARE_OF_VERTICES;
        let at_steps = |uv: &[[f64; 2]]| raster.at_steps(uv, ground);
        follow(&mut comparison, &mut mesh, &raster, limit_m, inserted, at_steps)?;
        mesh.finish();
        comparison.update(&mesh);
        let on_borders = samples.borders.iter().flatten();
        let deviation = comparison.deviation(on_borders, limit_m, level.is_finest, at_steps)?;
        let mesh = mesh.to_tile();
        let metadata = metadata(self.request, available.unwrap_or_default(), tile);
        let bytes = encode(&mesh, metadata.as_deref(), tiling.has_horizon(tile));
        let file = packed(self.request, bytes)?;
        let triangles = mesh.triangles.len() as u64;
        Ok(Some((EncodedMesh { triangles, bytes: file.len() as u64, deviation }, file)))
    }

    /// Returns the coarsest level of the package whose ground is near enough to the finest to
    /// decide where tiles with this error need vertices.
    fn sampled_level(&self, error_m: f64) -> SourceLevel {
        let Manifest { levels, frame, .. } = self.package.manifest();
        let near = |level: &&LevelRecord| level.geometric_error_m <= error_m * SHARE_OF_SAMPLES;
        let level = levels.iter().find(near).map_or(frame.max_level(), |level| level.level);
        SourceLevel { level, is_finest: level == frame.max_level() }
    }

    fn empty_level(&self, level: u8) -> QuantizedMeshLevel {
        QuantizedMeshLevel {
            level,
            cells: nodes(self.package.manifest(), self.request.tiling, level).per_tile as u64,
            assumed_error_m: self.request.tiling.level_error_m(level),
            ..QuantizedMeshLevel::default()
        }
    }
}

/// Adds vertices to a mesh until it is within `limit_m` of the ground: the farthest place of each
/// triangle, repeatedly. `at_steps` returns the ground at the steps to which places are rounded.
fn follow(
    comparison: &mut Comparison,
    mesh: &mut Mesh,
    raster: &HeightRaster,
    limit_m: f64,
    inserted: impl Fn(InsertionError) -> QuantizedMeshError,
    at_steps: impl Fn(&[[f64; 2]]) -> Result<Vec<Option<[f64; 3]>>, QuantizedMeshError>,
) -> Result<(), QuantizedMeshError> {
    loop {
        // Points first: there are many, and only those of changed triangles are checked again.
        let points = comparison.far_points(limit_m);
        let far = if points.is_empty() { comparison.far_crossings(limit_m) } else { points };
        if far.is_empty() {
            return Ok(());
        }
        let uv: Vec<[f64; 2]> = far.iter().map(|far| far.uv).collect();
        let mut vertices = Vec::new();
        for (far, place) in far.iter().zip(at_steps(&uv)?) {
            if let Some(point) = far.point {
                comparison.round(point, place);
            }
            vertices.extend(place.and_then(|place| raster.vertex(place)));
        }
        let added = mesh.insert(vertices.into_iter()).map_err(&inserted)?;
        if added > 0 {
            comparison.update(mesh);
        }
    }
}

/// Whether a level's tiles cover so many of the package's that they are created one after the
/// other, to save memory.
pub(crate) fn is_wide(manifest: &Manifest, tiling: Tiling, level: u8) -> bool {
    let [side_m, cell_m] = side_and_cell_m(manifest, tiling, level);
    side_m > cell_m * (TILE_CELLS * WIDE_TILES) as f64
}

/// Whether the finest raster of tiles with this side has cells no longer than the package's.
pub(crate) fn has_cells_of(side_m: f64, cell_m: f64) -> bool {
    side_m <= cell_m * CELLS[1] as f64
}

/// Returns the length of a side of a level's tiles and that of the package's cells, in the middle
/// of the data.
pub(crate) fn side_and_cell_m(manifest: &Manifest, tiling: Tiling, level: u8) -> [f64; 2] {
    let [lon, lat] = manifest.coordinates.wgs84_from_working(manifest.data_bounds.center());
    let [parallel_m, meridian_m] = radii_m(lat);
    let row = tiling.row_of(level, lat);
    let [south, north] = [row, row + 1].map(|row| tiling.lat_deg(level, row));
    let column = tiling.column_of(level, lon);
    let [west, east] = [column, column + 1].map(|column| tiling.lon_deg(level, column));
    let side_m =
        ((north - south).to_radians() * meridian_m).max((east - west).to_radians() * parallel_m);
    let cell = manifest.frame.cell();
    let [scale_x, scale_y] = manifest.scale.center;
    [side_m, (cell.east_m / scale_x).min(cell.north_m / scale_y)]
}

/// Returns the raster of a level: cells no longer than some of the package's, while tiles have few
/// enough of them.
fn nodes(manifest: &Manifest, tiling: Tiling, level: u8) -> RasterNodes {
    let [side_m, cell_m] = side_and_cell_m(manifest, tiling, level);
    let [fewest, most] = CELLS;
    let mut per_tile = fewest;
    while per_tile < most && side_m / per_tile as f64 > PACKAGE_CELLS * cell_m {
        per_tile *= 2;
    }
    // With the detail of the package's ground.
    let [least, largest] = PARTS;
    let cells = (side_m / per_tile as f64 / cell_m).ceil().clamp(least, largest);
    RasterNodes { tiling, level, per_tile, parts: cells as i64 }
}
