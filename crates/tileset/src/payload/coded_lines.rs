//! Lines of a class as range-coded bits: their heads and points, in both road sections.

use std::collections::HashMap;

use corniche_geom::{GridFrame, LatticePoint};

#[cfg(feature = "write")]
use crate::payload::range_coder::BitWriter;
use crate::{
    limits::MAX_POINTS,
    payload::{
        class_table::{self, ClassBlob, LineHead, take_points},
        damage::{Damage, Result},
        magnitudes::Magnitudes,
        number_codes::Cursor,
        point_models::PointModels,
        points::{FAR, is_near},
        range_coder::{BitReader, Bits, Model},
        source_grid::SourceGrid,
        turned_steps::length,
    },
};

/// Points of the grid are within this many steps of 0: more than once around the earth.
const REACH: i64 = 1 << 33;

/// Calls a function with the lines of each class in a road section, and with a coder if they are
/// range-coded bits; `coded_in` is the package's frame in that case.
pub(crate) fn for_each_class<'f>(
    bytes: &[u8],
    coded_in: Option<&'f GridFrame>,
    corner: LatticePoint,
    mut take: impl FnMut(ClassBlob<'_>, Option<LineCoder<'f>>) -> Result<()>,
) -> Result<()> {
    let mut cursor = Cursor::new(bytes);
    let grid = coded_in.map(|frame| SourceGrid::read(&mut cursor, frame)).transpose()?;
    for of_class in class_table::decode(&mut cursor)? {
        take(of_class, grid.map(|grid| LineCoder::new(grid, corner)))?;
    }
    cursor.finish()
}

/// The state of a coder: what it knows of the lines of a class.
pub(crate) struct LineCoder<'f> {
    grid: SourceGrid<'f>,
    corner: LatticePoint,
    way_ids: Magnitudes<1, 1>,
    parts: Magnitudes<1, 1>,
    counts: Magnitudes<1, 1>,
    flags: [Model; 2],
    models: PointModels,
    /// The different points so far, on the grid and on the lattice: roads meet at some of them.
    known: Vec<([i64; 2], LatticePoint)>,
    /// The index of each point in this list; only used by a writer.
    known_at: HashMap<LatticePoint, usize>,
    was_known: bool,
    way_id: i64,
    /// The last point, on the grid.
    at: [i64; 2],
    /// The step to the last point, if its line had one.
    before: Option<[i64; 2]>,
}

impl<'f> LineCoder<'f> {
    /// Creates the coder for the lines of one class, in a tile with this south-western corner.
    pub(crate) fn new(grid: SourceGrid<'f>, corner: LatticePoint) -> Self {
        Self {
            grid,
            corner,
            way_ids: Magnitudes::default(),
            parts: Magnitudes::default(),
            counts: Magnitudes::default(),
            flags: [Model::NEW; 2],
            models: PointModels::default(),
            known: Vec::new(),
            known_at: HashMap::new(),
            was_known: false,
            way_id: 0,
            at: [0; 2],
            before: None,
        }
    }

    /// Codes the head of the next line. A reader's head is ignored.
    pub(crate) fn code_head<B: Bits>(&mut self, bits: &mut B, head: LineHead) -> Result<LineHead> {
        let step = head.way_id.wrapping_sub(self.way_id);
        let way_id = self.way_id.wrapping_add(self.way_ids.code(bits, [0; 2], step));
        self.way_id = way_id;
        let part = self.parts.code_magnitude(bits, [0; 2], u64::from(head.part)) as u32;
        let points = self.counts.code_magnitude(bits, [0; 2], head.points as u64) as usize;
        let flag =
            |bits: &mut B, model, flag| bits.bit(model, u32::from(head.flags & flag != 0)) as u8;
        let [lead_in, lead_out] = &mut self.flags;
        let flags = flag(bits, lead_in, 1) | flag(bits, lead_out, 2) << 1;
        Damage::invalid_if(points > MAX_POINTS, "number of points")?;
        self.before = None;
        self.was_known = false;
        Ok(LineHead { way_id, part, points, flags })
    }

