use corniche_geom::{Bounds, CoordinateTable, width_factor};

/// Working metres to a true metre over a tile, along the working CRS's east and north: what makes roads as wide as they
/// are.
///
/// Known at four corners and interpolated between them: it changes evenly, by 10⁻⁴ or so over a kilometre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanScale {
    corners: Bounds,
    /// South-west, south-east, north-west, north-east.
    scales: [[f64; 2]; 4],
}

impl PlanScale {
    /// The same everywhere: `[1.0, 1.0]` where working metres are true.
    #[must_use]
    pub fn uniform(scale: [f64; 2]) -> Self {
        let corners = Bounds { min_x: 0.0, min_y: 0.0, max_x: 1.0, max_y: 1.0 };
        Self { corners, scales: [scale; 4] }
    }

    /// Of a tile, as far as `table` reaches; `otherwise`, along both axes, where it knows none.
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

    /// At a position in the working CRS.
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

    /// Working metres across a segment of a road for each true metre across it, at its middle.
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
mod tests {
    use corniche_geom::{ProjectError, Projection};

    use super::*;

    /// Degrees times 80 000 and 100 000.
    struct Geographic;

    impl Projection for Geographic {
        fn working_from_wgs84(&self, points: &mut [[f64; 2]]) -> Result<(), ProjectError> {
            for p in points {
                *p = [p[0] * 8e4, p[1] * 1e5];
            }
            Ok(())
        }

        fn wgs84_from_working(&self, points: &mut [[f64; 2]]) -> Result<(), ProjectError> {
            for p in points {
                *p = [p[0] / 8e4, p[1] / 1e5];
            }
            Ok(())
        }
    }

    #[test]
    fn between_the_corners_of_a_tile_the_scale_is_that_of_the_table() {
        let bounds = Bounds { min_x: 7.2e5, min_y: 4.65e6, max_x: 8.0e5, max_y: 4.75e6 };
        let table = CoordinateTable::sample(&Geographic, bounds, 0.01).unwrap();
        // Reaches beyond the data in the north-east.
        let tile = Bounds { min_x: 7.7e5, min_y: 4.73e6, max_x: 8.3e5, max_y: 4.79e6 };
        let scale = PlanScale::of_tile(&table, tile, 1.0);
        for at in [[7.7e5, 4.73e6], [7.9e5, 4.742e6], [8.0e5, 4.75e6]] {
            let ([east, north], truth) = (scale.at(at), table.scale_at(at).unwrap());
            assert!((east / truth[0] - 1.0).abs() < 1e-5, "{east} {truth:?}");
            assert!((north / truth[1] - 1.0).abs() < 1e-5, "{north} {truth:?}");
        }
        let [east, north] = scale.at([7.8e5, 4.74e6]);
        let across =
            |by: [f64; 2]| scale.across([[7.8e5, 4.74e6], [7.8e5 + by[0], 4.74e6 + by[1]]]);
        // An eastward road is wide northwards, a northward one eastwards.
        assert!((across([10.0, 0.0]) / north - 1.0).abs() < 1e-5);
        assert!((across([0.0, -10.0]) / east - 1.0).abs() < 1e-5);
    }
}
