//! The areas of an extract, read without other layers.

use corniche_areas::{Area, AreaTable};

use crate::{
    AreaSummary, Defect, ReadOsmError, layer_sink::Only, layers::Layers,
    read_extract::read_extract, read_request::ReadRequest,
};

/// Reads the areas of an extract and hands them to `sink`: first those of ways, then those of relations, in ascending order of
/// id.
///
/// - An area is a closed way, or a relation of the type `multipolygon` or `boundary`, with a tag of `table`. A way with
///   `area=no` is none. Which ways of a relation are outer rings and which are holes is decided by where they lie, not by their
///   roles; relations in relations are not followed.
/// - What is wrong with the data goes to `on_defect`, in an order that depends on the file alone, as the areas do. Each object
///   with a tag of the table becomes an area, or has one [`Defect::LostArea`].
/// - Coastlines (`natural=coastline`) are no areas. If the table wants the sea, they are in the summary, to be closed by
///   [`corniche_areas::close_sea`]; they are kept in memory, 16 bytes a point.
///
/// Memory, limits, several extracts and what the file may be are as for [`crate::read_roads`]; `request.table` is not used. An extract that
/// is sorted by kind is read once: relations, ways, nodes. One that is not is read three times: for objects, for ways, for nodes. Where the ids
/// of the ways that relations name do not fit in memory, blobs with ways are read once more for each part that fits.
///
/// # Errors
/// As for [`crate::read_roads`].
pub fn read_areas(
    request: &ReadRequest<'_>,
    table: &AreaTable,
    sink: &mut dyn FnMut(Area),
    on_defect: &mut dyn FnMut(Defect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<AreaSummary, ReadOsmError> {
    let mut areas = Only::new(sink);
    let layers = Layers { areas: Some((table, &mut areas)), ..Layers::default() };
    read_extract(request, layers, on_defect, should_stop)?;
    Ok(areas.summary())
}
