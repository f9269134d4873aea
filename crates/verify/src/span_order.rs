//! The height order of bridges that cross bridges, and of tunnels that cross tunnels.

use std::{
    collections::BTreeMap,
    ops::Bound::{Excluded, Included},
};

use corniche_geom::{LatticePoint, StepBudget, TooMuchWork};
use corniche_spans::SpanKind;

use super::near_index::NearIndex;

/// The points of runs are rounded to the lattice, so a run that ends on another one may end this
/// many steps beyond it.
const ROUNDING_STEPS: f64 = 2.0;
/// The work for a stored crossing, in steps: it takes memory, too.
const STEPS_OF_A_CROSSING: usize = 64;

/// A straight piece of a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RunPiece {
    pub way_id: i64,
    pub kind: SpanKind,
    /// OSM's `layer`, which orders the piece among pieces of its kind.
    pub layer: i8,
    pub ends: [LatticePoint; 2],
    /// Whether the run ends at the first and at the second end of the piece.
    pub is_end: [bool; 2],
    pub heights_m: [f64; 2],
}

/// Two runs of one kind and of different layers that cross.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct OrderedCrossing {
    /// The two ways; the way with the upper layer is the first.
    pub way_ids: [i64; 2],
    /// The height of the first above the second, in metres.
    pub free_m: f64,
}

/// The crossings of pieces of the same kind and of different layers. Pieces that share a point are
/// joined there and do not cross; runs that end on one another do not cross either.
///
/// # Errors
/// When more pieces overlap than in any real tile.
pub(crate) fn crossings(
    pieces: &[RunPiece],
    work: &StepBudget,
) -> Result<Vec<OrderedCrossing>, TooMuchWork> {
    // Pieces of one layer have no order. Therefore a way that crosses itself is never compared with
    // itself.
    let mut layers: BTreeMap<(SpanKind, i8), Vec<&RunPiece>> = BTreeMap::new();
    for piece in pieces {
        layers.entry((piece.kind, piece.layer)).or_default().push(piece);
    }
    let mut found = Vec::new();
    for (&(kind, layer), below) in &layers {
        let above = layers.range((Excluded((kind, layer)), Included((kind, i8::MAX))));
        let above: Vec<&RunPiece> = above.flat_map(|(_, of_layer)| of_layer).copied().collect();
        if above.is_empty() {
            continue;
        }
        work.add(above.len());
        let near = NearIndex::new(below.iter().map(|piece| piece.line()));
        for upper in above {
            work.add(1);
            work.check()?;
            for number in near.near(upper.line(), 0.0, work) {
                work.check()?;
                if let Some(crossing) = upper.crossing(below[number]) {
                    work.add(STEPS_OF_A_CROSSING);
                    found.push(crossing);
                }
            }
        }
    }
    Ok(found)
}

impl RunPiece {
    fn line(&self) -> [[f64; 2]; 2] {
        self.ends.map(LatticePoint::in_steps)
    }

    /// The crossing with a piece of a lower layer.
    fn crossing(&self, other: &Self) -> Option<OrderedCrossing> {
        if self.ends.iter().any(|end| other.ends.contains(end)) {
            return None;
        }
        let [[a, b], [c, d]] = [self.line(), other.line()];
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
        let [upper_m, lower_m] = [(self, shares[0]), (other, shares[1])]
            .map(|(of, share)| height_m(of.heights_m, share));
        Some(OrderedCrossing { way_ids: [self.way_id, other.way_id], free_m: upper_m - lower_m })
    }
}

#[cfg(test)]
#[path = "span_order_tests.rs"]
mod tests;
