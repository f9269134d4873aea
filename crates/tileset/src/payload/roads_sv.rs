//! The SV roads section: plan lines, and how high the ground is along each segment.

use corniche_drape::SvLine;
use corniche_geom::LatticePoint;

use crate::limits::MAX_POINTS;
use crate::payload::class_table::{self, Heads};
use crate::payload::damage::Damage;
use crate::payload::number_codes::{Cursor, unzigzag};
use crate::payload::points::decode_points;
use crate::payload::tile_payload::SvRoad;

/// Heights stay below this many quanta, where f64 knows every whole number.
const REACH_Q: f64 = (1_u64 << 53) as f64;

pub(crate) fn decode(
    bytes: &[u8],
    corner: LatticePoint,
    quantum_m: f64,
) -> Result<Vec<SvRoad>, Damage> {
    let mut cursor = Cursor::new(bytes);
    let mut roads = Vec::new();
    let mut room = MAX_POINTS;
    for (class, lines, blob) in class_table::decode(&mut cursor)? {
        let mut blob = Cursor::new(blob);
        let heads = Heads::decode(&mut blob, lines, &mut room)?;
        if heads.heads.iter().any(|head| head.points < 2 || head.flags != 0) {
            return Err(Damage::Invalid { what: "a line of fewer than two points" });
        }
        let points = decode_points(&mut blob, &heads, corner)?;
        let segments = heads.points - heads.heads.len();
        let (lows, spans) = (blob.planes(segments)?, blob.planes(segments)?);
        blob.finish()?;
        let mut low_q = 0_i64;
        let mut ranges = Vec::with_capacity(segments);
        for (low, span) in lows.iter().zip(spans.iter()) {
            low_q = low_q.wrapping_add(unzigzag(low));
            let high_q = low_q.checked_add_unsigned(span).filter(|&high| (high as f64) < REACH_Q);
            let high_q = high_q.filter(|_| low_q as f64 > -REACH_Q);
            let high_q = high_q.ok_or(Damage::Invalid { what: "a height range" })?;
            ranges.push([low_q as f64 * quantum_m, high_q as f64 * quantum_m]);
        }
        let (mut points, mut ranges) = (points.as_slice(), ranges.as_slice());
        for head in &heads.heads {
            let of_line = points.split_at_checked(head.points).ok_or(Damage::TooShort)?;
            let of_segments = ranges.split_at_checked(head.points - 1).ok_or(Damage::TooShort)?;
            (points, ranges) = (of_line.1, of_segments.1);
            let line =
                SvLine { points: of_line.0.to_vec(), ground_range_m: of_segments.0.to_vec() };
            roads.push(SvRoad { way_id: head.way_id, part: head.part, class, line });
        }
    }
    cursor.finish()?;
    Ok(roads)
}

#[cfg(feature = "write")]
pub(crate) use write::encode;

#[cfg(feature = "write")]
mod write {
    use corniche_roads::FunctionalRoadClass;

    use super::{LatticePoint, MAX_POINTS, REACH_Q, SvRoad, class_table};
    use crate::payload::{
        class_table::Head,
        number_codes::{put_planes, zigzag},
        points::put_points,
    };

    /// The section's bytes and how many of them each class takes, or what of the roads cannot be encoded.
    pub(crate) fn encode(
        roads: &[SvRoad],
        corner: LatticePoint,
        quantum_m: f64,
    ) -> Result<(Vec<u8>, [u64; FunctionalRoadClass::COUNT]), &'static str> {
        if roads.iter().map(|road| road.line.points.len()).sum::<usize>() > MAX_POINTS {
            return Err("more than four million points");
        }
        class_table::encode(
            roads,
            |road| (road.class, road.way_id, road.part),
            |of_class, out| {
                let mut heads = Vec::with_capacity(of_class.len());
                let mut points = Vec::new();
                let (mut lows, mut spans) = (Vec::new(), Vec::new());
                let mut previous = 0;
                for SvRoad { way_id, part, line, .. } in of_class {
                    if line.points.len() < 2
                        || line.points.windows(2).any(|pair| pair[0] == pair[1])
                    {
                        return Err("a line without length");
                    }
                    if line.ground_range_m.len() != line.points.len() - 1 {
                        return Err("ground ranges that are not one for each segment");
                    }
                    heads.push(Head {
                        way_id: *way_id,
                        part: *part,
                        points: line.points.len(),
                        flags: 0,
                    });
                    points.extend(&line.points);
                    for &[low_m, high_m] in &line.ground_range_m {
                        // Outwards; a quantum is a power of two, so dividing by it loses nothing.
                        let (low, high) =
                            ((low_m / quantum_m).floor(), (high_m / quantum_m).ceil());
                        if !(low.abs() < REACH_Q && high.abs() < REACH_Q && low <= high) {
                            return Err("a ground range that is none");
                        }
                        let (low, high) = (low as i64, high as i64);
                        lows.push(zigzag(low - previous));
                        spans.push((high - low) as u64);
                        previous = low;
                    }
                }
                class_table::put_heads(out, &heads);
                put_points(out, &points, corner)?;
                put_planes(out, &lows);
                put_planes(out, &spans);
                Ok(())
            },
        )
    }
}
