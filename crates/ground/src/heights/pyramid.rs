//! The heights of all levels: the DEM is read patch by patch into the heights of finest tiles and
//! the rasters of the levels above.

use std::collections::{BTreeMap, BTreeSet};

use corniche_dem::{Audit, AuditBlock, Dem, GridPlan, SURFACE_RANGE_M};
use corniche_geom::{HeightGrid, TileId};
use corniche_spec::{
    BuildObserver,
    artifacts::{ArtifactError, ArtifactKind},
    data_tiles::DataTiles,
};
use corniche_store::Artifacts;
use corniche_tileset::{Manifest, SampleCounts};
use corniche_work::{Stage, workers};

use super::{
    near::is_near,
    patch::{PatchReader, PatchRecord, audit_blocks_of, patch_level},
    rasters, upwards,
};
use crate::GroundError;

/// Reads the heights of all levels from a DEM and stores them.
pub struct Pyramid<'a> {
    /// The elevation files.
    pub dem: &'a Dem,
    /// The grid of nodes.
    pub grid: &'a GridPlan,
    /// Lowest and highest height that samples may have, metres, if the user gave a range.
    pub range_m: Option<[f64; 2]>,
    /// Worker threads.
    pub threads: usize,
    /// The store for heights.
    pub store: &'a dyn Artifacts,
    /// Receives progress and defects.
    pub observer: &'a dyn BuildObserver,
}

impl Pyramid<'_> {
    /// Reads those patches of a subtree that are not in the store, and creates the rasters from
    /// there up to the subtree's own.
    ///
    /// # Errors
    /// See [`GroundError`].
    pub fn make(&self, scope: TileId) -> Result<(), GroundError> {
        self.read_areas(scope)?;
        self.make_rasters(scope)
    }

    /// Whether a patch is complete in the store. A patch above it has the same artifacts.
    fn has_patch(&self, patch: TileId) -> bool {
        let (store, data) = (self.store, self.data());
        let finest_level = self.grid.frame.max_level();
        let mut rasters =
            (patch.z()..finest_level).flat_map(|level| data.above(level).within(patch));
        (0..=patch.z()).any(|level| store.has(ArtifactKind::Patch.of_tile(patch.ancestor(level))))
            && data.within(patch).into_iter().all(|id| store.has(ArtifactKind::Heights.of_tile(id)))
            && rasters.all(|id| store.has(ArtifactKind::Raster.of_tile(id)))
    }

    fn data(&self) -> DataTiles {
        DataTiles::from_plan(self.grid)
    }

    fn read_areas(&self, scope: TileId) -> Result<(), GroundError> {
        let &Self { dem, grid, store, observer, .. } = self;
        let level = patch_level(&grid.frame, scope);
        let all = self.data().above(level).within(scope);
        let missing: Vec<TileId> =
            all.iter().copied().filter(|&patch| !self.has_patch(patch)).collect();
        let mut blocks: BTreeMap<TileId, Vec<AuditBlock>> = BTreeMap::new();
        let wanted: BTreeSet<TileId> = missing.iter().copied().collect();
        for (patch, block) in audit_blocks_of(dem, grid, level)? {
            if wanted.contains(&patch) {
                blocks.entry(patch).or_default().push(block);
            }
        }
        workers::make_missing(
            observer,
            Stage::Heights,
            self.threads,
            (&missing, all.len()),
            || Ok(PatchReader::new(dem, grid, self.allowed_m(), store)),
            |reader, patch| reader.make(*patch, blocks.get(patch).map_or(&[], Vec::as_slice)),
        )
    }

    /// Creates the missing rasters beneath and at `scope`, from those in the store upwards.
    ///
    /// # Errors
    /// See [`GroundError`].
    pub fn make_rasters(&self, scope: TileId) -> Result<(), GroundError> {
        let (store, data) = (self.store, self.data());
        upwards::make_missing(
            (store, &data),
            (self.observer, self.threads),
            ArtifactKind::Raster,
            scope,
            |id| rasters::put_from_children(store, &data, id),
        )
    }

    /// The heights of a tile with one node of halo on every side (259 × 259); `None` if the tile
    /// has no height.
    ///
    /// # Errors
    /// See [`GroundError`].
    pub fn tile(&self, id: TileId) -> Result<Option<HeightGrid>, GroundError> {
        rasters::of_any_level(self.store, &self.data(), id, 1)
    }
}

/// Fails if there are missing tiles, and names them.
///
/// # Errors
/// See [`GroundError`].
pub fn all_there(what: &str, missing: &[TileId], step: &'static str) -> Result<(), GroundError> {
    const NAMED: usize = 8;
    if missing.is_empty() {
        return Ok(());
    }
    let mut names: Vec<String> = missing.iter().take(NAMED).map(ToString::to_string).collect();
    if missing.len() > NAMED {
        names.push(format!("and {} more", missing.len() - NAMED));
    }
    let what = format!("{what} of {}", names.join(", "));
    Err(ArtifactError::Missing { what, step }.into())
}

