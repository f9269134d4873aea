//! Areas and what is wrong with them are handed out in order of their objects.

use corniche_areas::Area;

use super::{hand_parts::hand_parts, make_areas::make_areas, summary::AreaSummary};
use crate::{
    AreaLoss, Defect,
    failed::Failed,
    layer_sink::LayerSink,
    outlines::{found::OutlineObjects, located_ways::LocatedWays},
    reading::Reading,
};

/// Hands out areas, and what is wrong with them.
pub(crate) fn hand_out_areas<'a>(
    reading: &Reading<'a>,
    (objects, located): (OutlineObjects<'a>, LocatedWays<'a>),
    sink: &mut dyn LayerSink<Area, AreaSummary>,
    on_defect: &mut dyn FnMut(Defect),
) -> Result<(), Failed> {
    let OutlineObjects { known, count, duplicates, members, open_ways, defects, held_bytes } =
        objects;
    sink.begin();
    defects.tell(on_defect)?;
    let all = open_ways + duplicates + count;
    let mut summary = AreaSummary { objects: all, ..AreaSummary::default() };
    for (loss, count) in [(AreaLoss::OpenWay, open_ways), (AreaLoss::Duplicate, duplicates)] {
        if count > 0 {
            summary.lost.insert(loss, count);
        }
    }
    let parts = hand_parts(reading, members, located)?.finish()?;
    make_areas(reading, (known, count), parts, held_bytes, &mut summary, sink, on_defect)?;
    sink.end(summary);
    Ok(())
}
