//! True lengths of lines that are straight on a map, and true areas inside such lines.

use crate::{along, wgs84};

/// Lines whose ends are at most this far apart are measured only by their ends: a map bends them by
/// less than a tenth of a millimetre.
const SHORT_M: f64 = 1000.0;
/// A longer line is measured along its course if this changes the length by more than this value.
const LEAST_DIFFERENCE_M: f64 = 1e-4;
/// The accuracy of the length of each part of a longer line.
const CLOSED_M: f64 = 1e-6;
/// The accuracy of areas next to a part.
const CLOSED_M2: f64 = 1e-2;
/// The relative accuracy of a part, which is larger than the rounding of coordinates.
const CLOSED_SHARE: f64 = 1e-10;
/// The largest number of times that a part is halved: a part that needs more crosses a place where
/// the map is torn.
const MOST_HALVINGS: u32 = 40;

/// A map: converts coordinates to longitude and latitude in degrees; the result is not finite if
/// there are none.
pub type Degrees<'a> = dyn Fn([f64; 2]) -> [f64; 2] + 'a;

/// The true length of a line that is straight on a map, on the ellipsoid of WGS84, in metres; not
/// finite if the map does not contain it.
///
/// Source: Romberg 1955, *Vereinfachte numerische Integration*: the lengths of one, two and four
/// chords, extrapolated; a part whose extrapolations differ is halved.
#[must_use]
pub fn line_length_m(ends: [[f64; 2]; 2], degrees: &Degrees<'_>) -> f64 {
    known_line_length_m(ends, ends.map(degrees), degrees)
}

/// The true length of a line whose ends are already known in degrees.
#[must_use]
pub fn known_line_length_m(
    ends: [[f64; 2]; 2],
    [from_deg, to_deg]: [[f64; 2]; 2],
    degrees: &Degrees<'_>,
) -> f64 {
    let ends_m = wgs84::short_distance_m(from_deg, to_deg);
    if ends_m <= SHORT_M {
        return ends_m;
    }
    let course = Course { ends, degrees, measure: &wgs84::short_distance_m, closed: CLOSED_M };
    let along_m = course.sum([from_deg, to_deg]);
    if (along_m - ends_m).abs() <= LEAST_DIFFERENCE_M { ends_m } else { along_m }
}

/// The true area inside a closed line of positions in degrees whose sides are straight on a map, in
/// square metres; negative for a clockwise line. The first position is not repeated at the end.
/// `side` returns the ends of the side between two positions on the map; it is only called for long
/// sides. No line may go around a pole. Outside the map, sides are straight in the cylindrical
/// equal-area projection.
#[must_use]
pub fn ring_area_m2(
    ring_deg: &[[f64; 2]],
    side: &dyn Fn([usize; 2]) -> [[f64; 2]; 2],
    degrees: &Degrees<'_>,
) -> f64 {
    let bent_m2 = |indices: [usize; 2]| {
        let [from_deg, to_deg] = indices.map(|index| ring_deg[index]);
        if wgs84::short_distance_m(from_deg, to_deg) <= SHORT_M {
            return 0.0;
        }
        let measure = &wgs84::area_beside_m2;
        let course = Course { ends: side(indices), degrees, measure, closed: CLOSED_M2 };
        let bent_m2 = course.sum([from_deg, to_deg]) - measure(from_deg, to_deg);
        if bent_m2.is_finite() { bent_m2 } else { 0.0 }
    };
    let count = ring_deg.len();
    let all_m2: f64 = (0..count).map(|index| bent_m2([index, (index + 1) % count])).sum();
    wgs84::area_m2(ring_deg) + all_m2
}

/// A line along which a quantity is summed.
struct Course<'a> {
    ends: [[f64; 2]; 2],
    degrees: &'a Degrees<'a>,
    /// The summed quantity of a chord between two positions in degrees. Its error falls with even
    /// powers of the chord's length.
    measure: &'a dyn Fn([f64; 2], [f64; 2]) -> f64,
    closed: f64,
}

impl Course<'_> {
    fn sum(&self, [from_deg, to_deg]: [[f64; 2]; 2]) -> f64 {
        let middle_deg = self.place_deg(0.5);
        self.part([0.0, 1.0], [from_deg, middle_deg, to_deg], MOST_HALVINGS)
    }

    fn place_deg(&self, share: f64) -> [f64; 2] {
        let [from, to] = self.ends;
        (self.degrees)(along(from, to, share))
    }

    /// The sum between two fractions of the line; the positions at both and halfway are known.
    fn part(&self, [from, to]: [f64; 2], [a, c, e]: [[f64; 2]; 3], halvings: u32) -> f64 {
        let middle = f64::midpoint(from, to);
        let [b, d] = [[from, middle], [middle, to]]
            .map(|[from, to]| self.place_deg(f64::midpoint(from, to)));
        let measure = self.measure;
        let one = measure(a, e);
        let two = measure(a, c) + measure(c, e);
        let four = measure(a, b) + measure(b, c) + measure(c, d) + measure(d, e);
        let [coarse, fine] = [two + (two - one) / 3.0, four + (four - two) / 3.0];
        let allowed = self.closed + CLOSED_SHARE * four.abs();
        // A value that is not finite stays so, however often the part is halved.
        if (fine - coarse).abs() > allowed && halvings > 0 {
            return self.part([from, middle], [a, b, c], halvings - 1)
                + self.part([middle, to], [c, d, e], halvings - 1);
        }
        fine + (fine - coarse) / 15.0
    }
}

#[cfg(test)]
#[path = "map_lines_tests.rs"]
mod tests;
