//! Builds areas from objects and the ways of their outlines.

use std::{collections::HashSet, io};

use corniche_areas::{AssembledArea, Coastline, OutlineError, OutlineWay, Polygon, assemble};
use corniche_geom::{LatticePoint, split_at_seam};
use corniche_layers::OsmObject;
use corniche_store::{Sorted, take_record};
use rayon::prelude::*;

use super::{
    layer_area::{AreaSummary, LayerArea},
    over_seam,
};
use crate::{
    AreaLoss, ExtractDefect,
    ahead::Ahead,
    failed::Failed,
    layer_sink::LayerSink,
    looked::check_held,
    outlines::records::{ObjectRecord, OutlineWayRecord, degrees_of, take_values, to_point},
    read_request::LatticePlacement,
    reading::ExtractReading,
    spool::SpoolReader,
};

/// The number of objects that each thread builds in parallel, …
const OBJECTS_PER_THREAD: usize = 512;
/// … if they have no more points than this.
const POINTS_PER_THREAD: usize = 1 << 16;

/// Delivers areas in the order of their objects.
pub(crate) fn make_areas(
    reading: &ExtractReading<'_>,
    (mut known, objects_count): (SpoolReader<'_>, u64),
    parts: Sorted<'_, OutlineWayRecord>,
    mut held_bytes: u64,
    summary: &mut AreaSummary,
    sink: &mut dyn LayerSink<LayerArea, AreaSummary>,
    on_defect: &mut dyn FnMut(ExtractDefect),
) -> Result<(), Failed> {
    let pool = reading.request.pool;
    let threads = pool.current_num_threads();
    let mut all_parts = Ahead::new(parts);
    let mut number = 0;
    loop {
        reading.check_stop()?;
        let mut batch = Vec::new();
        let mut points = 0;
        while batch.len() < threads * OBJECTS_PER_THREAD && points < threads * POINTS_PER_THREAD {
            let next = known.next(take_record)?;
            let Some(known) = next else { break };
            let parts = parts_of(&mut all_parts, number)?;
            points +=
                parts.iter().flat_map(OutlineWayRecord::points).map(<[_]>::len).sum::<usize>();
            batch.push((known, parts));
            number += 1;
        }
        if batch.is_empty() {
            return Ok(());
        }
        let placing = reading.request.placing();
        let made: Vec<MadeArea> = pool.install(|| {
            batch.into_par_iter().map(|(known, parts)| make(known, &parts, placing)).collect()
        });
        for made in made {
            made.defects.into_iter().for_each(&mut *on_defect);
            for coastline in made.coastlines {
                held_bytes += (size_of_val(&*coastline.points) + size_of::<Coastline>()) as u64;
                check_held(reading, held_bytes)?;
                summary.coastlines.push(coastline);
            }
            match made.area {
                Ok(Some(mut area)) => {
                    area.values = take_values(&made.values)?;
                    count(summary, &area);
                    sink.take(area);
                }
                // A coastline alone is not an area.
                Ok(None) => summary.objects -= 1,
                Err(loss) => *summary.lost.entry(loss).or_default() += 1,
            }
        }
        sink.reached(number, objects_count);
    }
}

fn parts_of(
    parts: &mut Ahead<Sorted<'_, OutlineWayRecord>>,
    number: u64,
) -> io::Result<Vec<OutlineWayRecord>> {
    let mut own = Vec::new();
    while parts.peek()?.is_some_and(|part| part.object_number == number) {
        own.extend(parts.take_next());
    }
    Ok(own)
}

fn count(summary: &mut AreaSummary, area: &LayerArea) {
    let kept = summary.kept.entry(area.class).or_default();
    kept.areas += 1;
    kept.polygons += area.polygons.len() as u64;
    let rings = area.polygons.iter().flat_map(Polygon::rings);
    kept.points += rings.map(|ring| ring.points().len() as u64).sum::<u64>();
    kept.area_m2 += area.area_m2;
}

/// The result of building one object.
struct MadeArea {
    /// The area without its values.
    area: Result<Option<LayerArea>, AreaLoss>,
    /// The values as bytes.
    values: Box<[u8]>,
    coastlines: Vec<Coastline>,
    defects: Vec<ExtractDefect>,
}

fn make(
    known: ObjectRecord,
    parts: &[OutlineWayRecord],
    placing: LatticePlacement<'_>,
) -> MadeArea {
    let object = known.object;
    let mut defects = Vec::new();
    let lines =
        if known.is_coastline { coastlines(object.id(), parts, placing) } else { Ok(Vec::new()) };
    let area = match (known.class, &lines) {
        (Some(class), _) => try_making((object, class), parts, placing, &mut defects).map(Some),
        (None, &Err(loss)) => Err(loss),
        (None, Ok(_)) => Ok(None),
    };
    if let Err(loss) = area {
        defects.push(ExtractDefect::LostArea { object, loss });
    }
    let coastlines = lines.unwrap_or_default();
    MadeArea { area, values: known.values, coastlines, defects }
}

/// Returns the lines of a way on the package's lattice: several if points between them cannot be
/// converted, or if the way crosses the seam of the map.
fn coastlines(
    way_id: i64,
    parts: &[OutlineWayRecord],
    placing: LatticePlacement<'_>,
) -> Result<Vec<Coastline>, AreaLoss> {
    let mut lines = Vec::new();
    for part in parts {
        let positions_deg: Vec<[f64; 2]> =
            part.points()?.iter().copied().map(to_point).map(degrees_of).collect();
        let placed = (placing.place)(&positions_deg);
        let runs = placed
            .split(Option::is_none)
            .flat_map(|run| split_at_seam(run.iter().flatten().copied().collect(), placing.seam));
        let runs = runs.map(|points| Coastline { way_id, points });
        lines.extend(runs.filter(|line| line.points.len() >= 2));
    }
    if lines.is_empty() { Err(AreaLoss::OutsideProjection) } else { Ok(lines) }
}

fn try_making(
    (object, class): (OsmObject, u8),
    parts: &[OutlineWayRecord],
    placing: LatticePlacement<'_>,
    defects: &mut Vec<ExtractDefect>,
) -> Result<LayerArea, AreaLoss> {
    let mut missing = 0;
    let mut ways: Vec<LocatedOutlineWay> = Vec::new();
    for part in parts {
        let is_inner = part.member.is_inner;
        match part.points() {
            Ok(points) => {
                let points = points.iter().copied().map(to_point).collect();
                ways.push(LocatedOutlineWay { points, is_inner });
            }
            Err(AreaLoss::MissingWays) => missing += 1,
            Err(loss) => return Err(loss),
        }
    }
    over_seam::join(&mut ways.iter_mut().map(|way| &mut way.points).collect::<Vec<_>>());
    let outline: Vec<OutlineWay<'_>> =
        ways.iter().map(|way| OutlineWay { points: &way.points }).collect();
    let mut assembled = assemble(&outline).map_err(|error| match error {
        OutlineError::Open { .. } | OutlineError::Nothing if missing > 0 => AreaLoss::MissingWays,
        OutlineError::Open { .. } => AreaLoss::OpenOutline,
        OutlineError::Nothing => AreaLoss::NoOutline,
        OutlineError::Crossing { .. } => AreaLoss::CrossingOutline,
        _ => AreaLoss::TooIntricate,
    })?;
    if missing > 0 {
        leave_out_holes(&mut assembled, &ways);
        if assembled.polygons.is_empty() {
            return Err(AreaLoss::MissingWays);
        }
    }
    let area_m2 = assembled.polygons.iter().map(|polygon| area_m2(polygon, placing)).sum();
    let mut polygons = Vec::with_capacity(assembled.polygons.len());
    for polygon in &assembled.polygons {
        polygons.extend(over_seam::placed(polygon, placing)?);
    }
    if let (OsmObject::Relation(relation_id), true) = (object, missing > 0) {
        defects.push(ExtractDefect::MissingWays { relation_id, ways: missing });
    }
    let mended = assembled.repeated_segments + assembled.divided_segments;
    if mended > 0 {
        let segments = u32::try_from(mended).unwrap_or(u32::MAX);
        defects.push(ExtractDefect::MendedOutline { object, segments });
    }
    Ok(LayerArea { object, class, values: Vec::new(), polygons, area_m2 })
}

/// A way of an outline that is in the file.
struct LocatedOutlineWay {
    points: Vec<LatticePoint>,
    is_inner: bool,
}

/// Removes polygons that only ways with the role `inner` surround: if the way around such a hole is
/// missing, the hole would be mistaken for an area. Roles are used only here.
fn leave_out_holes(assembled: &mut AssembledArea, ways: &[LocatedOutlineWay]) {
    let in_order = |[a, b]: [LatticePoint; 2]| [a.min(b), a.max(b)];
    let outer: HashSet<[LatticePoint; 2]> = ways
        .iter()
        .filter(|way| !way.is_inner)
        .flat_map(|way| way.points.array_windows().copied().map(in_order))
        .collect();
    assembled.polygons.retain(|polygon| {
        polygon.outer().segments().map(in_order).any(|segment| outer.contains(&segment))
    });
}

/// Returns the true area, in square metres, of a polygon whose points are in units of 1e-7 degrees.
fn area_m2(polygon: &Polygon, placing: LatticePlacement<'_>) -> f64 {
    let of_ring = |points: &[LatticePoint]| {
        let ring_deg: Vec<[f64; 2]> = points.iter().copied().map(degrees_of).collect();
        (placing.ring_area_m2)(&ring_deg)
    };
    polygon.rings().map(|ring| of_ring(ring.points())).sum()
}
