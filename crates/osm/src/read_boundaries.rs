//! The boundaries of an extract, read without other layers.

use crate::{
    Boundary, BoundarySummary, Defect, ReadOsmError, layer_sink::Only, layers::Layers,
    read_extract::read_extract, read_request::ReadRequest,
};

/// Reads the boundaries of an extract and hands them to `sink` in ascending order of way ids.
///
/// - A boundary is a way with tags of [`BoundaryClass::of_tags`](corniche_areas::BoundaryClass::of_tags), or one that a relation of the type `boundary` or `multipolygon` with
///   such tags names as `outer`, `inner` or without a role. A way that several objects make a boundary, such as a
///   border of a country that is one of a district, too, comes once, in the most important class.
/// - What is wrong with the data goes to `on_defect`, in an order that depends on the file alone. Each way that is left out has one
///   [`Defect::LostBoundary`].
///
/// Memory, limits, several extracts and what the file may be are as for [`crate::read_areas`]; beside that a byte is held for each way
/// and relation with such tags.
///
/// # Errors
/// As for [`crate::read_roads`].
pub fn read_boundaries(
    request: &ReadRequest<'_>,
    sink: &mut dyn FnMut(Boundary),
    on_defect: &mut dyn FnMut(Defect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<BoundarySummary, ReadOsmError> {
    let mut boundaries = Only::new(sink);
    let layers = Layers { boundaries: Some(&mut boundaries), ..Layers::default() };
    read_extract(request, layers, on_defect, should_stop)?;
    Ok(boundaries.summary())
}
