//! What of the line between two tiles an area covers on both sides of it.
//!
//! Where an area goes on beyond the line, both tiles cover the same of it. Where its outline runs along the line, the area is on one side alone,
//! and only the tile on that side covers it:
//!
//! ```text
//!    tile in the west │ tile in the east
//!    ─────────────────┤ ◄─ a corner of the outline, on the lattice of the level
//!          area       │                           │  covered by one tile alone: the outline
//!                     ├──────────────             :  covered by both
//!                     :
//!                     :     area
//!    ─────────────────┴──────────────
//!                     ▲
//!                     the outline crosses the line, anywhere
//! ```
//!
//! On coarse levels outlines often run there, because points of their lattice lie on the lines. Where a tile lacks a part of an area, its neighbour
//! covers the line alone, too. The ends tell which it is: an outline that runs along the line has corners there, on the lattice of the level,
//! and where it crosses the line that is so by chance only.

use std::collections::BTreeMap;

use corniche_areas::AreaObject;
use corniche_geom::{GridFrame, LatticeBounds, LatticePoint, TileId};
use corniche_spec::points_step::points_step;
use corniche_tileset::AreaRecord;

/// A piece of a line: the coordinates of its ends along it, the smaller one first.
pub(crate) type Stretch = [i64; 2];

/// On which side of a tile its neighbour is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Beside {
    /// The border to the next tile in the east.
    East,
    /// The border to the next tile in the south.
    South,
}

impl Beside {
    /// The tile beyond the border.
    #[must_use]
    pub fn neighbour(self, tile: TileId) -> Option<TileId> {
        match self {
            Self::East => tile.neighbour(1, 0),
            Self::South => tile.neighbour(0, 1),
        }
    }
}

/// The line between a tile and its neighbour.
#[derive(Debug, Clone, Copy)]
pub struct Seam {
    beside: Beside,
    /// The coordinate that all of its points have.
    at: i64,
    /// The line from end to end.
    whole: Stretch,
    /// The spacing of the corners of outlines on this level.
    step: i64,
    /// Between which coordinates along the line there are areas, if bounds were asked for.
    clip: Option<Stretch>,
}

impl Seam {
    /// The two sides of a border.
    #[must_use]
    pub fn new(
        frame: &GridFrame,
        tile: TileId,
        beside: Beside,
        clip: Option<LatticeBounds>,
    ) -> Self {
        let bounds = frame.tile_lattice_bounds(tile);
        let along = |LatticeBounds { min, max }: LatticeBounds| match beside {
            Beside::East => [min.v, max.v],
            Beside::South => [min.u, max.u],
        };
        let at = match beside {
            Beside::East => bounds.max.u,
            Beside::South => bounds.min.v,
        };
        let step = points_step(frame, tile.z());
        Self { beside, at, whole: along(bounds), step, clip: clip.map(along) }
    }

    /// What each object covers of the line: stretches that do not touch, in order.
    #[must_use]
    pub fn covered(&self, areas: &[AreaRecord]) -> BTreeMap<AreaObject, Vec<Stretch>> {
        let mut covered: BTreeMap<AreaObject, Vec<Stretch>> = BTreeMap::new();
        for area in areas {
            for ring in area.rings() {
                let next = ring.iter().cycle().skip(1);
                for (&a, &b) in ring.iter().zip(next) {
                    if let (Some(a), Some(b)) = (self.along(a), self.along(b)) {
                        covered.entry(area.object).or_default().push([a.min(b), a.max(b)]);
                    }
                }
            }
        }
        for own in covered.values_mut() {
            own.sort_unstable();
            own.dedup_by(|later, piece| {
                let touches = later[0] <= piece[1];
                if touches {
                    piece[1] = piece[1].max(later[1]);
                }
                touches
            });
        }
        covered
    }

    /// Where along the line a point lies; `None` beside it.
    fn along(&self, point: LatticePoint) -> Option<i64> {
        match self.beside {
            Beside::East => (point.u == self.at).then_some(point.v),
            Beside::South => (point.v == self.at).then_some(point.u),
        }
    }

    /// The stretches that one tile alone covers although no outline can run along them.
    ///
    /// One that ends where the line does is not asked for a corner there: the outline may run on, along the next line. A whole line without any
    /// corner is always told, because it is what a tile leaves that lies inside an area and lacks it.
    #[must_use]
    pub fn broken(&self, covered: [&[Stretch]; 2]) -> Vec<Stretch> {
        let [one, other] = covered;
        let mut alone = without(one, other);
        alone.extend(without(other, one));
        alone.retain(|&stretch| !self.can_be_outline(stretch));
        alone
    }

    fn can_be_outline(&self, stretch: Stretch) -> bool {
        let is_corner = |place: i64| {
            place % self.step == 0 || self.clip.is_some_and(|clip| clip.contains(&place))
        };
        let is_end = |place: i64| self.whole.contains(&place);
        self.at % self.step == 0
            && stretch != self.whole
            && stretch.into_iter().all(|place| is_end(place) || is_corner(place))
    }
}

/// What is left of stretches without others. Both are in order, and those of each do not touch.
fn without(stretches: &[Stretch], mut others: &[Stretch]) -> Vec<Stretch> {
    let mut left = Vec::new();
    for &[mut from, to] in stretches {
        let past = others.iter().take_while(|[_, end]| *end <= from).count();
        others = &others[past..];
        for &[begin, end] in others.iter().take_while(|[begin, _]| *begin < to) {
            if from < begin {
                left.push([from, begin]);
            }
            from = end;
        }
        if from < to {
            left.push([from, to]);
        }
    }
    left
}

#[cfg(test)]
#[path = "area_seams_tests.rs"]
mod tests;
