//! Estimates of the memory, disk space and time of a build, before it starts.

use std::time::Duration;

use corniche_dem::Dem;
use corniche_geom::TILE_CELLS;
use corniche_gis::FileBlocks;
use corniche_ground::photos::source::PhotoSource;
use corniche_ground::terrain::ground::GroundSource;
use corniche_spec::{BuildObserver, Resources, machine::thread_time};
use corniche_tileset::{LevelRecord, Manifest, ReliefLevels};
use corniche_tin::TinSpec;
use serde::Serialize;

use super::{Opened, covered_tiles::CoveredTiles, rates};
use crate::PlanError;

/// The number of finest tiles from which some tiles are triangulated as samples of the ground. For
/// smaller builds, recorded rates are accurate enough.
const LEAST_TILES_TO_SAMPLE: u64 = 256;
/// The number of tiles that are triangulated as samples of the ground.
const SAMPLED_TILES: u64 = 12;
/// Files with larger blocks are not sampled, because each sample would take as long as reading a
/// large part of a file.
const MOST_SAMPLED_BLOCK_BYTES: u64 = 64 << 20;

/// The estimated size, memory and time of a build. All values but the counts are estimates.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BuildEstimate {
    /// Nodes of the finest level in the files' rectangles; nodes where files overlap count twice.
    pub nodes: u64,
    /// Tiles per level, root first, if no tile is void.
    pub tiles: Vec<u64>,
    /// Memory.
    pub memory: MemoryEstimate,
    /// Disk space for intermediate results, bytes.
    pub store_bytes: u64,
    /// Size of the package.
    pub package_bytes: u64,
    /// Time on one core.
    pub core_seconds: f64,
    /// Time on the build's number of threads.
    pub seconds: f64,
    /// The source of the estimated triangles, bytes and seconds.
    pub rates: Rates,
}

/// Memory that a build needs, bytes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct MemoryEstimate {
    /// Memory that every build needs.
    pub base_bytes: u64,
    /// Memory for the data kept about every tile.
    pub tiles_bytes: u64,
    /// Number of threads.
    pub threads: u64,
    /// Memory for the work of each thread.
    pub thread_bytes: u64,
    /// Memory for the largest block of a file, which GDAL decodes as a whole for each thread.
    pub block_bytes: u64,
    /// The file that contains this block.
    pub block_file: String,
    /// All blocks from the west to the east side of a file, the most of any file. If GDAL has less
    /// memory, the build takes longer, because blocks are read more than once.
    pub block_row_bytes: u64,
    /// The sum of the memory that every build of this data needs at least.
    pub least_bytes: u64,
}

/// The source of an estimate's rates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Rates {
    /// The rates come from builds of other data on another machine; see `docs/lab/build-costs.md`.
    Recorded,
    /// The rates come from tiles of this data, triangulated on this machine.
    Sampled {
        /// The number of tiles.
        tiles: u64,
    },
}

impl Rates {
    /// Describes the source of the rates in words.
    #[must_use]
    pub fn text(self) -> String {
        match self {
            Self::Recorded => {
                "from recorded rates, measured with other data on another machine (docs/lab/build-costs.md)"
                    .to_owned()
            }
            Self::Sampled { tiles } => {
                format!("from {tiles} tiles of this data, triangulated on this machine")
            }
        }
    }
}

/// The amount of ground on the finest level.
struct Ground {
    triangles_per_node: f64,
    /// Time of all steps for the ground of all levels, on one core.
    core_seconds: f64,
    rates: Rates,
}

/// The cost of the ground of all levels.
#[derive(Clone, Copy)]
struct GroundCosts {
    package_bytes: f64,
    /// Bytes of intermediate results that are not part of the package.
    store_bytes: f64,
    /// Time of all steps, on one core.
    core_seconds: f64,
    rates: Rates,
}

