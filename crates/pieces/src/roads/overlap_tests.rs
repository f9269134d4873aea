//! The bounds of a rectangle that is turned in degrees include all its corners.

use super::*;

/// A projection that is turned by 45 degrees.
struct Diamond;

impl Projection for Diamond {
    fn working_from_wgs84(&self, points: &mut [[f64; 2]]) -> Result<(), ProjectError> {
        for point in points {
            *point = [point[0] + point[1], point[1] - point[0]].map(|part| part / 2.0);
        }
        Ok(())
    }

    fn wgs84_from_working(&self, points: &mut [[f64; 2]]) -> Result<(), ProjectError> {
        for point in points {
            *point = [point[0] - point[1], point[0] + point[1]];
        }
        Ok(())
    }
}

#[test]
fn a_rectangle_that_is_turned_in_degrees_is_told_by_all_its_corners() {
    let square_m = Bounds { min_x: 0.0, min_y: 0.0, max_x: 10.0, max_y: 10.0 };
    let diamond_deg = Bounds { min_x: -10.0, min_y: 0.0, max_x: 10.0, max_y: 20.0 };
    assert_eq!(bounds_deg(square_m, &Diamond).unwrap(), diamond_deg);
}
