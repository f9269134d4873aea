//! Areas and what is wrong with them are handed out in order of their objects.

use corniche_areas::Area;

use super::{hand_parts::hand_parts, make_areas::make_areas, summary::AreaSummary};
use crate::{
    AreaLoss, Defect, ReadOsmError,
    layer_sink::LayerSink,
    outlines::{found::Outlines, located_ways::LocatedWays, number_objects::number_objects},
    reading::Reading,
};

/// Hands out areas, and what is wrong with them.
pub(crate) fn hand_out_areas<'a>(
    reading: &Reading<'a>,
    (outlines, located): (Outlines<'a>, LocatedWays<'a>),
    sink: &mut dyn LayerSink<Area, AreaSummary>,
    on_defect: &mut dyn FnMut(Defect),
) -> Result<(), ReadOsmError> {
    let failed = |error| reading.scratch_failed(error);
    let Outlines { objects, open_ways, defects, held_bytes, .. } = outlines;
    sink.begin();
    defects.tell(on_defect).map_err(failed)?;
    let objects = number_objects(reading, objects, on_defect)?;
    let all = open_ways + objects.duplicates + objects.count;
    let mut summary = AreaSummary { objects: all, ..AreaSummary::default() };
    for (loss, count) in [(AreaLoss::OpenWay, open_ways), (AreaLoss::Duplicate, objects.duplicates)]
    {
        if count > 0 {
            summary.lost.insert(loss, count);
        }
    }
    let members = objects.members.finish().map_err(failed)?;
    let parts = hand_parts(reading, members, located)?.finish().map_err(failed)?;
    let known = (objects.known.read(), objects.count);
    make_areas(reading, known, parts, held_bytes, &mut summary, sink, on_defect)?;
    sink.end(summary);
    Ok(())
}
