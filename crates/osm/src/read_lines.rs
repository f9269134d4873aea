//! A layer of lines of an extract, read without other layers.

use corniche_areas::ClassedLayer;

use crate::{
    ClassedLine, Defect, LineSummary, ReadOsmError, layer_sink::Only, layers::Layers,
    read_extract::read_extract, read_request::ReadRequest,
};

/// Reads the lines of a layer and hands them to `sink` in ascending order of way ids.
///
/// - A line is a way with tags of the layer's [`ClassTable`](corniche_areas::ClassTable), or, if the table has relations, one that a relation of the type `boundary` or `multipolygon` with
///   such tags names as `outer`, `inner` or without a role. A way to which several objects give a class, such as a
///   border of a country that is one of a district, too, comes once, in the most important class.
/// - What is wrong with the data goes to `on_defect`, in an order that depends on the file alone. Each way that is left out has one
///   [`Defect::LostLine`].
///
/// Memory, limits, several extracts and what the file may be are as for [`crate::read_areas`]; beside that a byte is held for each way
/// and relation with such tags.
///
/// # Errors
/// As for [`crate::read_roads`].
pub fn read_lines(
    request: &ReadRequest<'_>,
    layer: ClassedLayer,
    sink: &mut dyn FnMut(ClassedLine),
    on_defect: &mut dyn FnMut(Defect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<LineSummary, ReadOsmError> {
    let mut lines = Only::new(sink);
    let layers = Layers { lines: vec![(layer, &mut lines)], ..Layers::default() };
    read_extract(request, layers, on_defect, should_stop)?;
    Ok(lines.summary())
}
