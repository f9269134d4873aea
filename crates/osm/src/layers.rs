//! The layers that are taken of an extract.

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
    /// Areas by this table: first those of ways, then those of relations, in ascending order of id.
    ///
    /// - An area is a closed way, or a relation of the type `multipolygon` or `boundary`, with a tag of the table. A way with
    ///   `area=no` is none. Which ways of a relation are outer rings and which are holes is decided by where they lie, not by
    ///   their roles; relations in relations are not followed.
    /// - Each object with a tag of the table becomes an area, or has one [`Defect::LostArea`](crate::Defect::LostArea).
    /// - Coastlines (`natural=coastline`) are no areas. If the table wants the sea, they are in the summary, to be closed by
    ///   [`corniche_areas::close_sea`]; they are kept in memory, 16 bytes a point.
    pub areas: Option<(&'a AreaTable, &'a mut dyn LayerSink<Area, AreaSummary>)>,
    /// Layers of lines, each in ascending order of way ids.
    ///
    /// - A line is a way with tags of the layer's [`ClassTable`](corniche_areas::ClassTable), or, if the table has relations,
    ///   one that a relation of the type `boundary` or `multipolygon` with such tags names as `outer`, `inner` or without a
    ///   role. A way to which several objects give a class, such as a border of a country that is one of a district, too,
    ///   comes once, in the most important class.
    /// - Each way that is left out has one [`Defect::LostLine`](crate::Defect::LostLine).
    pub lines: Vec<LinesSink<'a>>,
    /// Told, for each way of `lines`, the names of the relations that give it a class, and that of the way itself where it is closed. They are all in
    /// memory then.
    pub line_names: Option<&'a mut NamesSink<'a>>,
    /// Roads by the request's table, in ascending order of way id.
    ///
    /// - A way is one [`Road`], except where nodes in its middle are missing, out of range or outside the projection: it
    ///   is cut there, and each piece of two or more points is a road with the same way id, in the way's order. A gap is
    ///   never closed by a straight line.
    /// - [`Road::fixed`] holds the ends and every node that two of the roads share or one visits twice.
    /// - An extract without roads is no error: the summary says 0.
    pub roads: Option<&'a mut dyn LayerSink<Road, ExtractSummary>>,
}
