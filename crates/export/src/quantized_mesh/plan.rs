//! Plans an export of terrain tiles: levels, files and bytes, computed before anything is written.

use std::collections::BTreeSet;

use corniche_geom::{Bounds, Seam, TileId, wgs84::radii_m};
use corniche_tileset::{FilePackage, Manifest};

use super::{
    quantized_mesh_request::{MeshLevelPlan, QuantizedMeshPlan, QuantizedMeshRequest},
    tiling::{FINEST, TerrainTile, Tiling},
    write_tiles::{has_cells_of, is_wide, mean_bytes, side_and_cell_m, with_ancestors},
};
use crate::{bounds::DegreeBounds, error::QuantizedMeshError, plane::doubled_area, read};

/// The most tiles of the finest level. Some hundred bytes of memory are needed for each.
const MOST_TILES: u64 = 4_000_000;
/// The number of finest tiles that are created to estimate the size of files.
const TRIED_TILES: usize = 9;
/// Tiles above the finest ones contain more of the ground each: this many times the bytes.
const BYTES_ABOVE: f64 = 1.5;
/// The time for sampling the ground beneath all tiles of a level, as a share of the time of the
/// finest level.
const LEVEL_SHARE: f64 = 0.012;

impl QuantizedMeshPlan {
    /// Computes what a request will write. Nothing is written.
    ///
    /// # Errors
    /// When the package does not support the request, it is corrupt, or there would be more files
    /// than the request allows.
    pub fn new(
        package: &FilePackage,
        request: &QuantizedMeshRequest,
    ) -> Result<Self, QuantizedMeshError> {
        let manifest = package.manifest();
        within_grid(manifest, request.tiling)?;
        let finest = finest_level(manifest, request);
        let around = tiles_around_deg(package, request.bounds.as_ref())?;
        refuse_too_many(&around, request, finest)?;
        let candidates = candidates(&around, request, finest);
        let all = with_ancestors(request.tiling, &candidates);
        let of_level = |level: u8| all.iter().filter(|tile| tile.z == level).count() as u64;
        let tiles: Vec<u64> = (0..=finest).map(of_level).collect();
        let finest_tiles = candidates.len() as f64;
        let planned = |(level, &tiles): (u8, &u64)| {
            let effort = if level == finest {
                1.0
            } else {
                let one_by_one = is_wide(manifest, request.tiling, level);
                let threads = if one_by_one { request.threads as f64 } else { 1.0 };
                1.0 + threads * LEVEL_SHARE * finest_tiles / tiles.max(1) as f64
            };
            MeshLevelPlan { level, tiles, effort }
        };
        let levels: Vec<MeshLevelPlan> = (0..).zip(&tiles).map(planned).collect();
        // Evenly spread over all tiles, so that plains and mountains count.
        let step = candidates.len().div_ceil(TRIED_TILES).max(1);
        let tried: Vec<TerrainTile> =
            candidates.iter().skip(step / 2).step_by(step).copied().collect();
        let mean = mean_bytes(package, (request, finest), &tried)?.unwrap_or_default();
        // Only a part of a coarse tile is over the data.
        let covered = |level: u8, tiles: u64| {
            let cells = 4_f64.powi(i32::from(finest - level));
            (finest_tiles / (cells * tiles as f64)).min(1.0)
        };
        let above: f64 = (0..finest)
            .zip(&tiles)
            .map(|(level, &tiles)| tiles as f64 * covered(level, tiles))
            .sum();
        let bytes = (mean * (finest_tiles + BYTES_ABOVE * above)) as u64;
        Ok(Self { levels, bytes, candidates })
    }

    /// The finest level.
    #[must_use]
    pub fn finest(&self) -> u8 {
        self.levels.last().map_or(0, |level| level.level)
    }

    /// The most files that there can be, including layer.json.
    #[must_use]
    pub fn files(&self) -> u64 {
        1 + self.levels.iter().map(|level| level.tiles).sum::<u64>()
    }
}

/// Fails if the data extend beyond the grid's latitudes: a part would be missing.
fn within_grid(manifest: &Manifest, tiling: Tiling) -> Result<(), QuantizedMeshError> {
    let [south, north] = [0, 1].map(|row| tiling.lat_deg(0, row));
    let data = manifest.wgs84_bounds;
    let beyond = [data.min_y, data.max_y].into_iter().find(|lat| !(south..=north).contains(lat));
    beyond.map_or(Ok(()), |lat| Err(QuantizedMeshError::BeyondGrid { lat, north }))
}

/// Returns the requested level. The default is the first one whose error is at most the package's,
/// or whose cells are the package's: finer levels would contain nothing more.
fn finest_level(manifest: &Manifest, request: &QuantizedMeshRequest) -> u8 {
    let of_package = manifest.levels.last().map_or(0.0, |finest| finest.geometric_error_m);
    let is_fine_enough = |level: &u8| {
        let [side_m, cell_m] = side_and_cell_m(manifest, request.tiling, *level);
        request.tiling.level_error_m(*level) <= of_package || has_cells_of(side_m, cell_m)
    };
    let by_data = || (0..=FINEST).find(is_fine_enough).unwrap_or(FINEST);
    request.max_level.unwrap_or_else(by_data).min(FINEST)
}

