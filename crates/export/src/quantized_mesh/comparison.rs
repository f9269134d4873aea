//! Compares a tile's triangles with the ground: finds places that are too far from it, and measures
//! the final deviation.

use std::collections::BTreeSet;

use corniche_geom::wgs84::{ECCENTRICITY_2, SEMI_MAJOR_M};

use super::{
    facets::{Facets, OUTSIDE},
    ground::Bends,
    mesh::{Mesh, MeshDeviation},
    raster::{GroundSample, nearest_steps},
    tiling::{LAST_STEP, Square, is_in_tile},
};
use crate::{
    bounds::clip,
    globe::{between, dot, geocentric_m, unit},
    plane::along,
};

/// A place of the ground, rounded to a 2²⁴th of the tile to save memory.
#[derive(Clone, Copy)]
pub(crate) struct Point {
    /// In steps; outside the tile below 0 or above [`LAST_STEP`].
    uv: [f32; 2],
    /// The position relative to the middle of the tile, in axes parallel to the earth's.
    from_middle_m: [f32; 3],
}

/// The coordinate frame of a tile's points.
#[derive(Clone, Copy)]
pub(crate) struct PointFrame {
    square: Square,
    /// The middle of the tile, from the earth's centre.
    middle_m: [f64; 3],
}

impl PointFrame {
    pub(crate) fn new(square: Square) -> Self {
        let [lon, lat] = square.place_deg([f64::from(LAST_STEP) / 2.0; 2]);
        Self { square, middle_m: geocentric_m([lon, lat, 0.0]) }
    }

    /// Returns the point at a longitude and latitude, with its height.
    pub(crate) fn point(&self, place: [f64; 3]) -> Point {
        let [lon, lat, _] = place;
        Point {
            uv: self.square.uv_of([lon, lat]).map(|step| step as f32),
            from_middle_m: self.position_m(place).map(|axis| axis as f32),
        }
    }

    /// Returns the position of a longitude, latitude and height, relative to the middle.
    fn position_m(&self, place: [f64; 3]) -> [f64; 3] {
        between(self.middle_m, geocentric_m(place))
    }
}

impl Point {
    fn uv(&self) -> [f64; 2] {
        self.uv.map(f64::from)
    }

    fn at_m(&self) -> [f64; 3] {
        self.from_middle_m.map(f64::from)
    }

    pub(crate) fn is_in_tile(&self) -> bool {
        is_in_tile(self.uv())
    }
}

/// A place where the triangles are too far from the ground.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TooFar {
    off_m: f64,
    /// In steps.
    pub(crate) uv: [f64; 2],
    /// The number of the point, if it is one; otherwise a triangle edge of the ground crosses one
    /// of the tile's there.
    pub(crate) point: Option<usize>,
}

/// The ground of a tile, with the triangles with which it was last compared.
///
/// Between vertices and triangle edges both surfaces are flat, so their largest distance is at a
/// vertex of either, or at a crossing of edges:
///
/// ```text
///         ●──────────────●        ● vertex of the triangles, which is on the ground
///        / \    ┆       /         ○ vertex of the ground
///       /   \ ┆        /          ┆ edge of the ground; it is compared where it crosses an edge of the triangles, too
///      /  ○┄┄┄╳       /
///     /        \     /
///    ●──────────────●
/// ```
///
/// The distance that the globe's curvature adds between these is measured at the nodes of the
/// raster, which are points, too.
pub(crate) struct Comparison {
    frame: PointFrame,
    points: Vec<Point>,
    /// Edges between points.
    edges: Vec<[u32; 2]>,
    /// The triangle that contains each point; [`OUTSIDE`] for points to ignore.
    faces: Vec<u32>,
    facets: Facets,
    /// Whether the points of a triangle must be checked again.
    is_due: Vec<bool>,
    /// Steps of reported crossings that are vertices already, or that are off the ground.
    settled: BTreeSet<[u16; 2]>,
}

impl Comparison {
    pub(crate) fn new(frame: PointFrame, bends: Bends<Point>, mesh: &Mesh) -> Self {
        Self::with_facets(frame, bends, mesh.facets(frame.middle_m))
    }

    fn with_facets(frame: PointFrame, bends: Bends<Point>, facets: Facets) -> Self {
        let Bends { points, edges } = bends;
        let mut hint = OUTSIDE;
        let faces = points
            .iter()
            .map(|point| {
                if !point.is_in_tile() {
                    return OUTSIDE;
                }
                hint = facets.locate(hint, point.uv());
                hint
            })
            .collect();
        let is_due = vec![true; facets.len()];
        Self { frame, points, edges, faces, facets, is_due, settled: BTreeSet::new() }
    }

