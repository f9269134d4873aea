//! What every step of a build needs: the elevation files as opened, the grid, the levels, and the store.

use corniche_dem::{Dem, GridPlan};
use corniche_geom::{GridFrame, LatticeBounds, LatticeRegion, TileId};
use corniche_gis::{CrsError, DemProjection};
use corniche_ground::{
    heights::pyramid::Pyramid, photos::textures::TextureStore, terrain::ground::GroundSource,
};
use corniche_plan::Opened;
use corniche_spec::{
    Observer, PlanSettings, Resources, artifacts::Kind, data_outline::data_outline,
    data_tiles::DataTiles, extent::Outline, levels::Levels, memory_shares::MemoryShares,
    true_lengths::TrueLengths,
};
use corniche_store::Artifacts;
use corniche_work::{Stage, workers};

use crate::BuildError;

/// What the steps of a build share. It is made from the settings alone, so every process that works on one build has the same.
pub(crate) struct Context<'a> {
    pub(crate) settings: &'a PlanSettings,
    pub(crate) resources: Resources,
    pub(crate) opened: &'a Opened,
    pub(crate) source: &'a GroundSource,
    pub(crate) grid: &'a GridPlan,
    pub(crate) levels: &'a Levels,
    /// WGS84 ⇄ the grid's working CRS.
    pub(crate) projection: &'a DemProjection,
    pub(crate) store: &'a dyn Artifacts,
    pub(crate) observer: &'a dyn Observer,
}

impl<'a> Context<'a> {
    /// What was opened, with a store for the results.
    pub(crate) fn new(
        settings: &'a PlanSettings,
        resources: Resources,
        opened: &'a Opened,
        store: &'a dyn Artifacts,
        observer: &'a dyn Observer,
    ) -> Self {
        let Opened { source, grid, levels, projection, .. } = opened;
        Self { settings, resources, opened, source, grid, levels, projection, store, observer }
    }

    /// How roads are measured.
    pub(crate) fn lengths(&self) -> TrueLengths<'a> {
        TrueLengths::new(*self.frame(), &self.opened.coordinates, self.projection)
    }

    pub(crate) fn frame(&self) -> &GridFrame {
        self.levels.frame()
    }

    /// Whether a tile has a relief section if it has ground.
    pub(crate) fn has_relief(&self, id: TileId) -> bool {
        self.settings.terrain.relief.has(id.z(), self.frame().max_level())
    }

    /// Makes what some tiles lack of a kind of artifacts, in their order: a stage. `work` keeps what it makes.
    pub(crate) fn make_missing<S>(
        &self,
        (stage, kind): (Stage, Kind),
        mut ids: Vec<TileId>,
        start: impl Fn() -> Result<S, BuildError> + Sync,
        work: impl Fn(&mut S, TileId) -> Result<(), BuildError> + Sync,
    ) -> Result<(), BuildError> {
        let all = ids.len();
        ids.retain(|&id| !self.store.has(kind.of_tile(id)));
        let (threads, work) = (self.threads(), |state: &mut S, id: &TileId| work(state, *id));
        workers::make_missing(self.observer, stage, threads, (&ids, all), start, work)
    }

    pub(crate) fn data(&self) -> DataTiles {
        DataTiles::of(self.grid)
    }

    /// The rectangle of all nodes at which data can lie.
    pub(crate) fn node_bounds(&self) -> LatticeBounds {
        self.frame().lattice_bounds([self.grid.south_west, self.grid.north_east])
    }

    /// The outline of the elevation files, where they fill no rectangle.
    pub(crate) fn data_outline(&self) -> Result<Option<Outline>, CrsError> {
        match self.source {
            GroundSource::Dem(dem) => data_outline(dem, self.grid, self.projection),
            GroundSource::Package(package) => Ok(package.manifest().data_outline()),
        }
    }

    /// Where textures of photos come from and go to.
    pub(crate) fn textures(&self) -> TextureStore<'_> {
        let Self { store, source, opened, .. } = *self;
        let photo = &opened.photo;
        TextureStore { store, source, photo, frame: self.frame(), data: self.data() }
    }

    /// The bounds that were asked for.
    pub(crate) fn clip(&self) -> Option<LatticeBounds> {
        Some(self.frame().lattice_bounds(self.grid.clip?.nodes))
    }

    /// The polygon that was asked for.
    pub(crate) fn polygon(&self) -> Option<&LatticeRegion> {
        self.grid.polygon.as_deref()
    }

    /// The heights of the DEM; `None` where the terrain comes from a package.
    pub(crate) fn pyramid(&self) -> Option<Pyramid<'_>> {
        match self.source {
            GroundSource::Dem(dem) => Some(self.pyramid_of(dem)),
            GroundSource::Package(_) => None,
        }
    }

    /// The heights of `dem`, the build's own source.
    pub(crate) fn pyramid_of(&self, dem: &'a Dem) -> Pyramid<'_> {
        Pyramid {
            dem,
            grid: self.grid,
            range_m: self.settings.terrain.height_range_m,
            threads: self.threads(),
            store: self.store,
            observer: self.observer,
        }
    }

    pub(crate) fn threads(&self) -> usize {
        self.resources.threads
    }

    /// How the memory that a run may use is shared out.
    pub(crate) fn memory(&self) -> MemoryShares {
        MemoryShares::of(self.resources.memory_bytes)
    }
}
