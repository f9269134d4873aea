//! Builds lines from ways and from the relations that contain them.

use std::{io, iter};

use corniche_geom::{LatticePoint, split_at_seam};
use corniche_layers::AttributeValue;
use corniche_store::take_record;

use super::{layer_line::LayerLine, line_objects::LineObjects, summary::LineSummary};
use crate::{
    ExtractDefect,
    ahead::Ahead,
    failed::Failed,
    layer_sink::LayerSink,
    line_loss::LineLoss,
    location,
    outlines::{
        located_ways::{LocatedWay, LocatedWays},
        records::{MemberRecord, ObjectRecord, degrees_of, to_point},
    },
    reading::ExtractReading,
    spool::SpoolReader,
};

/// The number of ways between two progress reports.
const WAYS_TO_TELL: u64 = 1 << 10;

/// Builds the lines. Members and ways arrive in the order of way ids.
pub(crate) fn make_lines(
    reading: &ExtractReading<'_>,
    (mut members, mut objects): (
        SpoolReader<'_>,
        LineObjects<'_, impl Iterator<Item = io::Result<ObjectRecord>>>,
    ),
    mut located: LocatedWays<'_>,
    summary: &mut LineSummary,
    (sink, on_defect): (&mut dyn LayerSink<LayerLine, LineSummary>, &mut dyn FnMut(ExtractDefect)),
) -> Result<(), Failed> {
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
    let count = |wanted: location::Location| {
        let found = way.places.iter().filter(|&&place| place == wanted).count();
        u32::try_from(found).unwrap_or(u32::MAX)
    };
    match count(location::MISSING) {
        0 => {}
        points => on_defect(ExtractDefect::MissingNodes { way_id, points }),
    }
    match count(location::OUT_OF_RANGE) {
        0 => {}
        points => on_defect(ExtractDefect::OutOfRange { way_id, points }),
    }
}

/// Returns the parts of a way that have positions.
fn parts_of(
    reading: &ExtractReading<'_>,
    way: &LocatedWay,
    (class, values): (u8, &[Option<AttributeValue>]),
) -> Result<Vec<LayerLine>, LineLoss> {
    let is_missing = |place: &location::Location| *place == location::MISSING;
    let is_valid =
        |place: &location::Location| !is_missing(place) && *place != location::OUT_OF_RANGE;
    let positions_deg: Vec<[f64; 2]> = way
        .places
        .iter()
        .map(|&place| if is_valid(&place) { degrees_of(to_point(place)) } else { [0.0; 2] })
        .collect();
    let placed = (reading.request.place)(&positions_deg);
    let points: Vec<Option<(LatticePoint, bool)>> = placed
        .into_iter()
        .zip(&way.places)
        .zip(&way.is_shared)
        .map(|((point, place), &is_shared)| {
            point.filter(|_| is_valid(place)).map(|at| (at, is_shared))
        })
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
    let valid = way.places.iter().filter(|place| is_valid(place)).count();
    Err(if way.places.iter().any(is_missing) {
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
    let fixed = points.iter().enumerate().filter_map(|(index, (_, is_shared))| {
        (*is_shared || index == 0 || index == last).then_some(index as u32)
    });
    let fixed = fixed.collect();
    Some((points.into_iter().map(|(at, _)| at).collect(), fixed))
}
