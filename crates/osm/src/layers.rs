//! The layers that are taken of an extract, and who is handed what is in them.

use std::fmt;

use corniche_areas::{Area, AreaTable};
use corniche_roads::Road;

use crate::{AreaSummary, Boundary, BoundarySummary, ExtractSummary};

/// Who is handed the objects of a layer. What is wrong with a layer is told between its beginning and its end.
pub trait LayerSink<T, S> {
    /// The extract was read; all objects of this layer follow.
    fn begin(&mut self) {}

    /// Takes an object.
    fn take(&mut self, object: T);

    /// `done` of `all` ways or objects of this layer were looked at.
    fn reached(&mut self, _done: u64, _all: u64) {}

    /// All objects of this layer were handed out.
    fn end(&mut self, summary: S);
}

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

/// Hands a layer of which all objects go to one function.
pub(crate) struct Only<'a, T, S> {
    sink: &'a mut dyn FnMut(T),
    summary: Option<S>,
}

impl<'a, T, S: Default> Only<'a, T, S> {
    pub(crate) fn new(sink: &'a mut dyn FnMut(T)) -> Self {
        Self { sink, summary: None }
    }

    /// What the layer holds, once it was handed out.
    pub(crate) fn summary(self) -> S {
        self.summary.unwrap_or_default()
    }
}

impl<T, S> LayerSink<T, S> for Only<'_, T, S> {
    fn take(&mut self, object: T) {
        (self.sink)(object);
    }

    fn end(&mut self, summary: S) {
        self.summary = Some(summary);
    }
}