impl BuildEstimate {
    /// Estimates the build of `opened`. If there are many data, some of their tiles are read.
    ///
    /// # Errors
    /// See [`PlanError`].
    pub fn from_opened(
        opened: &Opened,
        resources: Resources,
        observer: &dyn BuildObserver,
    ) -> Result<Self, PlanError> {
        let extract_bytes = opened.extract_bytes()?;
        let dem = match &opened.source {
            GroundSource::Dem(dem) => dem,
            GroundSource::Package(terrain) => {
                let manifest = terrain.manifest();
                let tiles = manifest.levels.iter().map(|level| level.tiles).sum();
                let memory = MemoryEstimate::from_blocks(Vec::new(), opened, tiles, resources);
                let estimate = Self::of_recorded(manifest, memory, extract_bytes, opened.relief);
                return Ok(estimate.with_photos(opened));
            }
        };
        let rectangles = dem.file_nodes(&opened.grid)?;
        let finest = CoveredTiles::finest(&opened.grid.frame, &rectangles);
        let mut tiles = vec![finest.count()];
        let mut level = finest.parents();
        while let Some(found) = level {
            tiles.insert(0, found.count());
            level = found.parents();
        }
        let sides = rectangles.iter().map(|[south_west, north_east]| {
            let side = |low: i64, high: i64| (high - low + 1) as u64;
            side(south_west.i, north_east.i).saturating_mul(side(south_west.j, north_east.j))
        });
        let nodes = sides.fold(0, u64::saturating_add);
        let memory =
            MemoryEstimate::from_blocks(dem.file_blocks()?, opened, tiles.iter().sum(), resources);
        let is_sampled = finest.count() >= LEAST_TILES_TO_SAMPLE
            && memory.block_bytes <= MOST_SAMPLED_BLOCK_BYTES
            && memory.least_bytes <= resources.memory_bytes;
        let mut ground = if is_sampled {
            Ground::sampled(opened, dem, &finest, nodes, observer)?
        } else {
            Ground::recorded(nodes, opened.tolerance_cells())
        };
        if !opened.grid.nodes_are_samples() {
            ground.core_seconds += rates::SECONDS_PER_RESAMPLED_NODE * nodes as f64;
        }
        let costs = ground.costs(nodes, &tiles);
        let estimate = Self::put_together(nodes, tiles, memory, extract_bytes, costs);
        Ok(estimate.with_relief(opened.relief).with_photos(opened))
    }

    /// Adds photos to the estimate. Each finest tile that a photo may touch counts as covered.
    /// Photos of a package are as large as they are there.
    fn with_photos(mut self, opened: &Opened) -> Self {
        let photos = match &opened.photo {
            PhotoSource::Nothing => return self,
            PhotoSource::Files(photos) => photos,
            PhotoSource::Package(_) => {
                let recorded = opened.source.package().map(|package| &package.manifest().photos);
                let bytes: u64 = recorded.into_iter().flatten().map(|level| level.bytes).sum();
                self.package_bytes += bytes;
                self.store_bytes += bytes;
                return self;
            }
        };
        let finest = self.tiles.last().copied().unwrap_or(0);
        let all: u64 = self.tiles.iter().sum();
        let cell = opened.grid.frame.cell();
        let tile_m2 = cell.east_m * cell.north_m * (TILE_CELLS * TILE_CELLS) as f64;
        let covered = photos.grid.area_m2() / tile_m2;
        let texels = covered.min(finest as f64) * rates::photo_texels(photos.levels());
        let package = texels * rates::ALL_PER_FINEST_PHOTO * rates::PHOTO_BYTES_PER_TEXEL;
        self.package_bytes += package.ceil() as u64;
        // Textures of finest tiles are stored in addition to their payloads.
        let rasters = all * rates::PHOTO_RASTER_BYTES;
        self.store_bytes += 2 * package.ceil() as u64 + rasters;
        self.add_work(texels * rates::SECONDS_PER_PHOTO_TEXEL);
        self
    }

    /// Adds work that all threads share.
    fn add_work(&mut self, core_seconds: f64) {
        self.core_seconds += core_seconds;
        self.seconds += core_seconds / self.memory.cores();
    }

