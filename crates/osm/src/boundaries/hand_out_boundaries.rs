//! Boundaries and what is wrong with them are handed out in order of their ways.

use corniche_areas::BoundaryClass;

use super::{boundary::Boundary, make_boundaries::make_boundaries, summary::BoundarySummary};
use crate::{
    Defect, ReadOsmError,
    layer_sink::LayerSink,
    looked::check_held,
    outlines::{
        found::Outlines, located_ways::LocatedWays, number_objects::number_objects, records::Known,
    },
    reading::Reading,
};

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
