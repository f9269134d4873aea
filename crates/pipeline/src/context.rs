//! The context of every step of a build: the open elevation files, the grid, the levels, and the
//! store.

use corniche_dem::{Dem, GridPlan};
use corniche_geom::{GridFrame, LatticeBounds, LatticeRegion, TileId};
use corniche_gis::{CrsError, DemProjection};
use corniche_ground::{
    heights::pyramid::Pyramid, photos::textures::TextureStore, terrain::ground::GroundSource,
};
use corniche_plan::Opened;
use corniche_spec::{
    BuildObserver, PlanSettings, Resources, artifacts::ArtifactKind, data_outline::data_outline,
    data_tiles::DataTiles, extent::ExtentOutline, levels::Levels, memory_shares::MemoryShares,
    true_lengths::TrueLengths,
};
use corniche_store::Artifacts;
use corniche_work::{Stage, workers};

use crate::BuildError;

/// The context that the steps of a build share. It is derived from the settings alone, so every
/// process of a build has the same context.
pub(crate) struct BuildContext<'a> {
    pub settings: &'a PlanSettings,
    pub resources: Resources,
    pub opened: &'a Opened,
    pub source: &'a GroundSource,
    pub grid: &'a GridPlan,
    pub levels: &'a Levels,
    /// WGS84 ⇄ the grid's working CRS.
    pub projection: &'a DemProjection,
    pub store: &'a dyn Artifacts,
    pub observer: &'a dyn BuildObserver,
}

impl<'a> BuildContext<'a> {
    /// Creates the context from open inputs, with a store for the results.
    pub(crate) fn new(
        settings: &'a PlanSettings,
        resources: Resources,
        opened: &'a Opened,
        store: &'a dyn Artifacts,
        observer: &'a dyn BuildObserver,
    ) -> Self {
        let Opened { source, grid, levels, projection, .. } = opened;
        Self { settings, resources, opened, source, grid, levels, projection, store, observer }
    }

    /// Measures roads.
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

    /// Creates the missing artifacts of one kind for some tiles, in their order, as one stage.
    /// `work` creates and stores them.
    pub(crate) fn make_missing<S>(
        &self,
        (stage, kind): (Stage, ArtifactKind),
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
        DataTiles::from_plan(self.grid)
    }

    /// The rectangle of all nodes at which there can be data.
    pub(crate) fn node_bounds(&self) -> LatticeBounds {
        self.frame().lattice_bounds([self.grid.south_west, self.grid.north_east])
    }

    /// The outline of the elevation files, if they do not fill a rectangle.
    pub(crate) fn data_outline(&self) -> Result<Option<ExtentOutline>, CrsError> {
        match self.source {
            GroundSource::Dem(dem) => data_outline(dem, self.grid, self.projection),
            GroundSource::Package(package) => Ok(package.manifest().data_outline()),
        }
    }

    /// The sources of photo textures, and the store for them.
    pub(crate) fn textures(&self) -> TextureStore<'_> {
        let Self { store, source, opened, .. } = *self;
        let photo = &opened.photo;
        TextureStore { store, source, photo, frame: self.frame(), data: self.data() }
    }

    /// The requested bounds.
    pub(crate) fn clip(&self) -> Option<LatticeBounds> {
        Some(self.frame().lattice_bounds(self.grid.clip?.nodes))
    }

    /// The requested polygon.
    pub(crate) fn polygon(&self) -> Option<&LatticeRegion> {
        self.grid.polygon.as_deref()
    }

    /// The heights of the DEM; `None` if the terrain comes from a package.
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

    /// The distribution of the memory that a run may use.
    pub(crate) fn memory(&self) -> MemoryShares {
        MemoryShares::from_memory(self.resources.memory_bytes)
    }
}
