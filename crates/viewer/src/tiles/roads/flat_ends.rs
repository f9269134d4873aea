//! Ends of roads without a round cap, because the road continues as another one.

use std::collections::BTreeMap;

use corniche_geom::Bounds;
use corniche_roads::FunctionalRoadClass;

use super::{RoadKind, RoadLook};

/// A road continues in a line that turns by at most 30°.
const LEAST_COSINE: f64 = 0.866;

/// The first and the last segment of a line, each towards the line's end; `None` where the line was
/// cut.
///
/// ```text
///      first[1] ◄── first[0] ─── … ─── last[0] ──► last[1]
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LineEnds {
    /// Drawing order: larger values are drawn above, in the order of the labels (`gpu/labels.rs`);
    /// within a class, narrower roads are below.
    height: [u8; 3],
    pub(crate) first: Option<[[f64; 2]; 2]>,
    pub(crate) last: Option<[[f64; 2]; 2]>,
}

impl LineEnds {
    /// The ends of a road on the ground.
    pub(crate) fn of_road(
        RoadKind { class, look, .. }: RoadKind,
        [first, last]: [Option<[[f64; 2]; 2]>; 2],
    ) -> Self {
        let layer = match look {
            tunnel if tunnel.is_tunnel() => 0,
            RoadLook::Service => 1,
            _ => 2,
        };
        let rank = FunctionalRoadClass::COUNT as u8 - class.number();
        let narrow = match look {
            RoadLook::Link => 0,
            RoadLook::Carriageway | RoadLook::CarriagewayTunnel | RoadLook::CarriagewayBore => 1,
            _ => 2,
        };
        Self { height: [layer, rank, narrow], first, last }
    }

    /// The ends of a deck. No road on the ground has a cap below it, so it counts as below all
    /// roads.
    pub(crate) fn of_deck([first, last]: [[[f64; 2]; 2]; 2]) -> Self {
        Self { height: [0; 3], first: Some(first), last: Some(last) }
    }

    /// The end points and the directions beyond them.
    pub(crate) fn outward(&self) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
        let ends = [self.first, self.last].into_iter().flatten();
        ends.filter_map(|[from, to]| Some((to, direction([from, to])?)))
    }
}

/// For each line: whether it is flat at its first and at its last point.
///
/// ```text
///       round                    flat
///   ━━━━━━━━━━━╮             ━━━━━━━━━━━┓            Where two classes of one road meet, the cap of the more important
///    primary   ├────────      primary   ┃───────     one would lie on the other. So it ends flat. The cap of the less
///   ━━━━━━━━━━━╯             ━━━━━━━━━━━┛            important one stays: it fills the gap that a bend leaves.
/// ```
///
/// An end is flat if a line that is drawn below it begins there and continues in nearly the same
/// direction, and no other line that is drawn as high ends there. Only ends inside the tile count:
/// there, both methods know all lines.
pub(crate) fn flat_ends(lines: &[LineEnds], tile: Bounds) -> Vec<[bool; 2]> {
    let mut at_point: BTreeMap<[u64; 2], Vec<End>> = BTreeMap::new();
    let ends = lines.iter().enumerate().flat_map(|(number, line)| {
        let height = line.height;
        [line.first, line.last].into_iter().enumerate().filter_map(move |(which, segment_m)| {
            let [from, to] = segment_m?;
            let outward = direction([from, to])?;
            is_inside(tile, to)
                .then_some((to.map(f64::to_bits), End { number, which, height, outward }))
        })
    });
    for (point, end) in ends {
        at_point.entry(point).or_default().push(end);
    }
    let mut flat = vec![[false; 2]; lines.len()];
    for ends in at_point.values() {
        // At most one end at a point is above all others: only this end is compared with each.
        let Some(end) = ends.iter().max_by_key(|end| end.height) else { continue };
        let others =
            || ends.iter().filter(|other| (other.number, other.which) != (end.number, end.which));
        let is_highest = others().all(|other| other.height < end.height);
        flat[end.number][end.which] = is_highest && others().any(|other| end.goes_on_in(other));
    }
    flat
}

/// Whether a point is in a rectangle and not on its border.
pub(crate) fn is_inside(Bounds { min_x, min_y, max_x, max_y }: Bounds, [x, y]: [f64; 2]) -> bool {
    min_x < x && x < max_x && min_y < y && y < max_y
}

/// The end of a line at a point.
struct End {
    /// The index of the line, and which of its ends it is.
    number: usize,
    which: usize,
    height: [u8; 3],
    /// The direction beyond the end.
    outward: [f64; 2],
}

impl End {
    fn goes_on_in(&self, other: &Self) -> bool {
        let [[x, y], [other_x, other_y]] = [self.outward, other.outward];
        -(x * other_x + y * other_y) >= LEAST_COSINE
    }
}

/// The unit vector along a segment; `None` if it has no length.
pub(crate) fn direction([[x, y], [to_x, to_y]]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
    let (dx, dy) = (to_x - x, to_y - y);
    let length_m = libm::hypot(dx, dy);
    (length_m > 0.0).then_some([dx / length_m, dy / length_m])
}

#[cfg(test)]
#[path = "flat_ends_tests.rs"]
mod tests;
