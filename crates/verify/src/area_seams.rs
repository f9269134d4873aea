//! Compares what an area covers of the border between two tiles on both sides of the border.
//!
//! Where an area continues across the border, both tiles cover the same part of it. Where the
//! outline of the area runs along the border, the area is on one side only, and only the tile on
//! that side covers the border:
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
//! On coarse levels outlines often run along borders, because points of their lattice lie there. If
//! a tile lacks a part of an area, only its neighbour covers the border, too. The ends of the
//! stretch show the difference: an outline that runs along the border has corners there, on the
//! lattice of the level; an outline that crosses the border meets a lattice point only by chance.

use std::collections::BTreeMap;

use corniche_geom::{GridFrame, LatticeBounds, LatticePoint, TileId};
use corniche_layers::OsmObject;
use corniche_spec::points_step::points_step;
use corniche_tileset::LayerObject;

/// A stretch of a border: the coordinates of its ends along the border, the smaller one first.
pub(crate) type SeamStretch = [i64; 2];

/// The side of a tile on which its neighbour is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Beside {
    /// The border to the next tile in the east.
    East,
    /// The border to the next tile in the south.
    South,
}

impl Beside {
    /// The tile on the other side of the border.
    #[must_use]
    pub fn neighbour(self, tile: TileId) -> Option<TileId> {
        match self {
            Self::East => tile.neighbour(1, 0),
            Self::South => tile.neighbour(0, 1),
        }
    }
}

/// The border between a tile and its neighbour.
#[derive(Debug, Clone, Copy)]
pub struct TileSeam {
    beside: Beside,
    /// The coordinate that all points of the border share.
    at: i64,
    /// The whole border, from end to end.
    whole: SeamStretch,
    /// The spacing of the corners of outlines on this level.
    step: i64,
    /// The range along the border that can have areas, if the build had bounds.
    clip: Option<SeamStretch>,
}

impl TileSeam {
    /// The border between a tile and its neighbour on the given side.
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

    /// The stretches of the border that each object covers: sorted, and without common points.
    #[must_use]
    pub fn covered(&self, areas: &[LayerObject]) -> BTreeMap<OsmObject, Vec<SeamStretch>> {
        let mut covered: BTreeMap<OsmObject, Vec<SeamStretch>> = BTreeMap::new();
        for area in areas {
            for ring in area.shape.rings() {
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

    /// The coordinate along the border of a point; `None` if the point is not on the border.
    fn along(&self, point: LatticePoint) -> Option<i64> {
        match self.beside {
            Beside::East => (point.u == self.at).then_some(point.v),
            Beside::South => (point.v == self.at).then_some(point.u),
        }
    }

    /// The stretches that only one tile covers although no outline can run along them.
    ///
    /// An end of a stretch at the end of the border needs no corner of an outline, because the
    /// outline may continue along the next border. A whole border without any corner is always
    /// reported: a tile leaves exactly this if it lies inside an area and lacks the area.
    #[must_use]
    pub fn broken(&self, covered: [&[SeamStretch]; 2]) -> Vec<SeamStretch> {
        let [one, other] = covered;
        let mut alone = without(one, other);
        alone.extend(without(other, one));
        alone.retain(|&stretch| !self.can_be_outline(stretch));
        alone
    }

    fn can_be_outline(&self, stretch: SeamStretch) -> bool {
        let is_corner = |place: i64| {
            place % self.step == 0 || self.clip.is_some_and(|clip| clip.contains(&place))
        };
        let is_end = |place: i64| self.whole.contains(&place);
        self.at % self.step == 0
            && stretch != self.whole
            && stretch.into_iter().all(|place| is_end(place) || is_corner(place))
    }
}

/// The parts of `stretches` outside of `others`. Both are sorted, and stretches of one list do not
/// touch.
fn without(stretches: &[SeamStretch], mut others: &[SeamStretch]) -> Vec<SeamStretch> {
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
