//! The seam of a map of the earth: lines go from place to place the shorter way around, and are cut where the map ends.

use crate::{GridFrame, LatticePoint};

/// What computing with coordinates rounds, in turns.
const ROUNDING: f64 = 1e-12;

/// Where a map is cut open whose first coordinate comes back after a full turn around the earth: half a turn from its middle, on both
/// sides.
///
/// ```text
///   west            middle            east        A line from p to q is shorter over the seam than through the middle. It is
///    │─ q               ·               p ─│      cut there: its first part ends at the east, its second begins at the west.
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seam {
    middle: f64,
    turn: f64,
    /// Places this near to an end lie on it: what is rounded to a lattice is rounded apart at the two ends.
    rounding: f64,
}

/// A place on such a map.
pub trait OnSeamedMap: Copy {
    /// Its first coordinate.
    fn x(&self) -> f64;
    /// The same place with another first coordinate.
    #[must_use]
    fn with_x(self, x: f64) -> Self;
    /// The place on the line to another one at a share of its length. Its first coordinate means nothing.
    #[must_use]
    fn towards(self, other: Self, share: f64) -> Self;
    /// Whether both lie at the same place in plan.
    fn is_at(&self, other: &Self) -> bool;
}

impl Seam {
    /// The seam of a map around a middle; `turn` is a full turn in the same unit, of either sign.
    #[must_use]
    pub fn new(middle: f64, turn: f64) -> Self {
        Self { middle, turn: turn.abs(), rounding: 0.0 }
    }

    /// The seam of degrees that are counted from −180 to 180.
    #[must_use]
    pub fn of_degrees() -> Self {
        Self::new(0.0, 360.0)
    }

    /// A full turn.
    #[must_use]
    pub fn turn(&self) -> f64 {
        self.turn
    }

    /// The western and the eastern end of the map.
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        [self.middle - self.turn / 2.0, self.middle + self.turn / 2.0]
    }

    /// The seam of the same map around another middle.
    #[must_use]
    pub fn around(self, middle: f64) -> Self {
        Self { middle, ..self }
    }

    /// A seam in working metres as one of a package's lattice: a turn is a whole number of steps, and so are its ends.
    #[must_use]
    pub fn on_lattice(&self, frame: &GridFrame) -> Self {
        let [_, east] = self.ends();
        let east = frame.fraction_of_position([east, 0.0])[0].round();
        let turn = (self.turn / frame.lattice_step_m()).round();
        Self { middle: east - turn / 2.0, turn, rounding: 1.0 }
    }

    /// The image of a coordinate on this map. Half a turn from the middle, be it a rounding more, it stays as it is: both ways around are equally long.
    #[must_use]
    pub fn image(&self, x: f64) -> f64 {
        let away = x - self.middle;
        if away.abs() <= self.turn * (0.5 + ROUNDING) {
            x
        } else {
            x - self.turn * (away / self.turn).round()
        }
    }

    /// The image of a coordinate between the ends of the map; what lies at the eastern end comes to the western one.
    #[must_use]
    pub fn image_from_west(&self, x: f64) -> f64 {
        let [west, _] = self.ends();
        x - self.turn * ((x - west) / self.turn).floor()
    }

    /// Whole turns that something as wide as its middle `x` is away from the middle of the map; none from half a turn, be it a rounding more.
    #[must_use]
    pub fn turns(&self, x: f64) -> f64 {
        let turns = (x - self.middle) / self.turn;
        if turns.abs() <= 0.5 + 1e-9 { 0.0 } else { turns.round() }
    }

    /// Makes a sequence of places continuous: each lies next to the one before it, the first next to the middle of the map. Places
    /// that are nowhere (NaN) stay.
    pub fn unroll<P: OnSeamedMap>(&self, places: &mut [P]) {
        let mut near = *self;
        for place in places.iter_mut().filter(|place| place.x().is_finite()) {
            let image = near.image(place.x());
            if image.to_bits() != place.x().to_bits() {
                *place = place.with_x(image);
            }
            near = near.around(image);
        }
    }

    /// Whether the shorter way between two places of the map leads over the seam.
    #[must_use]
    pub fn parts<P: OnSeamedMap>(&self, from: &P, to: &P) -> bool {
        (to.x() - from.x()).abs() > self.turn / 2.0
    }

    /// A line through places of the map, cut at the seam: its parts, each of two places at least. A line that does not meet the seam
    /// comes back as it is.
    ///
    /// A cut lies on both ends of the map at the same height, whichever way the line goes. A line that ends at the seam ends there once.
    #[must_use]
    pub fn split<P: OnSeamedMap>(&self, line: Vec<P>) -> Vec<Vec<P>> {
        if !line.array_windows().any(|[from, to]| self.parts(from, to)) {
            return vec![line];
        }
        let mut lines = Vec::new();
        let mut part: Vec<P> = Vec::new();
        for place in line.into_iter().map(|place| self.onto_end(place)) {
            if let Some(&before) = part.last()
                && self.parts(&before, &place)
            {
                let [here, beyond] = self.cut(before, place);
                push(&mut part, here);
                lines.push(std::mem::replace(&mut part, vec![beyond]));
            }
            push(&mut part, place);
        }
        lines.push(part);
        lines.retain(|part| part.len() >= 2);
        lines
    }

    /// A place on the end of the map that it is as near to as rounding goes; others stay.
    fn onto_end<P: OnSeamedMap>(&self, place: P) -> P {
        let is_near = |end: &f64| (place.x() - end).abs() <= self.rounding;
        self.ends().into_iter().find(is_near).map_or(place, |end| place.with_x(end))
    }

    /// Where a line over the seam is cut: on the side of `from`, and on that of `to`.
    fn cut<P: OnSeamedMap>(&self, from: P, to: P) -> [P; 2] {
        let goes_east = from.x() > to.x();
        let [high, low] = if goes_east { [from, to] } else { [to, from] };
        let [west, east] = self.ends();
        // Rounding can put a place a little beyond the end.
        let [before, behind] = [east - high.x(), low.x() - west].map(|along| along.max(0.0));
        let at = if before + behind > 0.0 {
            high.towards(low, before / (before + behind))
        } else {
            // Along the seam, on the side where the line is.
            to
        };
        let [first, second] = if goes_east { [east, west] } else { [west, east] };
        [at.with_x(first), at.with_x(second)]
    }
}

