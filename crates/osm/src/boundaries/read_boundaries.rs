//! The boundaries of an extract are handed out in order of their ways.

use corniche_areas::BoundaryClass;

use super::{boundary::Boundary, make_boundaries::make_boundaries, summary::BoundarySummary};
use crate::{
    Defect, ReadOsmError,
    find_ways::check_held,
    layers::{LayerSink, Layers, Only},
    outlines::{
        found::Outlines, located_ways::LocatedWays, number_objects::number_objects, records::Known,
    },
    read_extract::read_extract,
    read_request::ReadRequest,
    reading::Reading,
};

/// Reads the boundaries of an extract and hands them to `sink` in ascending order of way ids.
///
/// - A boundary is a way with tags of [`BoundaryClass::of_tags`], or one that a relation of the type `boundary` or `multipolygon` with
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

/// Hands out boundaries, and what is wrong with them.
pub(crate) fn hand_out_boundaries<'a>(
    reading: &Reading<'a>,
    (outlines, located): (Outlines<'a>, LocatedWays<'a>),
    sink: &mut dyn LayerSink<Boundary, BoundarySummary>,
    on_defect: &mut dyn FnMut(Defect),
) -> Result<(), ReadOsmError> {
    let failed = |error| reading.scratch_failed(error);
    let Outlines { objects, defects, held_bytes, .. } = outlines;
    sink.begin();
    defects.tell(on_defect).map_err(failed)?;
    // Of objects with one id the first stays, which is told as for areas.
    let objects = number_objects(reading, objects, on_defect)?;
    check_held(reading, held_bytes + objects.count)?;
    let mut classes = Vec::with_capacity(objects.count as usize);
    let mut known = objects.known.read();
    while let Some(object) = known.next(Known::decode).map_err(failed)? {
        classes.push(object.class.and_then(BoundaryClass::from_number));
    }
    let members = objects.members.finish().map_err(failed)?;
    let mut summary = BoundarySummary { objects: objects.count, ..BoundarySummary::default() };
    make_boundaries(reading, (members, &classes), located, &mut summary, (sink, on_defect))?;
    sink.end(summary);
    Ok(())
}
