//! Builds and delivers lines from ways and from the relations that contain them.

use std::{io, iter};

use corniche_geom::{LatticePoint, split_at_seam};
use corniche_layers::AttributeValue;
use corniche_store::take_record;

use super::{
    layer_line::{LayerLine, LineSummary},
    line_objects::line_objects,
};
use crate::{
    ExtractDefect,
    ahead::Ahead,
    failed::Failed,
    layer_sink::LayerSink,
    location::{Location, MISSING, OUT_OF_RANGE, degrees},
    losses::LineLoss,
    outlines::{
        found::OutlineObjects,
        located_ways::{LocatedWay, LocatedWays},
        records::MemberRecord,
    },
    reading::ExtractReading,
};

/// The number of ways between two progress reports.
const WAYS_TO_TELL: u64 = 1 << 10;

/// Delivers the lines of a layer and their defects in the order of the ways. Members and ways
/// arrive in the order of way ids.
pub(crate) fn hand_out_lines<'a>(
    reading: &'a ExtractReading<'a>,
    (objects, mut located): (OutlineObjects<'a>, LocatedWays<'a>),
    sink: &mut dyn LayerSink<LayerLine, LineSummary>,
    on_defect: &mut dyn FnMut(ExtractDefect),
) -> Result<(), Failed> {
    // Of objects with the same id, the first is kept; this is reported as for areas.
    let OutlineObjects { known, counts, mut members, unread, defects, held_bytes, .. } = objects;
    sink.begin();
    defects.tell(on_defect)?;
    let objects = counts.iter().sum();
    let mut summary = LineSummary { objects, unread, ..LineSummary::default() };
    let mut objects = line_objects(reading, known, counts, held_bytes)?;
    let records =
        Ahead::new(iter::from_fn(|| members.next(take_record::<MemberRecord>).transpose()));
    let mut members = Members { records, objects: Vec::new() };
    let (mut count, all) = (0, located.count);
    while let Some(way_id) = members.next_way()? {
        reading.check_stop_at(count)?;
        if count.is_multiple_of(WAYS_TO_TELL) {
            // Relations also reference ways that are not in the file.
            sink.reached(count.min(all), all);
        }
        count += 1;
        let given = objects.class_and_values(way_id, &members.objects)?;
        let Some((class, values)) = given else { continue };
        summary.ways += 1;
        let made = match located.find(way_id)? {
            Some(way) => parts_of(reading, way, (class, &values)).inspect(|_| {
                tell_gaps(way, on_defect);
            }),
            None => Err(LineLoss::MissingWay),
        };
        match made {
            Ok(parts) => {
                *summary.kept.entry(class).or_default() += 1;
                for part in parts {
                    sink.take(part);
                }
            }
            Err(loss) => {
                *summary.lost.entry(loss).or_default() += 1;
                on_defect(ExtractDefect::LostLine { way_id, loss });
            }
        }
    }
    sink.reached(all, all);
    sink.end(summary);
    Ok(())
}

/// The members of all objects by way.
struct Members<I: Iterator> {
    records: Ahead<I>,
    /// The objects of the way that was read last.
    objects: Vec<u64>,
}

impl<I: Iterator<Item = io::Result<MemberRecord>>> Members<I> {
    /// Returns the next way.
    fn next_way(&mut self) -> io::Result<Option<i64>> {
        let Self { records, objects } = self;
        let mut way: Option<i64> = None;
        objects.clear();
        while let Some(record) = records.peek()? {
            let way_id = record.member.way_id;
            if *way.get_or_insert(way_id) != way_id {
                break;
            }
            objects.push(record.object_number);
            records.take();
        }
        Ok(way)
    }
}

/// Reports the nodes at which a kept way is cut.
fn tell_gaps(way: &LocatedWay, on_defect: &mut dyn FnMut(ExtractDefect)) {
    let way_id = way.way_id;
    let count = |wanted: Location| {
        let found = way.places.iter().filter(|&&place| place == wanted).count();
        u32::try_from(found).unwrap_or(u32::MAX)
    };
    let [missing, out_of_range] = [MISSING, OUT_OF_RANGE].map(count);
    for (points, defect) in [
        (missing, ExtractDefect::MissingNodes { way_id, points: missing }),
        (out_of_range, ExtractDefect::OutOfRange { way_id, points: out_of_range }),
    ] {
        if points > 0 {
            on_defect(defect);
        }
    }
}

/// Returns the parts of a way that have positions.
fn parts_of(
    reading: &ExtractReading<'_>,
    way: &LocatedWay,
    (class, values): (u8, &[Option<AttributeValue>]),
) -> Result<Vec<LayerLine>, LineLoss> {
    let valid_deg = || way.places.iter().map(|&place| degrees(place));
    let positions_deg: Vec<[f64; 2]> = valid_deg().map(Option::unwrap_or_default).collect();
    let placed = (reading.request.place)(&positions_deg);
    let points: Vec<Option<(LatticePoint, bool)>> = placed
        .into_iter()
        .zip(valid_deg())
        .zip(&way.is_shared)
        .map(|((point, valid_deg), &is_shared)| Some((valid_deg.and(point)?, is_shared)))
        .collect();
    let parts: Vec<LayerLine> = points
        .split(Option::is_none)
        .flat_map(|run| {
            split_at_seam(run.iter().flatten().copied().collect(), reading.request.seam)
        })
        .filter_map(part)
        .map(|(points, fixed)| LayerLine {
            way_id: way.way_id,
            structure: way.structure,
            class,
            values: values.to_vec(),
            points,
            fixed,
        })
        .collect();
    if !parts.is_empty() {
        return Ok(parts);
    }
    let valid = valid_deg().flatten().count();
    Err(if way.places.contains(&MISSING) {
        LineLoss::MissingNodes
    } else if valid < way.places.len() || valid < 2 {
        LineLoss::OutOfRange
    } else {
        LineLoss::OutsideProjection
    })
}

/// Returns the points of a part, and the indices of those that are fixed.
fn part(run: Vec<(LatticePoint, bool)>) -> Option<(Vec<LatticePoint>, Vec<u32>)> {
    let mut points: Vec<(LatticePoint, bool)> = Vec::new();
    for (at, is_shared) in run {
        match points.last_mut() {
            Some((last, was_shared)) if *last == at => *was_shared |= is_shared,
            _ => points.push((at, is_shared)),
        }
    }
    if points.len() < 2 {
        return None;
    }
    let last = points.len() - 1;
    let is_fixed = |&index: &usize| points[index].1 || index == 0 || index == last;
    let fixed = (0..points.len()).filter(is_fixed).map(|index| index as u32).collect();
    Some((points.into_iter().map(|(at, _)| at).collect(), fixed))
}
