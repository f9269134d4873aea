//! The extent of the sea and areas: the intersection of the data, the bounding boxes of the
//! extracts and the requested bounds.

use corniche_areas::{OutlineError, Polygon, intersection};
use corniche_geom::{
    Bounds, GridFrame, LatticeBounds, LatticePoint, LatticeRegion, Projection, Seam, along,
};

/// Boxes in degrees are followed up to this distance around the data, as a fraction of the data's
/// size, and at least this many degrees. Farther away, a point need not have a position in the
/// working CRS.
const AROUND: f64 = 0.05;
const LEAST_AROUND_DEG: f64 = 0.01;
/// Sides of boxes that are curved in the working CRS are approximated to this many cells, …
const TOLERANCE_CELLS: f64 = 0.01;
/// … with this many segments at first, and at most.
const PIECES: std::ops::RangeInclusive<usize> = 16..=4096;
/// A side that bends by less than this, metres, is straight.
const STRAIGHT_M: f64 = 1e-6;
/// Positions computed with PROJ and rounded to the lattice may be off by this many steps.
const ROUNDING_STEPS: i64 = 2;
/// Largest coordinates of outlines that can be overlaid.
const MOST_OVERLAID: i64 = 1 << 30;

/// Polygons, each with its outer ring and its holes.
pub type ExtentOutline = Vec<Vec<Vec<LatticePoint>>>;

/// The parts whose intersection is the extent of the sea and areas.
pub struct ExtentParts<'a> {
    /// The package's grid.
    pub frame: &'a GridFrame,
    /// WGS84 ⇄ the grid's working CRS.
    pub projection: &'a (dyn Projection + Sync),
    /// The rectangle of all nodes at which there can be data.
    pub nodes: LatticeBounds,
    /// The outline of the elevation files, if they do not fill a rectangle.
    pub data: Option<&'a ExtentOutline>,
    /// The rectangle around all elevation files, degrees.
    pub area_deg: Bounds,
    /// The requested bounds, degrees.
    pub bounds_deg: Option<[f64; 4]>,
    /// The bounding boxes in the headers of the extracts, if all extracts have one.
    pub boxes_deg: &'a [[f64; 4]],
}

/// The extent of the sea and areas.
#[derive(Debug, Clone)]
pub struct AreaExtent {
    /// The rectangle around the extent.
    pub bounds: LatticeBounds,
    /// The outline of the extent, if it is not a rectangle.
    pub region: Option<LatticeRegion>,
    /// The extent as polygons whose interiors do not overlap.
    pub polygons: Vec<Polygon>,
}

impl AreaExtent {
    /// Returns an extent that is a rectangle.
    #[must_use]
    pub fn of_rectangle(bounds: LatticeBounds) -> Self {
        let polygons = Polygon::rectangle(bounds).into_iter().collect();
        Self { bounds, region: None, polygons }
    }

    /// Returns the intersection of all parts. Bounds and data are considered only if the rectangle
    /// around their image in the working CRS, which the ground fills, extends a cell or more beyond
    /// the image: bounds are rounded outwards to cells. Boxes that do not overlap the data are
    /// ignored.
    ///
    /// # Errors
    /// When outlines cannot be overlaid.
    pub fn new(parts: &ExtentParts<'_>) -> Result<Self, OutlineError> {
        let imaging = Imaging { frame: parts.frame, seam: parts.projection.seam() };
        let mut extent = Self::of_rectangle(imaging.on_map(parts.nodes));
        let rounded = Self::rounded_steps(parts.frame);
        if let Some(data) = parts.data {
            extent.cut(data, rounded)?;
        } else {
            // Older packages record no outline; for data in degrees, the box is used instead.
            let Bounds { min_x, min_y, max_x, max_y } = parts.area_deg;
            extent.cut(&parts.images(&[[min_x, min_y, max_x, max_y]]), rounded)?;
        }
        if let Some(bounds_deg) = parts.bounds_deg {
            extent.cut(&parts.images(&[bounds_deg]), rounded)?;
        }
        if !parts.boxes_deg.is_empty() {
            extent.cut(&parts.images(parts.boxes_deg), ROUNDING_STEPS)?;
        }
        Ok(extent)
    }