    /// Estimates a build that reuses the terrain of a package.
    fn of_recorded(
        manifest: &Manifest,
        memory: MemoryEstimate,
        extract_bytes: u64,
        relief: ReliefLevels,
    ) -> Self {
        let levels = &manifest.levels;
        let tiles: Vec<u64> = levels.iter().map(|level| level.tiles).collect();
        let all = tiles.iter().sum::<u64>();
        let of_levels = |count: fn(&LevelRecord) -> u64| levels.iter().map(count).sum::<u64>();
        let [triangles, terrain_bytes] =
            [of_levels(|level| level.triangles), of_levels(|level| level.terrain_bytes)];
        let relief_bytes =
            if relief == ReliefLevels::Off { 0 } else { of_levels(|level| level.relief_bytes) };
        let costs = GroundCosts {
            package_bytes: (terrain_bytes + relief_bytes) as f64,
            store_bytes: (all * (rates::RECORD_BYTES + 3 * rates::ARTIFACT_BYTES)) as f64,
            core_seconds: rates::SECONDS_PER_RECORDED_TRIANGLE * triangles as f64,
            rates: Rates::Recorded,
        };
        Self::put_together(manifest.counts.samples.nodes, tiles, memory, extract_bytes, costs)
    }

    /// Adds the reliefs of these levels.
    fn with_relief(mut self, relief: ReliefLevels) -> Self {
        let finest = self.tiles.len() as u8 - 1;
        let has = |level: &u8| relief.has(*level, finest);
        let tiles: u64 = (0..=finest).filter(has).map(|level| self.tiles[usize::from(level)]).sum();
        let bytes = tiles * rates::RELIEF_BYTES;
        self.package_bytes += bytes;
        self.store_bytes += bytes;
        self.add_work(tiles as f64 * rates::SECONDS_PER_RELIEF);
        self
    }

    /// Combines the cost of the ground with the cost of the extract.
    fn put_together(
        nodes: u64,
        tiles: Vec<u64>,
        memory: MemoryEstimate,
        extract_bytes: u64,
        ground: GroundCosts,
    ) -> Self {
        let extract = extract_bytes as f64;
        let package = ground.package_bytes + rates::ROADS_PER_EXTRACT_BYTE * extract;
        // Sorted pieces are deleted before the heights are read.
        let pieces = rates::PIECES_PER_EXTRACT_BYTE * extract;
        let while_sorted = pieces + rates::SORTED_PER_EXTRACT_BYTE * extract;
        let store = (ground.store_bytes + package + pieces).max(while_sorted);
        let core_seconds = ground.core_seconds + rates::SECONDS_PER_EXTRACT_BYTE * extract;
        Self {
            nodes,
            tiles,
            store_bytes: store.ceil() as u64,
            package_bytes: package.ceil() as u64,
            core_seconds,
            seconds: core_seconds / memory.cores(),
            memory,
            rates: ground.rates,
        }
    }
}

impl MemoryEstimate {
    /// The memory for elevation files with these blocks, and for the photos.
    fn from_blocks(
        mut blocks: Vec<FileBlocks>,
        opened: &Opened,
        tiles: u64,
        resources: Resources,
    ) -> Self {
        blocks.extend(
            opened.photo.files().into_iter().flat_map(|photo| photo.blocks.iter().cloned()),
        );
        let mut memory = Self::new(&blocks, tiles, resources.threads as u64);
        if let Some(photo) = opened.photo.files() {
            memory.add_photos(photo.levels());
        }
        memory
    }

    /// Estimates the memory for blocks of files.
    pub fn new(files: &[FileBlocks], tiles: u64, threads: u64) -> Self {
        let largest = files.iter().max_by_key(|file| file.block_bytes());
        let block_bytes = largest.map_or(0, FileBlocks::block_bytes);
        let block_row_bytes = files.iter().map(FileBlocks::row_bytes).max().unwrap_or(0);
        let tiles_bytes = tiles.saturating_mul(rates::TILE_BYTES);
        let threads = threads.max(1);
        let of_threads = threads.saturating_mul(rates::THREAD_BYTES.saturating_add(block_bytes));
        Self {
            base_bytes: rates::BASE_BYTES,
            tiles_bytes,
            threads,
            thread_bytes: rates::THREAD_BYTES,
            block_bytes,
            block_file: largest.map_or_else(String::new, |file| file.path.display().to_string()),
            block_row_bytes,
            least_bytes: rates::BASE_BYTES.saturating_add(tiles_bytes).saturating_add(of_threads),
        }
    }

