//! The common part of splitting objects of layers by tile: the layer, the requested tiles, and the
//! lattice of each level.

use corniche_geom::{GridFrame, LatticeBounds, LatticePoint, LatticeRegion};
use corniche_layers::{ClassForm, LayerTable};
use corniche_spec::{data_tiles::DataTiles, points_step::points_step};

/// A layer, and the region for its objects.
#[derive(Clone, Copy)]
pub(crate) struct PlanSplitting<'a> {
    pub table: &'a LayerTable,
    pub frame: &'a GridFrame,
    pub data: DataTiles,
    /// The requested bounds: tiles that do not touch them get no lines.
    pub clip: Option<LatticeBounds>,
    /// The requested polygon: objects are clipped to its outline.
    pub polygon: Option<&'a LatticeRegion>,
}

impl PlanSplitting<'_> {
    /// The spacing of the lattice for points of a level, in steps of the package's lattice: a power
    /// of two.
    pub(crate) fn step(&self, level: u8) -> i64 {
        points_step(self.frame, level)
    }

    /// The nearest point of a level's lattice.
    pub(crate) fn on_lattice(&self, point: LatticePoint, level: u8) -> LatticePoint {
        let step = self.step(level);
        let nearest = |part: i64| (part + step / 2).div_euclid(step) * step;
        LatticePoint::new(nearest(point.u), nearest(point.v))
    }

    /// The levels on which a class is stored.
    pub(crate) fn levels_of(&self, class: u8) -> impl Iterator<Item = u8> {
        let (frame, finest) = (self.frame, self.frame.max_level());
        let class = self.table.classes().get(usize::from(class));
        let most_m = class.and_then(ClassForm::coarsest_cell_m);
        (0..=finest).filter(move |&level| {
            let cell_m = frame.level_cell(level).shorter_m();
            level == finest || most_m.is_none_or(|most_m| cell_m <= most_m)
        })
    }
}