    /// The size of a rounding to a cell, in lattice steps.
    pub(crate) fn rounded_steps(frame: &GridFrame) -> i64 {
        let cell = frame.node_steps(frame.max_level());
        cell[0].max(cell[1])
    }

    /// Clips the extent to the polygons, unless nothing would remain, or all of it but `rounded`
    /// steps along the sides. Returns whether anything was clipped.
    ///
    /// # Errors
    /// See [`OutlineError`].
    pub fn cut(&mut self, within: &ExtentOutline, rounded: i64) -> Result<bool, OutlineError> {
        let Some(region) = LatticeRegion::new(within) else { return Ok(false) };
        let inner = self.bounds.expanded(-rounded);
        let is_narrow = inner.min.u >= inner.max.u || inner.min.v >= inner.max.v;
        let meets = |[one, other]: [LatticePoint; 2]| {
            one.v.min(other.v) <= inner.max.v && one.v.max(other.v) >= inner.min.v
        };
        let holds_it = region.contains(inner.min) && !region.edges_near(&inner).any(meets);
        if is_narrow || holds_it {
            return Ok(false);
        }
        let corners = [self.bounds, region.bounds()].map(|bounds| [bounds.min, bounds.max]);
        let parts = || corners.as_flattened().iter().flat_map(|point| [point.u, point.v]);
        let most = parts().map(i64::abs).max().unwrap_or_default();
        let step = (most / MOST_OVERLAID + 1).max(1);
        let polygons = intersection(&self.polygons, region.rings(), step)?;
        let Some(region) = LatticeRegion::new(&outline(&polygons)) else { return Ok(false) };
        let is_rectangle = polygons.iter().all(is_along_axes) && polygons.len() == 1;
        self.bounds = region.bounds();
        self.region = (!is_rectangle).then_some(region);
        self.polygons = polygons;
        Ok(true)
    }

    /// The rings of the extent's polygons.
    #[must_use]
    pub fn outline(&self) -> ExtentOutline {
        outline(&self.polygons)
    }
}

fn outline(polygons: &[Polygon]) -> ExtentOutline {
    let rings = |polygon: &Polygon| polygon.rings().map(|ring| ring.points().to_vec()).collect();
    polygons.iter().map(rings).collect()
}

/// Whether a polygon is an axis-aligned rectangle.
fn is_along_axes(polygon: &Polygon) -> bool {
    let is_straight = |[from, to]: [LatticePoint; 2]| from.u == to.u || from.v == to.v;
    polygon.holes().is_empty()
        && polygon.outer().points().len() == 4
        && polygon.outer().segments().all(is_straight)
}

impl ExtentParts<'_> {
    /// The images of boxes on the lattice, as far as the boxes are near the data. Boxes without a
    /// position in the working CRS are skipped.
    fn images(&self, boxes_deg: &[[f64; 4]]) -> ExtentOutline {
        let imaging = Imaging { frame: self.frame, seam: self.projection.seam() };
        let near = boxes_deg.iter().flat_map(|&own| near_data(own, self.area_deg));
        let image = |[west, south, east, north]: [f64; 4]| {
            let corners = [[west, south], [east, south], [east, north], [west, north]];
            let to_working =
                |places: &mut [[f64; 2]]| self.projection.working_from_wgs84(places).ok();
            Some(vec![imaging.image(&corners, &to_working)?])
        };
        near.filter_map(image).collect()
    }
}

/// Projects outlines onto the lattice.
pub(crate) struct Imaging<'a> {
    pub frame: &'a GridFrame,
    pub seam: Option<Seam>,
}

