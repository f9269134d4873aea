//! Delivers the lines of a layer and their defects in the order of the ways.

use super::{
    layer_line::LayerLine, line_objects::line_objects, make_lines::make_lines, summary::LineSummary,
};
use crate::{
    ExtractDefect,
    failed::Failed,
    layer_sink::LayerSink,
    outlines::{found::OutlineObjects, located_ways::LocatedWays},
    reading::ExtractReading,
};

/// Delivers the lines of a layer and their defects.
pub(crate) fn hand_out_lines<'a>(
    reading: &'a ExtractReading<'a>,
    (objects, located): (OutlineObjects<'a>, LocatedWays<'a>),
    sink: &mut dyn LayerSink<LayerLine, LineSummary>,
    on_defect: &mut dyn FnMut(ExtractDefect),
) -> Result<(), Failed> {
    // Of objects with the same id, the first is kept; this is reported as for areas.
    let OutlineObjects { known, counts, members, unread, defects, held_bytes, .. } = objects;
    sink.begin();
    defects.tell(on_defect)?;
    let objects = counts.iter().sum();
    let mut summary = LineSummary { objects, unread, ..LineSummary::default() };
    let givers = line_objects(reading, known, counts, held_bytes)?;
    make_lines(reading, (members, givers), located, &mut summary, (sink, on_defect))?;
    sink.end(summary);
    Ok(())
}
