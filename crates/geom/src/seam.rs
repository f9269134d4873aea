//! The seam of a map of the earth: lines go the shorter way around, and are cut where the map ends.

use crate::{GridFrame, LatticePoint, along};

/// The rounding error of computations with coordinates, in turns.
const ROUNDING: f64 = 1e-12;

/// The seam at which a map is cut open whose first coordinate repeats after a full turn around the
/// earth: half a turn from its centre, on both sides.
///
/// ```text
///   west            middle            east        A line from p to q is shorter over the seam than through the middle. It is
///    │─ q               ·               p ─│      cut there: its first part ends at the east, its second begins at the west.
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seam {
    middle: f64,
    turn: f64,
    /// Positions this near to an end count as being on it: positions that are rounded to a lattice
    /// are rounded differently at the two ends.
    rounding: f64,
}

/// A position on a map with a seam.
pub trait OnSeamedMap: Copy {
    /// The first coordinate.
    fn x(&self) -> f64;
    /// Returns the same position with another first coordinate.
    #[must_use]
    fn with_x(self, x: f64) -> Self;
    /// Returns the position on the line to another position at a fraction of its length. Its first
    /// coordinate has no meaning.
    #[must_use]
    fn towards(self, other: Self, share: f64) -> Self;
    /// Whether both positions are equal in plan.
    fn is_at(&self, other: &Self) -> bool;
}

impl Seam {
    /// Returns the seam of a map around a centre; `turn` is a full turn in the same unit, of either
    /// sign.
    #[must_use]
    pub fn new(middle: f64, turn: f64) -> Self {
        Self { middle, turn: turn.abs(), rounding: 0.0 }
    }

    /// Returns the seam of degrees from −180 to 180.
    #[must_use]
    pub fn of_degrees() -> Self {
        Self::new(0.0, 360.0)
    }

    /// The length of a full turn.
    #[must_use]
    pub fn turn(&self) -> f64 {
        self.turn
    }

    /// The western and the eastern end of the map.
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        [self.middle - self.turn / 2.0, self.middle + self.turn / 2.0]
    }

    /// Returns the seam of the same map around another centre.
    #[must_use]
    pub fn around(self, middle: f64) -> Self {
        Self { middle, ..self }
    }

    /// Converts a seam in working metres to a seam on a package's lattice: a turn is a whole number
    /// of steps, and so are its ends.
    #[must_use]
    pub fn on_lattice(&self, frame: &GridFrame) -> Self {
        let [_, east] = self.ends();
        let east = frame.fraction_of_position([east, 0.0])[0].round();
        let turn = (self.turn / frame.lattice_step_m()).round();
        Self { middle: east - turn / 2.0, turn, rounding: 1.0 }
    }

    /// The image of a coordinate on this map. A coordinate half a turn from the centre (or more by
    /// a rounding error) does not change: both ways around are equally long.
    #[must_use]
    pub fn image(&self, x: f64) -> f64 {
        let away = x - self.middle;
        if away.abs() <= self.turn * (0.5 + ROUNDING) {
            x
        } else {
            x - self.turn * (away / self.turn).round()
        }
    }

    /// The image of a coordinate between the ends of the map; the eastern end is mapped to the
    /// western one.
    #[must_use]
    pub fn image_from_west(&self, x: f64) -> f64 {
        let [west, _] = self.ends();
        x - self.turn * ((x - west) / self.turn).floor()
    }

    /// The number of whole turns between an object with the centre `x` and the centre of the map; 0
    /// at half a turn (or more by a rounding error).
    #[must_use]
    pub fn turns(&self, x: f64) -> f64 {
        let turns = (x - self.middle) / self.turn;
        if turns.abs() <= 0.5 + 1e-9 { 0.0 } else { turns.round() }
    }

    /// Makes a sequence of positions continuous: each position is moved next to the one before it,
    /// the first next to the centre of the map. Undefined positions (NaN) do not change.
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

    /// Whether the shorter way between two positions of the map crosses the seam.
    #[must_use]
    pub fn parts<P: OnSeamedMap>(&self, from: &P, to: &P) -> bool {
        (to.x() - from.x()).abs() > self.turn / 2.0
    }

    /// Cuts a line through positions of the map at the seam: returns its parts, each of at least
    /// two positions. A line that does not meet the seam is returned unchanged.
    ///
    /// A cut is at the same height on both ends of the map, whatever the direction of the line. A
    /// line that ends at the seam ends there only once.
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

    /// Moves a position onto an end of the map if it is there except for rounding; other positions
    /// do not change.
    fn onto_end<P: OnSeamedMap>(&self, place: P) -> P {
        let is_near = |end: &f64| (place.x() - end).abs() <= self.rounding;
        self.ends().into_iter().find(is_near).map_or(place, |end| place.with_x(end))
    }

    /// The cut of a line over the seam: the position on the side of `from`, and the position on the
    /// side of `to`.
    fn cut<P: OnSeamedMap>(&self, from: P, to: P) -> [P; 2] {
        let goes_east = from.x() > to.x();
        let [high, low] = if goes_east { [from, to] } else { [to, from] };
        let [west, east] = self.ends();
        // Rounding can move a position slightly beyond the end.
        let [before, behind] = [east - high.x(), low.x() - west].map(|along| along.max(0.0));
        let at = if before + behind > 0.0 {
            high.towards(low, before / (before + behind))
        } else {
            // The line runs along the seam; cut it on its own side.
            to
        };
        let [first, second] = if goes_east { [east, west] } else { [west, east] };
        [at.with_x(first), at.with_x(second)]
    }
}

/// Cuts a line at the seam of a map, if the map has one.
#[must_use]
pub fn split_at_seam<P: OnSeamedMap>(line: Vec<P>, seam: Option<Seam>) -> Vec<Vec<P>> {
    match seam {
        Some(seam) => seam.split(line),
        None => vec![line],
    }
}

/// Adds a position unless the line is there already.
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

/// A point of a line, and whether it must stay in the line, as a cut must.
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

/// A position with other values that change linearly along a line, for example its height.
impl<const N: usize> OnSeamedMap for [f64; N] {
    fn x(&self) -> f64 {
        self[0]
    }

    fn with_x(mut self, x: f64) -> Self {
        self[0] = x;
        self
    }

    fn towards(self, other: Self, share: f64) -> Self {
        along(self, other, share)
    }

    fn is_at(&self, other: &Self) -> bool {
        self[..2.min(N)] == other[..2.min(N)]
    }
}

#[cfg(test)]
#[path = "seam_tests.rs"]
mod tests;