impl Imaging<'_> {
    /// The part of a rectangle that is on the map of the earth: coastlines end where this map is
    /// cut open.
    pub(crate) fn on_map(&self, nodes: LatticeBounds) -> LatticeBounds {
        let Some(seam) = self.seam else { return nodes };
        let [west, east] = seam.on_lattice(self.frame).ends().map(|end| end as i64);
        let LatticeBounds { min, max } = nodes;
        LatticeBounds {
            min: LatticePoint::new(min.u.max(west), min.v),
            max: LatticePoint::new(max.u.min(east), max.v),
        }
    }

    /// The image of a ring, whose sides follow those of the ring; `None` where a part of it has no
    /// position in the working CRS.
    pub(crate) fn image(
        &self,
        corners: &[[f64; 2]],
        to_working: &dyn Fn(&mut [[f64; 2]]) -> Option<()>,
    ) -> Option<Vec<LatticePoint>> {
        let mut pieces = *PIECES.start();
        loop {
            let side = |index: usize| {
                let [from, to] = [corners[index], corners[(index + 1) % corners.len()]];
                (0..pieces).map(move |piece| {
                    let share = piece as f64 / pieces as f64;
                    along(from, to, share)
                })
            };
            let mut ring: Vec<[f64; 2]> = (0..corners.len()).flat_map(side).collect();
            to_working(&mut ring)?;
            if !ring.iter().flatten().all(|value| value.is_finite()) {
                return None;
            }
            if let Some(seam_m) = self.seam {
                seam_m.unroll(&mut ring);
                let x = || ring.iter().map(|corner| corner[0]);
                let [least, most] =
                    [x().fold(f64::INFINITY, f64::min), x().fold(f64::NEG_INFINITY, f64::max)];
                let away = seam_m.turn() * seam_m.turns(f64::midpoint(least, most));
                for corner in &mut ring {
                    corner[0] -= away;
                }
            }
            let bend_m = bend_m(&ring);
            let tolerance_m = TOLERANCE_CELLS * self.frame.cell().shorter_m();
            if bend_m <= tolerance_m || pieces >= *PIECES.end() {
                let keep = if bend_m <= STRAIGHT_M { pieces } else { 1 };
                let kept = ring.into_iter().step_by(keep);
                return kept.map(|corner| self.frame.snap(corner)).collect();
            }
            pieces *= 2;
        }
    }
}

/// The largest distance between every second corner of a ring and the line between the corner's
/// neighbours. A quarter of this is how far a side bends between two corners.
fn bend_m(ring: &[[f64; 2]]) -> f64 {
    let count = ring.len();
    let off = |index: usize| {
        let [a, b, c] = [index - 1, index, (index + 1) % count].map(|index| ring[index]);
        (b[0] - f64::midpoint(a[0], c[0])).hypot(b[1] - f64::midpoint(a[1], c[1])) / 4.0
    };
    (1..count).step_by(2).map(off).fold(0.0, f64::max)
}

/// The part of a box that is near the data, with the longitudes of the data: all of it around the
/// earth, in one part or two.
fn near_data([west, south, east, north]: [f64; 4], area_deg: Bounds) -> Vec<[f64; 4]> {
    let around = |size_deg: f64| (AROUND * size_deg).max(LEAST_AROUND_DEG);
    let [aside, up] = [around(area_deg.width()), around(area_deg.height())];
    let (south, north) =
        (south.max(area_deg.min_y - up).max(-90.0), north.min(area_deg.max_y + up).min(90.0));
    let width = if west > east { east + 360.0 - west } else { east - west };
    let [least, most] = [area_deg.min_x - aside, area_deg.max_x + aside];
    if width >= 360.0 {
        return vec![[least, south, most, north]];
    }
    let seam = Seam::of_degrees().around(area_deg.center()[0]);
    let middle = seam.image(west + width / 2.0);
    let turns = [-360.0, 0.0, 360.0].map(|turn| middle + turn);
    let part = |middle: f64| {
        [(middle - width / 2.0).max(least), south, (middle + width / 2.0).min(most), north]
    };
    let is_some = |[west, south, east, north]: &[f64; 4]| west < east && south < north;
    turns.map(part).into_iter().filter(is_some).collect()
}

#[cfg(test)]
#[path = "extent_tests.rs"]
mod tests;
