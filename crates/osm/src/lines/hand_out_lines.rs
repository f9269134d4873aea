//! Lines of a layer and what is wrong with them are handed out in order of their ways.

use corniche_areas::ClassedLayer;
use corniche_store::take_record;

use super::{
    classed_line::ClassedLine,
    line_names::LineNames,
    make_lines::{NO_CLASS, make_lines},
    summary::LineSummary,
};
use crate::{
    Defect,
    failed::Failed,
    layer_sink::{LayerSink, NamesSink},
    looked::check_held,
    outlines::{found::OutlineObjects, located_ways::LocatedWays, records::ObjectRecord},
    reading::Reading,
};

/// Hands out the lines of a layer, what is wrong with them, and, where they are wanted, the names of what they bound.
pub(crate) fn hand_out_lines<'a>(
    reading: &Reading<'a>,
    layer: ClassedLayer,
    (objects, located): (OutlineObjects<'a>, LocatedWays<'a>),
    (sink, on_defect): (&mut dyn LayerSink<ClassedLine, LineSummary>, &mut dyn FnMut(Defect)),
    on_name: Option<&mut NamesSink<'_>>,
) -> Result<(), Failed> {
    // Of objects with one id the first stays, which is told as for areas.
    let OutlineObjects { mut known, count, members, defects, held_bytes, .. } = objects;
    sink.begin();
    defects.tell(on_defect)?;
    check_held(reading, held_bytes + count)?;
    let mut classes = Vec::with_capacity(count as usize);
    let mut names = on_name.map(|on_name| LineNames { objects: Vec::new(), on_name });
    while let Some(object) = known.next(take_record::<ObjectRecord>)? {
        classes.push(object.class.unwrap_or(NO_CLASS));
        if let Some(names) = &mut names {
            names.objects.push((object.object, object.class, object.name));
        }
    }
    let mut summary = LineSummary { objects: count, ..LineSummary::default() };
    let all = (members, classes.as_slice());
    make_lines(reading, layer, all, located, &mut summary, (sink, on_defect), names)?;
    sink.end(summary);
    Ok(())
}
