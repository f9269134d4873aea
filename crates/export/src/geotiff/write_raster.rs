//! Writes the heights of a level as a GeoTIFF, on request with their difference from the elevation
//! files.

use std::path::Path;

use corniche_geom::TILE_CELLS;
use corniche_tileset::{FilePackage, InputKind, Manifest, SampleErrorRecord, SampleSums};
use corniche_work::{Observer, Stage, workers::make_all};

use super::{
    block::{self, RasterBlock, Tins},
    file::{HEIGHTS, Pixel, RasterFacts, RasterFile},
    grid::{RasterGrid, RasterSize},
};
use crate::{
    bounds::DegreeBounds,
    error::{RasterError, SelectionError},
    heights::Elevation,
    places::{FeatureCoordinates, Places},
    read,
};

/// The number of blocks that are computed before any are written, rounded up to whole rows, at
/// least one. 16 MB per band in f32.
const BLOCKS_AT_ONCE: usize = 64;
/// A raster may have this many grid nodes, whatever the package contains: 256 MiB in f32 before
/// compression.
const FREE_NODES: u64 = 1 << 26;
/// A larger raster may have this many times the nodes of the tiles. Its rectangle comes from the
/// package, which may be wrong, and every block is written, with or without ground.
const MOST_NOTHING: u64 = 256;
/// The share of a height quantum that the type of pixels may lose.
const LOST_QUANTA: f64 = 0.1;

/// The part of a package that becomes a raster, and the files with which it is compared.
pub struct GeoTiffRequest<'a> {
    /// The level whose TINs are used; `None` means the finest.
    pub level: Option<u8>,
    /// The raster contains the grid nodes of this rectangle, rounded outwards.
    pub bounds: Option<DegreeBounds>,
    /// The files for the second band: heights of the TINs minus those of these files.
    pub elevation: Option<Elevation<'a>>,
    /// The number of blocks that are computed concurrently.
    pub threads: usize,
}

/// The figures of an export of a raster.
#[derive(Debug, Clone, PartialEq)]
pub struct GeoTiffSummary {
    /// The level whose TINs were used.
    pub level: u8,
    /// Nodes from west to east.
    pub columns: u64,
    /// Nodes from north to south.
    pub rows: u64,
    /// Grid nodes with ground.
    pub covered: u64,
    /// The type of pixels: "Float32", or "Float64" if the former would lose more than a tenth of
    /// the height quantum.
    pub pixels: &'static str,
    /// The stored error bound of the level's TINs, metres.
    pub error_bound_m: f64,
    /// The distance of the TINs from the samples of the elevation files, or from the nodes that
    /// were resampled from them; `None` without files.
    pub sample_error: Option<SampleErrorRecord>,
    /// What heights refer to, in words.
    pub heights: String,
    /// Whether the file has exactly the package's CRS: `GeoTIFF` cannot express every CRS.
    pub has_same_crs: bool,
}

/// Writes the heights of a level's TINs, and on request their difference from the elevation files,
/// to a new `GeoTIFF` at `path`. After an error that file is incomplete.
///
/// # Errors
/// When the package has no such level or no ground there, the package is corrupt, an elevation file
/// cannot be read, or something cannot be written.
pub fn export_geotiff(
    package: &FilePackage,
    request: &GeoTiffRequest<'_>,
    path: &Path,
    observer: &dyn Observer,
) -> Result<GeoTiffSummary, RasterError> {
    let manifest = package.manifest();
    let level = read::level(package, request.level)?;
    let grid = RasterGrid::covering(package, request.bounds.as_ref())?;
    let writing = Writing { package, level, request, grid, observer };
    writing.check_size()?;
    let places = Places::new(manifest, FeatureCoordinates::Package)?;
    let facts = writing.facts(&places);
    let mut summary = GeoTiffSummary {
        level,
        columns: grid.size.columns as u64,
        rows: grid.size.rows as u64,
        covered: 0,
        pixels: "Float32",
        error_bound_m: writing.bound_m(),
        sample_error: None,
        heights: places.heights,
        has_same_crs: false,
    };
    if fits_f32(manifest) {
        writing.write(path, &facts, &mut summary, |height_m| height_m as f32)?;
    } else {
        summary.pixels = "Float64";
        writing.write(path, &facts, &mut summary, |height_m| height_m)?;
    }
    Ok(summary)
}

/// Whether f32 preserves all heights of a package to a tenth of its quantum.
///
/// Rounding changes a height by at most half the step between neighbours in f32, and the step is
/// largest for the largest heights.
fn fits_f32(manifest: &Manifest) -> bool {
    let [low, high] = manifest.vertical.range_m;
    let farthest = low.abs().max(high.abs()) as f32;
    let step = f64::from(farthest.next_up()) - f64::from(farthest);
    step / 2.0 <= LOST_QUANTA * manifest.vertical.quantum_m
}

