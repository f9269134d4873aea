//! Lines of a layer and what is wrong with them are handed out in order of their ways.

use corniche_areas::ClassedLayer;

use super::{
    classed_line::ClassedLine,
    make_lines::{NO_CLASS, make_lines},
    summary::LineSummary,
};
use crate::{
    Defect, ReadOsmError,
    layer_sink::LayerSink,
    looked::check_held,
    outlines::{found::OutlineObjects, located_ways::LocatedWays, records::Known},
    reading::Reading,
};

/// Hands out the lines of a layer, and what is wrong with them.
pub(crate) fn hand_out_lines<'a>(
    reading: &Reading<'a>,
    layer: ClassedLayer,
    (objects, located): (OutlineObjects<'a>, LocatedWays<'a>),
    sink: &mut dyn LayerSink<ClassedLine, LineSummary>,
    on_defect: &mut dyn FnMut(Defect),
) -> Result<(), ReadOsmError> {
    let failed = |error| reading.scratch_failed(error);
    // Of objects with one id the first stays, which is told as for areas.
    let OutlineObjects { mut known, count, members, defects, held_bytes, .. } = objects;
    sink.begin();
    defects.tell(on_defect).map_err(failed)?;
    check_held(reading, held_bytes + count)?;
    let mut classes = Vec::with_capacity(count as usize);
    while let Some(object) = known.next(Known::decode).map_err(failed)? {
        classes.push(object.class.unwrap_or(NO_CLASS));
    }
    let mut summary = LineSummary { objects: count, ..LineSummary::default() };
    make_lines(reading, layer, (members, &classes), located, &mut summary, (sink, on_defect))?;
    sink.end(summary);
    Ok(())
}
