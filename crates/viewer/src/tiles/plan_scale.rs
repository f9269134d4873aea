//! Working metres per true metre within one tile, east and north.

use corniche_geom::{Bounds, CoordinateTable, width_factor};

/// Working metres per true metre in a tile, towards the east and towards the north. It gives roads
/// their true widths.
///
/// The scale is computed at the four corners and interpolated between them. This is precise enough,
/// because it changes smoothly, by about 10⁻⁴ over a kilometre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanScale {
    corners: Bounds,
    /// South-west, south-east, north-west, north-east.
    scales: [[f64; 2]; 4],
}

impl PlanScale {
    /// The same scale everywhere: `[1.0, 1.0]` if working metres are true metres.
    #[must_use]
    pub fn uniform(scale: [f64; 2]) -> Self {
        let corners = Bounds { min_x: 0.0, min_y: 0.0, max_x: 1.0, max_y: 1.0 };
        Self { corners, scales: [scale; 4] }
    }

    /// The scale of a tile. Outside the bounds of `table`, it is the scale at the nearest position
    /// inside. Where the table has no scale, it is `otherwise` along both axes.
    #[must_use]
    pub fn of_tile(table: &CoordinateTable, tile: Bounds, otherwise: f64) -> Self {
        let known = table.bounds();
        let inside_x = |x: f64| x.clamp(known.min_x, known.max_x);
        let inside_y = |y: f64| y.clamp(known.min_y, known.max_y);
        let corners = Bounds {
            min_x: inside_x(tile.min_x),
            min_y: inside_y(tile.min_y),
            max_x: inside_x(tile.max_x),
            max_y: inside_y(tile.max_y),
        };
        let Bounds { min_x, min_y, max_x, max_y } = corners;
        let at = [[min_x, min_y], [max_x, min_y], [min_x, max_y], [max_x, max_y]];
        let scales = at.map(|at| table.scale_at(at).unwrap_or([otherwise; 2]));
        Self { corners, scales }
    }

    /// The scale at a position in the working CRS.
    #[must_use]
    pub fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let share = |at: f64, low: f64, high: f64| {
            if high > low { ((at - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 }
        };
        let Bounds { min_x, min_y, max_x, max_y } = self.corners;
        let (east, north) = (share(x, min_x, max_x), share(y, min_y, max_y));
        [0, 1].map(|axis| {
            let [sw, se, nw, ne] = self.scales.map(|scale| scale[axis]);
            let (south, north_side) = (sw + east * (se - sw), nw + east * (ne - nw));
            south + north * (north_side - south)
        })
    }

    /// Working metres across a segment of a road per true metre across it, at its middle.
    #[must_use]
    pub fn across(&self, [[x, y], [to_x, to_y]]: [[f64; 2]; 2]) -> f64 {
        let middle = [f64::midpoint(x, to_x), f64::midpoint(y, to_y)];
        width_factor(self.at(middle), [to_x - x, to_y - y])
    }
}

impl Default for PlanScale {
    fn default() -> Self {
        Self::uniform([1.0; 2])
    }
}

#[cfg(test)]
#[path = "plan_scale_tests.rs"]
mod tests;
