//! The layers that are read from an extract.

use corniche_areas::{Area, AreaTable};
use corniche_roads::Road;

use crate::{
    AreaSummary, ClassedLine, ExtractSummary, LineSummary,
    layer_sink::{LayerSink, NamesSink},
};

/// The requested layers. They are delivered in this order, one after the other.
#[derive(Default)]
pub struct Layers<'a> {
    /// Areas by this table: first the areas of ways, then the areas of relations, in ascending
    /// order of ids.
    ///
    /// - An area is a closed way, or a relation of the type `multipolygon` or `boundary`, with a
    ///   tag of the table. A way with `area=no` is not an area. The positions of ways, not their
    ///   roles, decide which ways of a relation are outer rings and which are holes. Relations in
    ///   relations are not followed.
    /// - Each object with a tag of the table becomes an area, or has one
    ///   [`ExtractDefect::LostArea`](crate::ExtractDefect::LostArea).
    /// - Coastlines (`natural=coastline`) are not areas. If the table includes the sea, they are in
    ///   the summary, to be closed by [`corniche_areas::close_sea`]; they are kept in memory, 16
    ///   bytes per point.
    pub areas: Option<(&'a AreaTable, &'a mut dyn LayerSink<Area, AreaSummary>)>,
    /// Boundaries, in ascending order of way ids.
    ///
    /// - A line is a way with tags of a [`BoundaryClass`](corniche_areas::BoundaryClass), or a way
    ///   that is a member of a relation of the type `boundary` or `multipolygon` with such tags,
    ///   with the role `outer`, `inner` or none. If several objects give a way a class, such as a
    ///   border of a country that is also a border of a district, the way is delivered once, with
    ///   the most important class.
    /// - Each skipped way has one [`ExtractDefect::LostLine`](crate::ExtractDefect::LostLine).
    pub boundaries: Option<&'a mut dyn LayerSink<ClassedLine, LineSummary>>,
    /// Receives, for each way of `boundaries`, the names of the relations that give it a class, and
    /// the name of the way itself if it is closed. All names are kept in memory.
    pub boundary_names: Option<&'a mut NamesSink<'a>>,
    /// Roads by the request's table, in ascending order of way id.
    ///
    /// - A way is one [`Road`], unless nodes in its middle are missing, out of range or outside the
    ///   projection. The way is cut there, and each piece of two or more points is a road with the
    ///   same way id, in the way's order. A gap is never closed by a straight line.
    /// - [`Road::fixed`] contains the ends and every node that two of the roads share or that one
    ///   road visits twice.
    /// - An extract without roads is not an error: the summary reports 0.
    pub roads: Option<&'a mut dyn LayerSink<Road, ExtractSummary>>,
}