    /// The number of cores that the threads keep busy.
    fn cores(&self) -> f64 {
        self.threads.max(1) as f64 * rates::CORES_BUSY
    }

    /// Adds the memory that a thread needs to create a tile's photo.
    fn add_photos(&mut self, levels: u8) {
        let texels = rates::photo_texels(levels).ceil() as u64;
        let photo_bytes = texels * rates::THREAD_BYTES_PER_PHOTO_TEXEL + rates::PHOTO_PIXELS_BYTES;
        self.thread_bytes += photo_bytes;
        self.least_bytes += self.threads * photo_bytes;
    }
}

impl Ground {
    /// The cost of this many tiles on each level.
    fn costs(&self, nodes: u64, tiles: &[u64]) -> GroundCosts {
        let all: u64 = tiles.iter().sum();
        let finest = tiles.last().copied().unwrap_or(0);
        let finest_triangles = self.triangles_per_node * nodes as f64;
        let all_triangles = rates::ALL_PER_FINEST * finest_triangles;
        let fixed = finest * rates::HEIGHTS_BYTES
            + (all - finest) * rates::RASTER_BYTES
            + all * (rates::RECORD_BYTES + rates::TILE_ARTIFACTS * rates::ARTIFACT_BYTES);
        let coarse_tins = (all_triangles - finest_triangles) * rates::TIN_BYTES_PER_TRIANGLE;
        let triangle_bytes = rates::payload_bytes_per_triangle(self.triangles_per_node);
        GroundCosts {
            package_bytes: all_triangles * triangle_bytes,
            store_bytes: fixed as f64 + coarse_tins,
            core_seconds: self.core_seconds,
            rates: self.rates,
        }
    }

    /// The recorded rates; `tolerance_cells` is the tolerance as a fraction of the cell.
    fn recorded(nodes: u64, tolerance_cells: f64) -> Self {
        let triangles_per_node = rates::triangles_per_node(tolerance_cells);
        let nodes = nodes as f64;
        let all_triangles = rates::ALL_PER_FINEST * triangles_per_node * nodes;
        Self {
            triangles_per_node,
            core_seconds: nodes * rates::SECONDS_PER_NODE
                + all_triangles * rates::SECONDS_PER_TRIANGLE,
            rates: Rates::Recorded,
        }
    }

    /// The average ground of some tiles, void tiles included.
    fn sampled(
        opened: &Opened,
        dem: &Dem,
        finest: &CoveredTiles,
        nodes: u64,
        observer: &dyn BuildObserver,
    ) -> Result<Self, PlanError> {
        let Opened { grid, levels, max_error_m, .. } = opened;
        let mut reader = dem.reader(grid);
        let spec = TinSpec { max_error_m: *max_error_m, quantum_m: levels.quantum_m() };
        let tiles = finest.spread(SAMPLED_TILES);
        let mut triangles = 0;
        let mut spent = Duration::ZERO;
        for &id in &tiles {
            observer.check()?;
            let window = reader.window(grid.frame.tile_window(id).with_halo(1))?;
            let begun = thread_time();
            // Samples that cannot be heights are found and reported when all samples are checked.
            let Ok(tin) = corniche_tin::triangulate(&window.heights, spec) else {
                return Ok(Self::recorded(nodes, opened.tolerance_cells()));
            };
            spent += thread_time().saturating_sub(begun);
            triangles += tin.triangles().len();
        }
        let share = finest.count() as f64 / tiles.len().max(1) as f64;
        Ok(Self {
            triangles_per_node: triangles as f64 * share / nodes.max(1) as f64,
            core_seconds: spent.as_secs_f64() * share * rates::STEPS_PER_MESH,
            rates: Rates::Sampled { tiles: tiles.len() as u64 },
        })
    }
}

#[cfg(test)]
#[path = "estimate_tests.rs"]
pub(crate) mod tests;
