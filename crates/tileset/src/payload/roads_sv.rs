//! The SV roads section: lines in plan, and the height range of the ground along each segment. (SV
//! roads are drawn by shadow volumes.)

mod ground_ranges;

use corniche_drape::SvLine;
use corniche_geom::{GridFrame, LatticePoint};
use corniche_roads::FunctionalRoadClass;
use corniche_varints::zigzag;

use crate::{
    limits::MAX_POINTS,
    payload::{
        class_table::{ClassBlob, Heads, LineHead, LineOrder},
        coded_lines::{LineCoder, for_each_class},
        damage::{Damage, Result},
        number_codes::Cursor,
        points::decode_points,
        range_coder::BitReader,
        roads_sv::ground_ranges::RangeCoder,
        tile_payload::SvRoad,
    },
};

/// Heights stay below this many quanta, so that every whole number is exact as f64.
const REACH_Q: f64 = (1_u64 << 53) as f64;

/// Decodes a section; if its lines are range-coded bits, `coded_in` is the package's frame.
pub(crate) fn decode(
    bytes: &[u8],
    coded_in: Option<&GridFrame>,
    corner: LatticePoint,
    quantum_m: f64,
) -> Result<Vec<SvRoad>> {
    let mut section = Section { quantum_m, points: MAX_POINTS, roads: Vec::new() };
    for_each_class(bytes, coded_in, corner, |of_class, coder| match coder {
        Some(coder) => section.add_coded(of_class, coder),
        None => section.add(of_class, corner),
    })?;
    Ok(section.roads)
}

/// A section while it is read.
struct Section {
    quantum_m: f64,
    /// The number of points that the section may still have.
    points: usize,
    roads: Vec<SvRoad>,
}

impl Section {
    /// Adds the lines of a class.
    fn add(&mut self, (class, lines, blob): ClassBlob<'_>, corner: LatticePoint) -> Result<()> {
        let mut blob = Cursor::new(blob);
        let heads = Heads::decode(&mut blob, lines, &mut self.points)?;
        heads.heads.iter().try_for_each(check_head)?;
        let points = decode_points(&mut blob, heads.point_counts(), corner)?;
        let segments = heads.points - heads.heads.len();
        let [lows, spans] = blob.columns(segments)?;
        blob.finish()?;
        let mut low_q = 0_i64;
        let mut ranges = Vec::with_capacity(segments);
        for (low, span) in lows.iter().zip(spans.iter()) {
            low_q = low_q.wrapping_add(zigzag(low));
            ranges.push(range_m(low_q, span, self.quantum_m)?);
        }
        let (mut points, mut ranges) = (points.as_slice(), ranges.as_slice());
        for head in &heads.heads {
            let of_line = points.split_at_checked(head.points).ok_or(Damage::TooShort)?;
            let of_segments = ranges.split_at_checked(head.points - 1).ok_or(Damage::TooShort)?;
            (points, ranges) = (of_line.1, of_segments.1);
            self.add_line(class, head, of_line.0.to_vec(), of_segments.0.to_vec());
        }
        Ok(())
    }

    /// Adds the lines of a class from range-coded bits.
    fn add_coded(
        &mut self,
        (class, lines, blob): ClassBlob<'_>,
        mut coder: LineCoder<'_>,
    ) -> Result<()> {
        let mut bits = BitReader::new(blob);
        let mut order = LineOrder::default();
        let mut range_coder = RangeCoder::default();
        let (mut points, mut ranges_m) = (Vec::new(), Vec::new());
        let quantum_m = self.quantum_m;
        for _ in 0..lines {
            ranges_m.clear();
            let add_range = |coder: &mut LineCoder<'_>, bits: &mut BitReader<'_>, number: usize| {
                if number > 0 {
                    let (low_q, span) = range_coder.code(bits, coder.last_length(), (0, 0));
                    ranges_m.push(range_m(low_q, span, quantum_m)?);
                }
                Ok(())
            };
            let head = coder.read_line(&mut bits, &mut self.points, &mut points, add_range)?;
            check_head(&head)?;
            order.check(&head)?;
            // Lines are many and short: clones have no spare capacity.
            self.add_line(class, &head, points.clone(), ranges_m.clone());
        }
        bits.finish()
    }

    fn add_line(
        &mut self,
        class: FunctionalRoadClass,
        head: &LineHead,
        points: Vec<LatticePoint>,
        ground_range_m: Vec<[f64; 2]>,
    ) {
        let line = SvLine { points, ground_range_m };
        self.roads.push(SvRoad { way_id: head.way_id, part: head.part, class, line });
    }
}

/// Converts a ground range to metres.
fn range_m(low_q: i64, span: u64, quantum_m: f64) -> Result<[f64; 2]> {
    let high_q = low_q.checked_add_unsigned(span).filter(|&high| (high as f64) < REACH_Q);
    let high_q = high_q.filter(|_| low_q as f64 > -REACH_Q);
    let high_q = high_q.ok_or(Damage::Invalid("a height range"))?;
    Ok([low_q as f64 * quantum_m, high_q as f64 * quantum_m])
}