/// A line cut at the seam of a map, if the map has one.
#[must_use]
pub fn split_at_seam<P: OnSeamedMap>(line: Vec<P>, seam: Option<Seam>) -> Vec<Vec<P>> {
    match seam {
        Some(seam) => seam.split(line),
        None => vec![line],
    }
}

/// Adds a place unless the line is there already.
fn push<P: OnSeamedMap>(line: &mut Vec<P>, place: P) {
    if line.last().is_none_or(|last| !last.is_at(&place)) {
        line.push(place);
    }
}

impl OnSeamedMap for LatticePoint {
    fn x(&self) -> f64 {
        self.u as f64
    }

    fn with_x(self, x: f64) -> Self {
        Self { u: x.round() as i64, ..self }
    }

    fn towards(self, other: Self, share: f64) -> Self {
        let v = self.v as f64 + share * (other.v - self.v) as f64;
        Self { v: v.round() as i64, ..self }
    }

    fn is_at(&self, other: &Self) -> bool {
        self == other
    }
}

/// A point of a line and whether it must stay in it: a cut must.
impl OnSeamedMap for (LatticePoint, bool) {
    fn x(&self) -> f64 {
        self.0.x()
    }

    fn with_x(self, x: f64) -> Self {
        (self.0.with_x(x), self.1)
    }

    fn towards(self, other: Self, share: f64) -> Self {
        (self.0.towards(other.0, share), true)
    }

    fn is_at(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}

/// A position and what else changes evenly along a line, such as its height.
impl<const N: usize> OnSeamedMap for [f64; N] {
    fn x(&self) -> f64 {
        self[0]
    }

    fn with_x(mut self, x: f64) -> Self {
        self[0] = x;
        self
    }

    fn towards(self, other: Self, share: f64) -> Self {
        std::array::from_fn(|axis| self[axis] + share * (other[axis] - self[axis]))
    }

    fn is_at(&self, other: &Self) -> bool {
        self[..2.min(N)] == other[..2.min(N)]
    }
}

#[cfg(test)]
#[path = "seam_tests.rs"]
mod tests;