struct Writing<'a> {
    package: &'a FilePackage,
    level: u8,
    request: &'a GeoTiffRequest<'a>,
    grid: RasterGrid,
    observer: &'a dyn Observer,
}

impl Writing<'_> {
    /// Fails if nearly all of the raster would be empty, because the rectangle in the manifest may
    /// be wrong. Tiles of the finest level count, whichever level's TINs are used: they have ground
    /// wherever a coarse tile has, and a single coarse tile could claim to contain all nodes.
    fn check_size(&self) -> Result<(), RasterError> {
        let Self { package, request, grid, .. } = self;
        let RasterSize { columns, rows } = grid.size;
        let nodes = (columns as u64).saturating_mul(rows as u64);
        if nodes <= FREE_NODES {
            return Ok(());
        }
        let level = package.manifest().frame.max_level();
        let side = TILE_CELLS.unsigned_abs();
        let tiles = read::tiles(package, level, request.bounds.as_ref())?.len() as u64;
        let within = tiles.saturating_mul(side.saturating_mul(side));
        if nodes / MOST_NOTHING > within {
            return Err(RasterError::MostlyNothing { columns, rows, level, within });
        }
        Ok(())
    }

    /// The largest stored error of a level's tiles.
    fn bound_m(&self) -> f64 {
        let record = self.package.manifest().levels.get(usize::from(self.level));
        record.map_or(0.0, |record| record.geometric_error_m)
    }

    fn facts(&self, places: &Places<'_>) -> RasterFacts {
        let Self { package, level, request, grid, .. } = self;
        let manifest = package.manifest();
        let name = package.file_name().to_owned();
        let attribution = manifest.attribution.join("; ");
        let mut descriptions = vec!["height of the TIN, metres".to_owned()];
        let mut metadata = vec![
            ("TIFFTAG_IMAGEDESCRIPTION", format!("Heights of the TINs of level {level} of {name}")),
            ("TIFFTAG_SOFTWARE", manifest.generator.clone()),
            ("TIFFTAG_COPYRIGHT", attribution.clone()),
            ("ATTRIBUTION", attribution),
            ("PACKAGE", name),
            ("PACKAGE_SETTINGS_SHA256", manifest.settings_sha256.clone()),
            ("LEVEL", level.to_string()),
            ("ERROR_BOUND_M", self.bound_m().to_string()),
            ("HEIGHTS", places.heights.clone()),
            ("VERTICAL_DATUM_OF_PACKAGE", manifest.vertical.datum.clone()),
            ("NODES", manifest.resampling.clone()),
        ];
        if request.elevation.is_some() {
            descriptions.push("height of the TIN minus DEM, metres".to_owned());
            let names: Vec<&str> =
                manifest.inputs_of(InputKind::Dem).map(|input| input.name.as_str()).collect();
            metadata.push(("DEM", names.join("; ")));
        }
        RasterFacts {
            pixels: &HEIGHTS,
            crs: places.wkt.clone(),
            crs_from_pixel: grid.crs_from_pixel(manifest),
            descriptions,
            metadata,
        }
    }

    fn write<T: Pixel>(
        &self,
        path: &Path,
        facts: &RasterFacts,
        summary: &mut GeoTiffSummary,
        pixel: fn(f64) -> T,
    ) -> Result<(), RasterError> {
        let Self { package, level, request, grid, observer } = self;
        let mut file = RasterFile::<T>::create(path, grid.size, facts)?;
        let tins = Tins::new(package, *level);
        let mut sums = SampleSums::new(package.manifest().vertical.quantum_m);
        let [columns, rows] = grid.size.blocks();
        observer.begin(Stage::ExportBlocks, Some((columns * rows) as u64));
        let rows_at_once = BLOCKS_AT_ONCE.div_ceil(columns);
        for first in (0..rows).step_by(rows_at_once) {
            let places: Vec<[usize; 2]> = (first..rows.min(first + rows_at_once))
                .flat_map(|row| (0..columns).map(move |column| [column, row]))
                .collect();
            tins.forget_north_of(grid.window([0, first]).corner.j);
            let made: Vec<RasterBlock<T>> = make_all(
                (*observer, Stage::ExportBlocks),
                request.threads,
                &places,
                || Ok(request.elevation.map(|Elevation { dem, plan }| dem.reader(plan))),
                |reader, place| block::make(&tins, &grid.window(*place), reader.as_mut(), pixel),
            )?;
            for RasterBlock { heights_m, errors_m, covered: own, sums: own_sums } in made {
                file.push(0, heights_m)?;
                if request.elevation.is_some() {
                    file.push(1, errors_m)?;
                }
                summary.covered += own;
                sums.merge(&own_sums);
            }
        }
        if summary.covered == 0 {
            return Err(SelectionError::no_ground(package).into());
        }
        summary.has_same_crs = file.finish()?;
        summary.sample_error = request.elevation.is_some().then(|| sums.record());
        observer.end(Stage::ExportBlocks);
        Ok(())
    }
}
