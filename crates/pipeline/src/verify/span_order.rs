//! Which is above where bridges cross bridges, and tunnels tunnels.

use corniche_geom::{LatticePoint, TooMuchWork, Work};
use corniche_spans::SpanKind;

/// Points of runs are rounded to the lattice. So a run that ends on another one may end so many steps beyond it.
const ROUNDING_STEPS: f64 = 2.0;
/// A crossing that is kept counts for so many steps of work: it takes memory, too.
const STEPS_OF_A_CROSSING: usize = 64;

/// A straight piece of a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Piece {
    pub(crate) way_id: i64,
    pub(crate) kind: SpanKind,
    /// OSM's `layer`, which orders it among its kind.
    pub(crate) layer: i8,
    pub(crate) ends: [LatticePoint; 2],
    /// Whether the run ends there.
    pub(crate) is_end: [bool; 2],
    pub(crate) heights_m: [f64; 2],
}

/// Two runs of one kind and of different layers that cross.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct OrderedCrossing {
    /// The ways, that of the upper layer first.
    pub(crate) way_ids: [i64; 2],
    /// How far the first is above the second, metres.
    pub(crate) free_m: f64,
}

/// Where pieces of the same kind and of different layers cross. Pieces that share a point are joined there, and do not cross, nor do runs that end on one another.
///
/// # Errors
/// When more of them lie over each other than in any real tile.
pub(crate) fn crossings(
    mut pieces: Vec<Piece>,
    work: &Work,
) -> Result<Vec<OrderedCrossing>, TooMuchWork> {
    let us = |piece: &Piece| {
        let [a, b] = piece.ends.map(|end| end.u);
        [a.min(b), a.max(b)]
    };
    pieces.sort_by_key(|piece| (us(piece)[0], piece.way_id));
    let mut found = Vec::new();
    for (number, one) in pieces.iter().enumerate() {
        let last_u = us(one)[1];
        let near = pieces[number + 1..].iter().take_while(|other| us(other)[0] <= last_u);
        for other in near {
            work.add(1);
            work.check()?;
            if one.kind == other.kind
                && one.layer != other.layer
                && let Some(crossing) = one.crossing(other)
            {
                work.add(STEPS_OF_A_CROSSING);
                found.push(crossing);
            }
        }
    }
    Ok(found)
}

impl Piece {
    fn crossing(&self, other: &Self) -> Option<OrderedCrossing> {
        if self.ends.iter().any(|end| other.ends.contains(end)) {
            return None;
        }
        let [a, b] = self.ends.map(LatticePoint::in_steps);
        let [c, d] = other.ends.map(LatticePoint::in_steps);
        let across = |[p, q]: [[f64; 2]; 2], r: [f64; 2]| {
            (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        };
        let share = |line: [[f64; 2]; 2], [from, to]: [[f64; 2]; 2]| {
            let [of_from, of_to] = [across(line, from), across(line, to)];
            // A line that passes through a point of another one crosses it once.
            ((of_from < 0.0) != (of_to < 0.0)).then(|| of_from / (of_from - of_to))
        };
        let ends_on = |of: &Self, line: [[f64; 2]; 2]| {
            let length = (line[1][0] - line[0][0]).hypot(line[1][1] - line[0][1]);
            let is_on = |end: [f64; 2]| across(line, end).abs() <= ROUNDING_STEPS * length;
            of.is_end.iter().zip(of.ends).any(|(is_end, at)| *is_end && is_on(at.in_steps()))
        };
        if ends_on(self, [c, d]) || ends_on(other, [a, b]) {
            return None;
        }
        let shares = [share([c, d], [a, b])?, share([a, b], [c, d])?];
        let height_m = |[from_m, to_m]: [f64; 2], share: f64| from_m + share * (to_m - from_m);
        let both = [(self, shares[0]), (other, shares[1])];
        let [upper, lower] = if self.layer > other.layer { both } else { [both[1], both[0]] };
        let [upper_m, lower_m] = [upper, lower].map(|(of, share)| height_m(of.heights_m, share));
        let way_ids = [upper.0.way_id, lower.0.way_id];
        Some(OrderedCrossing { way_ids, free_m: upper_m - lower_m })
    }
}

#[cfg(test)]
#[path = "span_order_tests.rs"]
mod tests;