    /// Takes over the triangles after vertices were added.
    pub(crate) fn update(&mut self, mesh: &Mesh) {
        let facets = mesh.facets(self.frame.middle_m);
        let has_changed: Vec<bool> =
            (0..facets.len()).map(|face| !facets.is_as_in(&self.facets, face)).collect();
        for (face, point) in self.faces.iter_mut().zip(&self.points) {
            if *face != OUTSIDE && has_changed[*face as usize] {
                *face = facets.locate(*face, point.uv());
            }
        }
        self.is_due.resize(facets.len(), true);
        for (is_due, has_changed) in self.is_due.iter_mut().zip(has_changed) {
            *is_due |= has_changed;
        }
        self.facets = facets;
    }

    /// Returns the farthest point of each triangle that is farther from it than `limit_m`.
    /// Triangles without one are not checked again before they change.
    pub(crate) fn far_points(&mut self, limit_m: f64) -> Vec<TooFar> {
        let mut worst = vec![None; self.facets.len()];
        for (k, (&face, point)) in self.faces.iter().zip(&self.points).enumerate() {
            if face != OUTSIDE && self.is_due[face as usize] && is_inside(point.uv()) {
                let off_m = self.off_m(face, point.uv(), point.at_m());
                note(&mut worst[face as usize], limit_m, off_m, point.uv(), Some(k));
            }
        }
        self.is_due = worst.iter().map(Option::is_some).collect();
        worst.into_iter().flatten().collect()
    }

    /// Returns, for each triangle, the farthest crossing at which an edge of the ground leaves it,
    /// if it is farther than `limit_m`. No steps are reported twice: there is a vertex by then, or
    /// none is possible.
    pub(crate) fn far_crossings(&mut self, limit_m: f64) -> Vec<TooFar> {
        let mut worst = vec![None; self.facets.len()];
        self.for_each_crossing(|face, uv, from_middle_m| {
            if is_inside(uv) {
                let off_m = self.off_m(face, uv, from_middle_m);
                if off_m > limit_m && !self.settled.contains(&nearest_steps(uv)) {
                    note(&mut worst[face as usize], limit_m, off_m, uv, None);
                }
            }
        });
        // Several triangles that meet at a place report it.
        let far = worst.into_iter().flatten();
        far.filter(|far| self.settled.insert(nearest_steps(far.uv))).collect()
    }

    /// Replaces a point by the place at the steps to which it is rounded. If there is no ground
    /// there, the point is ignored from now on. The difference matters where the ground is steep or
    /// ends.
    pub(crate) fn round(&mut self, point: usize, place: Option<[f64; 3]>) {
        if let Some(place) = place {
            self.points[point] = self.frame.point(place);
            self.faces[point] = self.facets.locate(self.faces[point], self.points[point].uv());
        } else {
            self.faces[point] = OUTSIDE;
        }
    }