    /// Codes point `number` of a line. A reader passes no `asked`.
    pub(crate) fn code_point<B: Bits>(
        &mut self,
        bits: &mut B,
        number: usize,
        head: &LineHead,
        asked: Option<LatticePoint>,
    ) -> Result<LatticePoint> {
        let place = match number {
            0 => 0,
            _ if number + 1 < head.points => 1,
            _ => 2,
        };
        let asked_known = asked.and_then(|point| self.known_at.get(&point).copied());
        let context = (place, self.was_known);
        let known = self.models.code_known(bits, context, asked_known, self.known.len())?;
        self.was_known = known.is_some();
        if let Some(at) = known {
            let (to, point) = self.known[at];
            self.before = Some([to[0] - self.at[0], to[1] - self.at[1]])
                .filter(|&step| number > 0 && step != [0; 2]);
            self.at = to;
            return Ok(point);
        }
        let point = self.code_new_point(bits, number == 0, asked)?;
        if asked.is_some() {
            self.known_at.insert(point, self.known.len());
        }
        self.known.push((self.at, point));
        Ok(point)
    }

    fn code_new_point<B: Bits>(
        &mut self,
        bits: &mut B,
        is_first: bool,
        asked: Option<LatticePoint>,
    ) -> Result<LatticePoint> {
        let nearest = asked.map_or([0; 2], |point| self.grid.nearest(point));
        let step = [0, 1].map(|axis| nearest[axis].wrapping_sub(self.at[axis]));
        let step = self.models.code_step(bits, is_first, self.before, step);
        if !is_first {
            self.before = Some(step).filter(|&step| step != [0; 2]);
        }
        let to = [0, 1].map(|axis| self.at[axis] + step[axis]);
        if to.iter().any(|at| at.abs() > REACH) {
            return Err(FAR);
        }
        self.at = to;
        let on_grid = self.grid.lattice_point(to).ok_or(FAR)?;
        let off = asked.map_or([0; 2], |point| {
            [point.u.wrapping_sub(on_grid.u), point.v.wrapping_sub(on_grid.v)]
        });
        let off = if bits.bit(&mut self.models.is_beside, u32::from(off != [0; 2])) == 1 {
            let [east, north] = &mut self.models.beside;
            [east.code(bits, [0; 2], off[0]), north.code(bits, [0; 2], off[1])]
        } else {
            [0; 2]
        };
        let point = LatticePoint::new(on_grid.u + off[0], on_grid.v + off[1]);
        if is_near(point, self.corner) { Ok(point) } else { Err(FAR) }
    }

    /// Reads the head and the `points` of the next line, which are subtracted from the section's
    /// `room`; calls `after_each` after each point with its number.
    pub(crate) fn read_line(
        &mut self,
        bits: &mut BitReader<'_>,
        room: &mut usize,
        points: &mut Vec<LatticePoint>,
        mut after_each: impl FnMut(&mut Self, &mut BitReader<'_>, usize) -> Result<()>,
    ) -> Result<LineHead> {
        let head = self.code_head(bits, LineHead::default())?;
        take_points(room, head.points)?;
        bits.check_end()?;
        points.clear();
        for number in 0..head.points {
            bits.check_end()?;
            let point = self.code_point(bits, number, &head, None)?;
            Damage::invalid_if(points.last() == Some(&point), "a segment of zero length")?;
            points.push(point);
            after_each(self, bits, number)?;
        }
        Ok(head)
    }

    /// Number of binary digits of the step to the last point; 0 after the first point of a line.
    pub(crate) fn last_length(&self) -> usize {
        self.before.map_or(0, |[east, north]| length(east).max(length(north)))
    }
}

#[cfg(feature = "write")]
impl LineCoder<'_> {
    /// Writes the head and the points of the next line, and calls `after_each` after each point
    /// with its number. Fails if a number has no code: a step of 2^32 or more.
    pub(crate) fn write_line(
        &mut self,
        bits: &mut BitWriter,
        head: LineHead,
        points: &[LatticePoint],
        mut after_each: impl FnMut(&mut Self, &mut BitWriter, usize),
    ) -> Result<(), &'static str> {
        const NO_CODE: &str = "a way or a point too far from the previous one";
        if self.code_head(bits, head) != Ok(head) {
            return Err(NO_CODE);
        }
        for (number, &point) in points.iter().enumerate() {
            if self.code_point(bits, number, &head, Some(point)) != Ok(point) {
                return Err(NO_CODE);
            }
            after_each(self, bits, number);
        }
        Ok(())
    }
}

#[cfg(all(test, feature = "write"))]
#[path = "coded_lines_tests.rs"]
mod tests;
