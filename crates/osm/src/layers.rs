//! The layers that are taken of an extract.

use std::fmt;

use corniche_areas::{Area, AreaTable};
use corniche_roads::Road;

use crate::{AreaSummary, Boundary, BoundarySummary, ExtractSummary, layer_sink::LayerSink};

/// Which layers are wanted. They are handed out in this order, one after the other.
#[derive(Default)]
pub struct Layers<'a> {
    /// Areas by this table: see [`read_areas`](crate::read_areas).
    pub areas: Option<(&'a AreaTable, &'a mut dyn LayerSink<Area, AreaSummary>)>,
    /// Boundaries: see [`read_boundaries`](crate::read_boundaries).
    pub boundaries: Option<&'a mut dyn LayerSink<Boundary, BoundarySummary>>,
    /// Roads by the request's table: see [`read_roads`](crate::read_roads).
    pub roads: Option<&'a mut dyn LayerSink<Road, ExtractSummary>>,
}

impl fmt::Debug for Layers<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { areas, boundaries, roads } = self;
        f.debug_struct("Layers")
            .field("areas", &areas.is_some())
            .field("boundaries", &boundaries.is_some())
            .field("roads", &roads.is_some())
            .finish()
    }
}