    /// Returns the distances of the triangles from the ground at all points, at crossings of edges,
    /// and at samples on borders. Places farther than `limit_m` are checked again at the steps to
    /// which they are rounded, where `at_steps` returns the ground. Without `is_finest`, edges are
    /// not those of the finest ground, so all crossings are checked again.
    pub(crate) fn deviation<'s, E>(
        &self,
        on_borders: impl Iterator<Item = &'s GroundSample>,
        limit_m: f64,
        is_finest: bool,
        at_steps: impl FnOnce(&[[f64; 2]]) -> Result<Vec<Option<[f64; 3]>>, E>,
    ) -> Result<MeshDeviation, E> {
        let mut found = MeshDeviation::default();
        let mut again: Vec<(u32, [f64; 2])> = Vec::new();
        for (&face, point) in self.faces.iter().zip(&self.points) {
            if face != OUTSIDE {
                let off_m = self.off_m(face, point.uv(), point.at_m());
                if off_m > limit_m {
                    again.push((face, point.uv()));
                } else {
                    found.note(off_m);
                }
            }
        }
        let mut hint = OUTSIDE;
        for sample in on_borders {
            let uv = sample.steps.map(f64::from);
            hint = self.facets.locate(hint, uv);
            if hint != OUTSIDE {
                found.note(self.off_m(hint, uv, between(self.frame.middle_m, sample.at_m)));
            }
        }
        self.for_each_crossing(|face, uv, from_middle_m| {
            let off_m = self.off_m(face, uv, from_middle_m);
            if !is_finest || off_m > limit_m {
                again.push((face, uv));
            } else {
                found.note(off_m);
            }
        });
        let uv: Vec<[f64; 2]> = again.iter().map(|(_, uv)| *uv).collect();
        for ((face, _), place) in again.into_iter().zip(at_steps(&uv)?) {
            let Some(place) = place else { continue };
            let [lon, lat, _] = place;
            let uv = self.frame.square.uv_of([lon, lat]);
            let face = self.facets.locate(face, uv);
            if face != OUTSIDE {
                found.note(self.off_m(face, uv, self.frame.position_m(place)));
            }
        }
        Ok(found)
    }

    /// Calls `tell` for each place where an edge of the ground leaves a triangle, with the
    /// triangle, u and v, and the position relative to the middle. An edge is bent like the globe:
    /// its height over its chord, at shares a and b of its length from the ends, is length² · a · b
    /// / (2 · radius).
    fn for_each_crossing(&self, mut tell: impl FnMut(u32, [f64; 2], [f64; 3])) {
        let mut hint = OUTSIDE;
        for &edge in &self.edges {
            let mut ends = edge.map(|point| point as usize);
            let mut faces = ends.map(|end| self.faces[end]);
            if faces[0] == OUTSIDE {
                ends.reverse();
                faces.reverse();
            }
            if faces[0] == faces[1] && faces[0] != OUTSIDE {
                continue;
            }
            let points = ends.map(|end| &self.points[end]);
            let [from, to] = points.map(Point::uv);
            let ends_m = points.map(Point::at_m);
            let chord_m = between(ends_m[0], ends_m[1]);
            let bulge_m = dot(chord_m, chord_m) / (2.0 * SEMI_MAJOR_M);
            let up = self.up_at(ends_m[0]);
            let mut begin = 0.0;
            if faces[0] == OUTSIDE {
                let Some(share) = share_at_entry([from, to]) else { continue };
                begin = share;
                faces[0] = self.facets.locate(hint, along(from, to, begin));
                if faces[0] == OUTSIDE {
                    continue;
                }
            }
            hint = faces[0];
            let line = [along(from, to, begin), to];
            self.facets.for_each_crossing(faces[0], line, |face, share| {
                let share = begin + (1.0 - begin) * share;
                let over_m = bulge_m * share * (1.0 - share);
                let on_chord_m = along(ends_m[0], ends_m[1], share);
                let position_m = [0, 1, 2].map(|axis| on_chord_m[axis] + over_m * up[axis]);
                tell(face, along(from, to, share), position_m);
            });
        }
    }

    /// Returns the distance of a triangle from a place of the ground.
    fn off_m(&self, face: u32, uv: [f64; 2], from_middle_m: [f64; 3]) -> f64 {
        let up = self.up_at(from_middle_m);
        self.facets.above_m(face, uv, from_middle_m, up).abs()
    }

    fn up_at(&self, from_middle_m: [f64; 3]) -> [f64; 3] {
        let middle_m = self.frame.middle_m;
        up_from([0, 1, 2].map(|axis| middle_m[axis] + from_middle_m[axis]))
    }
}

/// Keeps the place if it is farther from its triangle than all previous ones.
fn note(worst: &mut Option<TooFar>, limit_m: f64, off_m: f64, uv: [f64; 2], point: Option<usize>) {
    if off_m > worst.as_ref().map_or(limit_m, |known| known.off_m) {
        *worst = Some(TooFar { off_m, uv, point });
    }
}

/// Whether a place is not on a border after rounding to steps.
fn is_inside(uv: [f64; 2]) -> bool {
    uv.iter().all(|step| (0.5..f64::from(LAST_STEP) - 0.5).contains(step))
}

/// Returns the share of the way at which a line enters the tile.
///
/// Source: Liang & Barsky 1984, *A New Concept and Method for Line Clipping*.
fn share_at_entry([from, to]: [[f64; 2]; 2]) -> Option<f64> {
    clip(from, to, [[0.0, f64::from(LAST_STEP)]; 2]).map(|[begin, _]| begin)
}

/// Returns the upward direction at a position near the ellipsoid.
///
/// On the ellipsoid the direction is that of (x, y, z / (1 − e²)). At a height h, its error is at
/// most h · e² / (2 · radius): 10⁻⁵ at 9 km.
fn up_from([x, y, z]: [f64; 3]) -> [f64; 3] {
    unit([x, y, z / (1.0 - ECCENTRICITY_2)])
}

#[cfg(test)]
#[path = "comparison_tests.rs"]
mod tests;