/// Returns rectangles of degrees around the package's finest tiles, from its coordinate table. They
/// must agree with the manifest's rectangle: otherwise the table could spread a small package over
/// the globe.
fn tiles_around_deg(
    package: &FilePackage,
    bounds: Option<&DegreeBounds>,
) -> Result<Vec<Bounds>, QuantizedMeshError> {
    let manifest = package.manifest();
    let data = manifest.wgs84_bounds;
    // The rectangle around a rotated or bent image is larger than the image, but never by this
    // much.
    let room = 0.1 + data.width().max(data.height());
    let seam = Seam::of_degrees().around(data.center()[0]);
    let is_all_around = data.width() + 2.0 * room >= 360.0;
    let is_near = |[lon, lat]: [f64; 2]| {
        let is_along = (seam.image(lon) - data.center()[0]).abs() <= data.width() / 2.0 + room;
        (is_all_around || is_along) && lat >= data.min_y - room && lat <= data.max_y + room
    };
    let mut found = Vec::new();
    for id in read::tiles(package, manifest.frame.max_level(), bounds)? {
        let places = read::places_deg(manifest, id);
        if !(places.iter().copied().all(is_near) && is_as_large(manifest, id, &places)) {
            return Err(QuantizedMeshError::OtherCoordinates {
                package: package.path().to_path_buf(),
            });
        }
        let around = Bounds::around(&places);
        found.push(around.expanded([0.01 * around.width().max(around.height()); 2]));
    }
    Ok(found)
}

/// Whether each part of a tile has about the same area by the coordinate table as by the manifest's
/// scale. A table that contains a single place fails, and so does one that is mirrored or
/// stretched: the search for the ground at a place would then grow with the table rather than with
/// the package.
fn is_as_large(manifest: &Manifest, id: TileId, places: &[[f64; 2]]) -> bool {
    /// The scale belongs to some places only, and parts count as flat.
    const AREA_TOLERANCE: f64 = 4.0;
    let (part, cell) = (read::data_part(manifest, id), manifest.frame.cell());
    if part.width() < cell.east_m || part.height() < cell.north_m {
        return true;
    }
    let side = places.len().isqrt();
    let parts = ((side - 1) * (side - 1)) as f64;
    let area_m2 = part.width() * part.height() / parts;
    let [least, largest] = [manifest.scale.least, manifest.scale.largest].map(|[x, y]| x * y);
    let allowed_m2 = area_m2 / largest / AREA_TOLERANCE..=area_m2 / least * AREA_TOLERANCE;
    let corners = (0..side - 1).flat_map(|row| (0..side - 1).map(move |at| row * side + at));
    corners.map(|at| [at, at + 1, at + side + 1, at + side].map(|corner| places[corner])).all(
        |[from, east, across, north]| {
            let [parallel_m, meridian_m] = radii_m(f64::midpoint(from[1], across[1]));
            let halves = [[from, east, across], [from, across, north]].map(doubled_area);
            let square_deg = f64::midpoint(halves[0], halves[1]);
            let scale = parallel_m.to_radians() * meridian_m.to_radians();
            allowed_m2.contains(&(square_deg * scale))
        },
    )
}

/// Returns the first and the last column and row of a level over a rectangle of degrees.
fn columns_and_rows(tiling: Tiling, level: u8, around: &Bounds) -> [[i64; 2]; 2] {
    let columns = [around.min_x, around.max_x].map(|lon| tiling.column_of(level, lon));
    let rows = [around.min_y, around.max_y].map(|lat| tiling.row_of(level, lat));
    [[columns[0], columns[1].min(columns[0] + tiling.columns(level) - 1)], rows]
}

/// Fails if there would be more files than allowed. Tiles on borders count more than once.
fn refuse_too_many(
    around: &[Bounds],
    request: &QuantizedMeshRequest,
    finest: u8,
) -> Result<(), QuantizedMeshError> {
    let of_level = |level: u8| -> u64 {
        let of_tile = |around: &Bounds| {
            let [columns, rows] = columns_and_rows(request.tiling, level, around);
            ((columns[1] - columns[0] + 1) * (rows[1] - rows[0] + 1)).unsigned_abs()
        };
        around.iter().map(of_tile).sum()
    };
    let until = |level: u8| (0..=level).map(of_level).sum::<u64>();
    // The exact number, if it is cheap to compute.
    let files = |level: u8| match until(level) {
        few if few <= request.max_files => few,
        some if of_level(level) <= MOST_TILES => {
            let tiles = candidates(around, request, level);
            some.min(with_ancestors(request.tiling, &tiles).len() as u64 + 1)
        }
        many => many,
    };
    let level = || (0..finest).rev().find(|&level| files(level) <= request.max_files).unwrap_or(0);
    if of_level(finest) > MOST_TILES {
        return Err(QuantizedMeshError::TooManyTiles { finest, most: MOST_TILES, level: level() });
    }
    let of_finest = files(finest);
    if of_finest <= request.max_files {
        return Ok(());
    }
    Err(QuantizedMeshError::TooManyFiles {
        finest,
        files: of_finest,
        most: request.max_files,
        level: level(),
    })
}

/// Returns the tiles that may have ground: those around the package's finest ones.
fn candidates(
    around: &[Bounds],
    request: &QuantizedMeshRequest,
    level: u8,
) -> BTreeSet<TerrainTile> {
    let tiling = request.tiling;
    let is_wanted = |x: i64, y: i64| {
        let corner =
            |beside| [tiling.lon_deg(level, x + beside), tiling.lat_deg(level, y + beside)];
        request.bounds.is_none_or(|bounds| bounds.overlaps([0, 1].map(corner)))
    };
    let mut found = BTreeSet::new();
    for around in around {
        let [columns, rows] = columns_and_rows(tiling, level, around);
        for x in (columns[0]..=columns[1]).map(|x| x.rem_euclid(tiling.columns(level))) {
            let wanted = (rows[0]..=rows[1]).filter(|&y| is_wanted(x, y));
            found.extend(wanted.map(|y| TerrainTile { z: level, x: x as u32, y: y as u32 }));
        }
    }
    found
}
