//! The layers that are taken of an extract.

use std::fmt;

use corniche_areas::{Area, AreaTable, ClassedLayer};
use corniche_roads::Road;

use crate::{
    AreaSummary, ClassedLine, ExtractSummary, LineSummary,
    layer_sink::{LayerSink, NamesSink},
};

/// A layer of lines, and who is handed it.
pub type LinesSink<'a> = (ClassedLayer, &'a mut dyn LayerSink<ClassedLine, LineSummary>);

/// Which layers are wanted. They are handed out in this order, one after the other.
#[derive(Default)]
pub struct Layers<'a> {
    /// Areas by this table: see [`read_areas`](crate::read_areas).
    pub areas: Option<(&'a AreaTable, &'a mut dyn LayerSink<Area, AreaSummary>)>,
    /// Layers of lines: see [`read_lines`](crate::read_lines).
    pub lines: Vec<LinesSink<'a>>,
    /// Told, for each way of `lines`, the names of the relations that give it a class, and that of the way itself where it is closed. They are all in
    /// memory then.
    pub line_names: Option<&'a mut NamesSink<'a>>,
    /// Roads by the request's table: see [`read_roads`](crate::read_roads).
    pub roads: Option<&'a mut dyn LayerSink<Road, ExtractSummary>>,
}

impl fmt::Debug for Layers<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { areas, lines, line_names, roads } = self;
        let lines: Vec<ClassedLayer> = lines.iter().map(|&(layer, _)| layer).collect();
        f.debug_struct("Layers")
            .field("areas", &areas.is_some())
            .field("lines", &lines)
            .field("line_names", &line_names.is_some())
            .field("roads", &roads.is_some())
            .finish()
    }
}
