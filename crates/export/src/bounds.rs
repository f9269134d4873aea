//! A rectangle of longitudes and latitudes, which may cross the antimeridian, and lines clipped to
//! it.

use corniche_geom::{Bounds, Seam};

/// A rectangle of longitudes and latitudes, degrees (WGS84); it may cross the antimeridian.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DegreeBounds {
    center: f64,
    half_width: f64,
    south: f64,
    north: f64,
}

impl DegreeBounds {
    /// Returns the rectangle of west, south, east and north. If the west is greater than the east,
    /// the rectangle crosses 180°. Returns `None` if the rectangle is empty or exceeds ±180 and ±90
    /// degrees.
    #[must_use]
    pub fn new([west, south, east, north]: [f64; 4]) -> Option<Self> {
        let on_earth = [west, east].iter().all(|lon| (-180.0..=180.0).contains(lon))
            && [south, north].iter().all(|lat| (-90.0..=90.0).contains(lat));
        let width = if west > east { east + 360.0 - west } else { east - west };
        (on_earth && south < north && width > 0.0).then(|| Self {
            center: west + width / 2.0,
            half_width: width / 2.0,
            south,
            north,
        })
    }

    /// West, south, east and north. The east is at least the west, and may exceed 180.
    pub(crate) fn degrees(&self) -> [f64; 4] {
        let Self { center, half_width, south, north } = *self;
        [center - half_width, south, center + half_width, north]
    }

    /// Whether a rectangle of degrees, given by its south-western and north-eastern corner, shares
    /// more than a side with this one.
    pub(crate) fn overlaps(&self, [[west, south], [east, north]]: [[f64; 2]; 2]) -> bool {
        let [half, room] = [(east - west) / 2.0, self.half_width];
        let away = self.relative([west + half, south])[0].abs();
        away < half + room && south < self.north && self.south < north
    }

    /// Returns the part of a rectangle of degrees that is in this one, with the longitudes of
    /// `whole`. Returns all of it if it spans most of the globe.
    pub(crate) fn within(&self, whole: Bounds) -> Bounds {
        let middle = whole.center()[0];
        let center = middle - self.relative([middle, 0.0])[0];
        let around = whole.width() + 2.0 * self.half_width > 360.0;
        let [west, east] = if around {
            [whole.min_x, whole.max_x]
        } else {
            [center - self.half_width, center + self.half_width]
        };
        let own = Bounds { min_x: west, min_y: self.south, max_x: east, max_y: self.north };
        whole.intersection(&own)
    }

    /// The longitude, within ±180, and the latitude of its middle.
    pub(crate) fn middle(&self) -> [f64; 2] {
        [Seam::of_degrees().image(self.center), f64::midpoint(self.south, self.north)]
    }

    /// Returns a position as degrees east of the rectangle's middle, within ±180, and degrees of
    /// latitude.
    pub(crate) fn relative(&self, [lon, lat]: [f64; 2]) -> [f64; 2] {
        [Seam::of_degrees().image(lon - self.center), lat]
    }

    /// Returns the same for a position that follows another one: the line between both never goes
    /// around the globe.
    pub(crate) fn relative_after(&self, position: [f64; 2], before: [f64; 2]) -> [f64; 2] {
        let [east, lat] = self.relative(position);
        [Seam::of_degrees().around(before[0]).image(east), lat]
    }

    /// Lowest and highest degrees in the coordinates of [`DegreeBounds::relative`], eastwards and
    /// northwards; one pair for each turn around the globe.
    pub(crate) fn limits(&self) -> Vec<[[f64; 2]; 2]> {
        let across = [self.south, self.north];
        // A rectangle all around the globe has no western or eastern side.
        if self.half_width >= 180.0 {
            return vec![[[f64::NEG_INFINITY, f64::INFINITY], across]];
        }
        [-360.0, 0.0, 360.0]
            .map(|turn| [[turn - self.half_width, turn + self.half_width], across])
            .to_vec()
    }

    /// Returns the parts of the line between two positions (longitude and latitude) that are
    /// inside, as shares of the line in its order. There are two parts if the line leaves at one
    /// side and enters at the opposite side, where the rectangle begins again.
    pub(crate) fn inside(&self, from: [f64; 2], to: [f64; 2]) -> Vec<[f64; 2]> {
        let from = self.relative(from);
        let to = self.relative_after(to, from);
        let mut parts: Vec<[f64; 2]> =
            self.limits().into_iter().filter_map(|limits| clip(from, to, limits)).collect();
        parts.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
        parts
    }

    /// Whether a line through these positions, with a margin on all sides, might reach inside. Used
    /// to skip lines that cannot.
    pub(crate) fn may_meet(&self, positions: &[[f64; 2]]) -> bool {
        let Some(&first) = positions.first() else { return false };
        let mut before = self.relative(first);
        let mut low = before;
        let mut high = before;
        for &position in positions {
            before = self.relative_after(position, before);
            for axis in 0..2 {
                low[axis] = low[axis].min(before[axis]);
                high[axis] = high[axis].max(before[axis]);
            }
        }
        // Around a pole, longitudes are meaningless.
        if high[0] - low[0] > 90.0 || low.iter().chain(&high).any(|degrees| !degrees.is_finite()) {
            return true;
        }
        let room = [0, 1].map(|axis| (high[axis] - low[axis]) / 4.0);
        let meets = |turn: f64| {
            low[0] + turn - room[0] <= self.half_width
                && high[0] + turn + room[0] >= -self.half_width
        };
        let across = low[1] - room[1] <= self.north && high[1] + room[1] >= self.south;
        across && [-360.0, 0.0, 360.0].into_iter().any(meets)
    }
}

/// Clips a line to limits, low and high along both axes, and returns the part inside as shares of
/// the line. Returns nothing if that part is a single point.
///
/// Source: Liang & Barsky 1984, *A New Concept and Method for Line Clipping*.
pub(crate) fn clip(from: [f64; 2], to: [f64; 2], limits: [[f64; 2]; 2]) -> Option<[f64; 2]> {
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for (axis, [low, high]) in limits.into_iter().enumerate() {
        let along = to[axis] - from[axis];
        for (along, room) in [(-along, from[axis] - low), (along, high - from[axis])] {
            if along > 0.0 {
                last = last.min(room / along);
            } else if along < 0.0 {
                first = first.max(room / along);
            } else if room < 0.0 {
                return None;
            }
        }
    }
    (first < last).then_some([first, last])
}

#[cfg(test)]
#[path = "bounds_tests.rs"]
mod tests;
