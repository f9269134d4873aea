//! Points of rings as range-coded bits.
//!
//! Areas are adjacent: a point that two of them share is often followed by the next point that they
//! share, forwards or backwards along the ring that had it first.
//!
//! ```text
//!   ───●───●───●───       ring 1, coded before: its points i, i + 1, i + 2
//!      i  i+1 i+2
//!      ●───●───●          ring 2: i + 2 by its number, then "neighbour back", then "next"
//! ```

use std::{collections::HashMap, ops::Range};

use corniche_geom::{LatticeBounds, LatticePoint};

use crate::payload::{
    damage::{Damage, Result},
    magnitudes::Magnitudes,
    point_models::PointModels,
    range_coder::{Bits, Model},
};

/// How a point was found relative to the point before it in its ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Followed {
    /// The point before is new, or this point is the first of a ring.
    None,
    /// The point before occurred earlier and has this number.
    From(usize),
    /// The point before was found as a neighbour of its predecessor in an earlier ring: continue in
    /// the same direction.
    Along(usize, Way),
}

/// A direction along a ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    On,
    Back,
}

/// The state of a coder: what it knows of the rings of a section.
pub(crate) struct RingCoder {
    bounds: LatticeBounds,
    /// The spacing of the coarse lattice.
    step: i64,
    goes_on: Model,
    is_next: Model,
    is_previous: Model,
    models: PointModels,
    points: Vec<LatticePoint>,
    /// The number of each point's ring.
    ring_of: Vec<u32>,
    /// The points of each complete ring.
    rings: Vec<Range<usize>>,
    /// The number of each point at its first occurrence; only used by a writer.
    first_at: HashMap<LatticePoint, usize>,
    /// The last point, in steps of the coarse lattice.
    at: [i64; 2],
    before: Option<[i64; 2]>,
    followed: Followed,
}

const OUTSIDE: Damage = Damage::Invalid("a point outside the tile");

impl RingCoder {
    pub(crate) fn new(bounds: LatticeBounds, step: i64) -> Self {
        Self {
            bounds,
            step,
            goes_on: Model::NEW,
            is_next: Model::NEW,
            is_previous: Model::NEW,
            models: PointModels::default(),
            points: Vec::new(),
            ring_of: Vec::new(),
            rings: Vec::new(),
            first_at: HashMap::new(),
            at: [bounds.min.u, bounds.min.v].map(|part| part.div_euclid(step)),
            before: None,
            followed: Followed::None,
        }
    }

    /// Ends a ring: it consists of the points since the last call.
    pub(crate) fn end_ring(&mut self) {
        let from = self.rings.last().map_or(0, |ring| ring.end);
        self.rings.push(from..self.points.len());
        self.before = None;
        self.followed = Followed::None;
    }

    /// Codes the next point of a ring. A reader passes no `asked`.
    pub(crate) fn code_point<B: Bits>(
        &mut self,
        bits: &mut B,
        asked: Option<LatticePoint>,
    ) -> Result<LatticePoint> {
        let is_first = self.rings.last().map_or(0, |ring| ring.end) == self.points.len();
        let point = match self.code_beside(bits, asked) {
            Some(point) => point,
            None => self.code_known_or_new(bits, is_first, asked)?,
        };
        if !self.bounds.contains(point) {
            return Err(OUTSIDE);
        }
        let to = [point.u, point.v].map(|part| part.div_euclid(self.step));
        let step = [0, 1].map(|axis| to[axis] - self.at[axis]);
        self.before = Some(step).filter(|&step| !is_first && step != [0; 2]);
        self.at = to;
        if asked.is_some() {
            self.first_at.entry(point).or_insert(self.points.len());
        }
        self.points.push(point);
        self.ring_of.push(self.rings.len() as u32);
        Ok(point)
    }

    /// Codes a point as a neighbour of the point before it in an earlier ring, if it is one.
    fn code_beside<B: Bits>(
        &mut self,
        bits: &mut B,
        asked: Option<LatticePoint>,
    ) -> Option<LatticePoint> {
        let (number, ways) = match self.followed {
            Followed::None => return None,
            Followed::From(number) => (number, &[Way::On, Way::Back][..]),
            Followed::Along(number, Way::On) => (number, &[Way::On][..]),
            Followed::Along(number, Way::Back) => (number, &[Way::Back][..]),
        };
        for &way in ways {
            let Some(there) = self.neighbour(number, way) else { continue };
            let point = self.points[there];
            let model = match (self.followed, way) {
                (Followed::Along(..), _) => &mut self.goes_on,
                (_, Way::On) => &mut self.is_next,
                (_, Way::Back) => &mut self.is_previous,
            };
            if bits.bit(model, u32::from(asked == Some(point))) == 1 {
                self.followed = Followed::Along(there, way);
                return Some(point);
            }
        }
        None
    }

    /// Returns the number of the neighbour of a point in its ring; `None` in a ring that is not
    /// complete.
    fn neighbour(&self, number: usize, way: Way) -> Option<usize> {
        let ring = self.rings.get(self.ring_of[number] as usize)?;
        Some(match way {
            Way::On if number + 1 == ring.end => ring.start,
            Way::On => number + 1,
            Way::Back if number == ring.start => ring.end - 1,
            Way::Back => number - 1,
        })
    }

    fn code_known_or_new<B: Bits>(
        &mut self,
        bits: &mut B,
        is_first: bool,
        asked: Option<LatticePoint>,
    ) -> Result<LatticePoint> {
        let asked_known = asked.and_then(|point| self.first_at.get(&point).copied());
        let context = match self.followed {
            Followed::None => 0,
            Followed::From(_) => 1,
            Followed::Along(..) => 2,
        };
        let context = (context, is_first);
        let known = self.models.code_known(bits, context, asked_known, self.points.len())?;
        if let Some(number) = known {
            self.followed = Followed::From(number);
            return Ok(self.points[number]);
        }
        self.followed = Followed::None;
        self.code_new(bits, is_first, asked)
    }

    fn code_new<B: Bits>(
        &mut self,
        bits: &mut B,
        is_first: bool,
        asked: Option<LatticePoint>,
    ) -> Result<LatticePoint> {
        let parts = asked.map_or([0; 2], |point| [point.u, point.v]);
        let step = [0, 1].map(|axis| parts[axis].div_euclid(self.step) - self.at[axis]);
        let step = self.models.code_step(bits, is_first, self.before, step);
        let left = parts.map(|part| part.rem_euclid(self.step));
        let left = if bits.bit(&mut self.models.is_beside, u32::from(left != [0; 2])) == 1 {
            let [east, north] = &mut self.models.beside;
            let mut code = |beside: &mut Magnitudes<1, 1>, left: i64| {
                beside.code_magnitude(bits, [0; 2], left.unsigned_abs()) as i64
            };
            [code(east, left[0]), code(north, left[1])]
        } else {
            [0; 2]
        };
        let place = |axis: usize| {
            let to = self.at[axis].checked_add(step[axis])?.checked_mul(self.step)?;
            to.checked_add(left[axis])
        };
        let point = place(0).zip(place(1)).map(|(u, v)| LatticePoint::new(u, v));
        point.ok_or(OUTSIDE)
    }
}
