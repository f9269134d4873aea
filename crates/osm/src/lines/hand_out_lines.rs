//! Delivers the lines of boundaries and their defects in the order of the ways.

use corniche_store::take_record;

use super::{
    classed_line::ClassedLine,
    line_names::NamedObjects,
    make_lines::{NO_CLASS, make_lines},
    summary::LineSummary,
};
use crate::{
    ExtractDefect,
    failed::Failed,
    layer_sink::{LayerSink, NamesSink},
    looked::check_held,
    outlines::{found::OutlineObjects, located_ways::LocatedWays, records::ObjectRecord},
    reading::ExtractReading,
};

/// Delivers the lines of boundaries, their defects and, if requested, the names of the bounded
/// objects.
pub(crate) fn hand_out_lines<'a>(
    reading: &ExtractReading<'a>,
    (objects, located): (OutlineObjects<'a>, LocatedWays<'a>),
    (sink, on_defect): (
        &mut dyn LayerSink<ClassedLine, LineSummary>,
        &mut dyn FnMut(ExtractDefect),
    ),
    on_name: Option<&mut NamesSink<'_>>,
) -> Result<(), Failed> {
    // Of objects with the same id, the first is kept; this is reported as for areas.
    let OutlineObjects { mut known, count, members, defects, held_bytes, .. } = objects;
    sink.begin();
    defects.tell(on_defect)?;
    check_held(reading, held_bytes + count)?;
    let mut classes = Vec::with_capacity(count as usize);
    let mut names = on_name.map(|on_name| NamedObjects { objects: Vec::new(), on_name });
    while let Some(object) = known.next(take_record::<ObjectRecord>)? {
        classes.push(object.class.unwrap_or(NO_CLASS));
        if let Some(names) = &mut names {
            names.objects.push((object.object, object.class, object.name));
        }
    }
    let mut summary = LineSummary { objects: count, ..LineSummary::default() };
    let all = (members, classes.as_slice());
    make_lines(reading, all, located, &mut summary, (sink, on_defect), names)?;
    sink.end(summary);
    Ok(())
}