fn check_head(head: &LineHead) -> Result<()> {
    Damage::invalid_if(head.points < 2 || head.flags != 0, "a line of fewer than two points")?;
    Ok(())
}

#[cfg(feature = "write")]
pub(crate) use write::encode;

#[cfg(feature = "write")]
mod write {
    use corniche_roads::FunctionalRoadClass;
    use corniche_varints::to_zigzag;

    use super::{LatticePoint, LineCoder, LineHead, MAX_POINTS, REACH_Q, RangeCoder, SvRoad};
    use crate::payload::{
        class_table, damage::refuse_if, number_codes::put_planes, points::put_points,
        range_coder::BitWriter, source_grid::SourceGrid,
    };

    /// Encodes the section: returns its bytes and the number of bytes of each class, or a
    /// description of what cannot be encoded. With a grid, its lines are range-coded bits.
    pub(crate) fn encode(
        roads: &[SvRoad],
        grid: Option<SourceGrid<'_>>,
        corner: LatticePoint,
        quantum_m: f64,
    ) -> Result<(Vec<u8>, [u64; FunctionalRoadClass::COUNT]), &'static str> {
        refuse_if(
            roads.iter().map(|road| road.line.points.len()).sum::<usize>() > MAX_POINTS,
            "more than four million points",
        )?;
        class_table::encode(
            roads,
            grid,
            |road| (road.class, road.way_id, road.part),
            |of_class, out| match grid {
                Some(grid) => put_coded(out, of_class, LineCoder::new(grid, corner), quantum_m),
                None => put(out, of_class, corner, quantum_m),
            },
        )
    }

    fn put(
        out: &mut Vec<u8>,
        roads: &[SvRoad],
        corner: LatticePoint,
        quantum_m: f64,
    ) -> Result<(), &'static str> {
        let heads = roads.iter().map(head_of).collect::<Result<Vec<_>, _>>()?;
        let points: Vec<LatticePoint> =
            roads.iter().flat_map(|road| road.line.points.iter().copied()).collect();
        let (mut lows, mut spans) = (Vec::new(), Vec::new());
        let mut previous = 0;
        for range_m in roads.iter().flat_map(|road| &road.line.ground_range_m) {
            let (low, span) = range_q(*range_m, quantum_m)?;
            lows.push(to_zigzag(low - previous));
            spans.push(span);
            previous = low;
        }
        class_table::put_heads(out, &heads);
        put_points(out, &points, corner)?;
        put_planes(out, &lows);
        put_planes(out, &spans);
        Ok(())
    }

    fn put_coded(
        out: &mut Vec<u8>,
        roads: &[SvRoad],
        mut coder: LineCoder<'_>,
        quantum_m: f64,
    ) -> Result<(), &'static str> {
        let mut bits = BitWriter::new(Vec::new());
        let mut range_coder = RangeCoder::default();
        for road in roads {
            let line = &road.line;
            let ranges = line.ground_range_m.iter().map(|&range_m| range_q(range_m, quantum_m));
            let ranges = ranges.collect::<Result<Vec<_>, _>>()?;
            let mut is_exact = true;
            coder.write_line(&mut bits, head_of(road)?, &line.points, |coder, bits, number| {
                if let Some(&range) = number.checked_sub(1).and_then(|segment| ranges.get(segment))
                {
                    is_exact &= range_coder.code(bits, coder.last_length(), range) == range;
                }
            })?;
            refuse_if(!is_exact, "a height too far from the height before it")?;
        }
        out.extend(bits.finish());
        Ok(())
    }

    fn head_of(SvRoad { way_id, part, line, .. }: &SvRoad) -> Result<LineHead, &'static str> {
        refuse_if(
            line.points.len() < 2 || line.points.windows(2).any(|pair| pair[0] == pair[1]),
            "a line of zero length",
        )?;
        refuse_if(
            line.ground_range_m.len() != line.points.len() - 1,
            "a number of ground ranges that is not the number of segments",
        )?;
        Ok(LineHead { way_id: *way_id, part: *part, points: line.points.len(), flags: 0 })
    }

    /// Converts a ground range to quanta, rounded outwards: the lowest ground, and the highest
    /// minus the lowest. A quantum is a power of two, so dividing by it is exact.
    fn range_q([low_m, high_m]: [f64; 2], quantum_m: f64) -> Result<(i64, u64), &'static str> {
        let (low, high) = ((low_m / quantum_m).floor(), (high_m / quantum_m).ceil());
        refuse_if(
            !(low.abs() < REACH_Q && high.abs() < REACH_Q && low <= high),
            "an invalid ground range",
        )?;
        Ok((low as i64, (high as i64 - low as i64) as u64))
    }
}

#[cfg(all(test, feature = "write"))]
#[path = "roads_sv_tests.rs"]
mod tests;
