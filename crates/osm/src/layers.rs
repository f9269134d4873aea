//! The layers that are read from an extract, and their receivers.

use corniche_layers::{LayerGeometry, LayerTable};
use corniche_roads::Road;

use crate::{
    AreaSummary, ExtractSummary, LayerArea, LayerLine, LayerPoint, LineSummary, PointSummary,
    layer_sink::LayerSink,
};

/// The requested layers. They are delivered in this order, one after the other.
#[derive(Default)]
pub struct Layers<'a> {
    /// Layers by their tables. The receiver decides whether their objects become areas, lines or
    /// points.
    pub layers: Vec<(&'a LayerTable, LayerReceiver<'a>)>,
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

/// The receiver of a layer's objects.
pub enum LayerReceiver<'a> {
    /// Areas: first the areas of ways, then the areas of relations, in ascending order of ids.
    ///
    /// - An area is a closed way, or a relation of the type `multipolygon` or `boundary`, with tags
    ///   of the table. A way with `area=no` is not an area. The positions of ways, not their roles,
    ///   decide which ways of a relation are outer rings and which are holes. Relations in
    ///   relations are not followed.
    /// - Each object with tags of the table becomes an area, or has one
    ///   [`ExtractDefect::LostArea`](crate::ExtractDefect::LostArea).
    /// - Coastlines (`natural=coastline`) are not areas. If a class of the table is built from
    ///   them, they are in the summary, to be closed by [`corniche_areas::close_sea`]; they are
    ///   kept in memory, 16 bytes per point.
    Areas(&'a mut dyn LayerSink<LayerArea, AreaSummary>),
    /// Lines, in ascending order of way ids.
    ///
    /// - A line is a way with tags of the table, or a way that is a member of a relation with such
    ///   tags, if the table has [`RelationMembers`](corniche_layers::RelationMembers). If several
    ///   objects give a way a class, such as a border of a country that is also a border of a
    ///   district, the way is delivered once, with the first of these classes.
    /// - Each skipped way has one [`ExtractDefect::LostLine`](crate::ExtractDefect::LostLine).
    Lines(&'a mut dyn LayerSink<LayerLine, LineSummary>),
    /// Points: first nodes with tags of the table, then, unless the table excludes them, closed
    /// ways and relations that would be areas, at [a place inside](corniche_areas::inside_point),
    /// each in ascending order of ids.
    ///
    /// Each object with tags of the table becomes a point, or has one
    /// [`ExtractDefect::LostArea`](crate::ExtractDefect::LostArea).
    Points(&'a mut dyn LayerSink<LayerPoint, PointSummary>),
}

impl LayerReceiver<'_> {
    pub(crate) fn geometry(&self) -> LayerGeometry {
        match self {
            Self::Areas(_) => LayerGeometry::Area,
            Self::Lines(_) => LayerGeometry::Line,
            Self::Points(_) => LayerGeometry::Point,
        }
    }
}