/// The sums over the heights of all patches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightSums {
    /// The numbers of nodes with heights.
    pub samples: SampleCounts,
    /// Lowest and highest node; zeros if there is none.
    pub range_m: [f32; 2],
    /// The smallest height step that the DEM can represent, metres.
    pub step_m: f64,
}

impl HeightSums {
    /// The sums that a package records.
    #[must_use]
    pub fn recorded(manifest: &Manifest) -> Self {
        // The values were 32-bit numbers before they were written.
        let range_m = manifest.vertical.range_m.map(|height_m| height_m as f32);
        let step_m = manifest.vertical.height_step_m;
        Self { samples: manifest.counts.samples, range_m, step_m }
    }
}

impl Pyramid<'_> {
    /// Fails if samples of `patches` cannot be heights; see [`Audit::check`].
    ///
    /// # Errors
    /// See [`GroundError`].
    pub fn check(&self, patches: &PatchRecord) -> Result<(), GroundError> {
        Ok(self.audit(patches).check(self.dem, self.range_m.is_some())?)
    }

    /// Warns of isolated spikes in the samples of `patches`, unless the user gave the range of
    /// heights.
    pub fn warn_of_spikes(&self, patches: &PatchRecord) {
        if self.range_m.is_none() {
            for text in self.audit(patches).spikes(self.dem) {
                self.observer.warning(&text);
            }
        }
    }

    fn audit(&self, patches: &PatchRecord) -> Audit {
        let mut audit = Audit::none_of(self.dem, self.allowed_m());
        patches.audit.iter().for_each(|part| audit.merge(part));
        audit
    }

    /// Sums up `all` patches.
    #[must_use]
    pub fn sums(&self, all: &PatchRecord) -> HeightSums {
        let plan = self.grid;
        let span = |low: i64, high: i64| (high - low + 1) as u64;
        let nodes =
            span(plan.south_west.i, plan.north_east.i) * span(plan.south_west.j, plan.north_east.j);
        let samples = SampleCounts {
            nodes,
            with_data: all.with_height - all.filled,
            filled: all.filled,
            void: nodes.saturating_sub(all.with_height),
        };
        HeightSums {
            samples,
            range_m: all.range_m.unwrap_or_default(),
            step_m: self.audit(all).height_step_m(self.dem),
        }
    }

    /// Merges the records of all patches; fails if a record is missing.
    ///
    /// The patches of a split build may be on several levels, and even one above the other. Each
    /// finest tile counts for the highest patch in the store, as do all other tiles beneath that
    /// patch, so nothing counts twice.
    ///
    /// # Errors
    /// See [`GroundError`].
    pub fn all_patches(&self) -> Result<PatchRecord, GroundError> {
        let store = self.store;
        let area_of = |finest: TileId| {
            let mut patches = (0..=finest.z()).map(|level| finest.ancestor(level));
            patches.find(|&patch| store.has(ArtifactKind::Patch.of_tile(patch)))
        };
        let data = self.data();
        all_there("the heights", &data.missing(|id| area_of(id).is_none()), "heights")?;
        let patches: BTreeSet<TileId> =
            data.within(TileId::ROOT).into_iter().filter_map(area_of).collect();
        let mut all = PatchRecord::default();
        for patch in patches {
            all.merge(PatchRecord::get(store, patch)?.unwrap_or_default());
        }
        Ok(all)
    }

    /// Fails if heights of finest tiles of the subtree `scope` are missing, or rasters of tiles in
    /// it, above it or around these tiles.
    ///
    /// # Errors
    /// See [`GroundError`].
    pub fn check_complete(&self, scope: TileId) -> Result<(), GroundError> {
        let (store, data) = (self.store, self.data());
        let is_missing = |id: TileId| {
            id.ancestor(scope.z()) == scope && !store.has(ArtifactKind::Heights.of_tile(id))
        };
        all_there("the heights", &data.missing(is_missing), "heights")?;
        let levels = 0..self.grid.frame.max_level();
        let all = levels.flat_map(|level| data.above(level).within(TileId::ROOT));
        let is_missing =
            |&id: &TileId| is_near(scope, id) && !store.has(ArtifactKind::Raster.of_tile(id));
        let missing: Vec<TileId> = all.filter(is_missing).collect();
        all_there("the heights", &missing, "top")
    }

    /// Lowest and highest height that samples may have, metres.
    fn allowed_m(&self) -> [f64; 2] {
        self.range_m.unwrap_or(SURFACE_RANGE_M)
    }
}
