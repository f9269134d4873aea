//! A second opinion on TINs, written apart from the code that made them: plain f64 geometry in cells of the
//! tile, a grid of buckets, no adjacency.

use corniche_tin::Tin;

/// Buckets along one side of a tile.
const BUCKETS: usize = 64;
const TILE_CELLS: f64 = 256.0;
/// How far outside a triangle, in cells, a point may lie and still count as in it: rounding of f64 at the scale
/// of a tile, far below the millimetre.
const SLACK_CELLS: f64 = 1e-7;

/// A tile's triangles, ready to be asked for heights. Positions are (column, row) in the tile's own cells.
pub(crate) struct Ground {
    /// Corners of each triangle: column, row, height in metres.
    triangles: Vec<Corners>,
    buckets: Vec<Vec<u32>>,
}

type Corners = [[f64; 3]; 3];

impl Ground {
    pub(crate) fn new(tin: &Tin, quantum_m: f64) -> Self {
        let triangles: Vec<Corners> = tin
            .triangles()
            .iter()
            .map(|corners| {
                corners.map(|corner| {
                    let vertex = &tin.vertices()[corner as usize];
                    let height_m = f64::from(vertex.height_q) * quantum_m;
                    [f64::from(vertex.column), f64::from(vertex.row), height_m]
                })
            })
            .collect();
        let mut buckets = vec![Vec::new(); BUCKETS * BUCKETS];
        for (index, corners) in triangles.iter().enumerate() {
            let range = |axis: usize| {
                let values = corners.map(|corner| corner[axis]);
                let low = values.into_iter().fold(f64::INFINITY, f64::min);
                let high = values.into_iter().fold(f64::NEG_INFINITY, f64::max);
                bucket(low - SLACK_CELLS)..=bucket(high + SLACK_CELLS)
            };
            for row in range(1) {
                for column in range(0) {
                    buckets[row * BUCKETS + column].push(index as u32);
                }
            }
        }
        Self { triangles, buckets }
    }

    /// All triangles that hold the point, borders included.
    fn holding(&self, at: [f64; 2]) -> impl Iterator<Item = &Corners> + '_ {
        self.buckets[bucket(at[1]) * BUCKETS + bucket(at[0])]
            .iter()
            .map(|&triangle| &self.triangles[triangle as usize])
            .filter(move |corners| holds(corners, at))
    }

    /// Height of the ground; `None` where there is none. Where triangles meet, the first one's.
    pub(crate) fn height_m(&self, at: [f64; 2]) -> Option<f64> {
        self.holding(at).next().map(|corners| height(corners, at))
    }

    /// How far the edge from `a` to `b` (column, row, height) is from lying on one triangle: the smallest, over
    /// all triangles that hold both ends, of the larger gap at the two ends. `None` when none holds both.
    ///
    /// A triangle is convex and flat, so what holds for both ends holds for the edge between them.
    pub(crate) fn edge_gap_m(&self, a: [f64; 3], b: [f64; 3]) -> Option<f64> {
        let middle = [f64::midpoint(a[0], b[0]), f64::midpoint(a[1], b[1])];
        self.holding(middle)
            .filter(|corners| holds(corners, flat(a)) && holds(corners, flat(b)))
            .map(|corners| {
                let gap = |p: [f64; 3]| (height(corners, flat(p)) - p[2]).abs();
                gap(a).max(gap(b))
            })
            .reduce(f64::min)
    }
}

fn bucket(cells: f64) -> usize {
    ((cells / TILE_CELLS * BUCKETS as f64).max(0.0) as usize).min(BUCKETS - 1)
}

/// Twice the signed area; rows grow southwards, so the TIN's counter-clockwise triangles are negative here.
fn area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn flat([column, row, _]: [f64; 3]) -> [f64; 2] {
    [column, row]
}

fn holds(corners: &Corners, at: [f64; 2]) -> bool {
    (0..3).all(|k| {
        let (a, b) = (flat(corners[k]), flat(corners[(k + 1) % 3]));
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        area(a, b, at) <= SLACK_CELLS * length
    })
}

fn height(corners: &Corners, at: [f64; 2]) -> f64 {
    let [a, b, c] = *corners;
    let whole = area(flat(a), flat(b), flat(c));
    let weight_b = area(flat(a), at, flat(c)) / whole;
    let weight_c = area(flat(a), flat(b), at) / whole;
    a[2] + weight_b * (b[2] - a[2]) + weight_c * (c[2] - a[2])
}

#[cfg(test)]
mod tests {
    use corniche_tin::TinVertex;

    use super::*;

    fn roof() -> Tin {
        // A roof: ridge of height 8 along column 128, eaves at 0.
        let node = |row, column, height_q| TinVertex { row, column, height_q };
        let vertices = vec![
            node(0, 0, 0),
            node(0, 128, 8),
            node(0, 256, 0),
            node(256, 0, 0),
            node(256, 128, 8),
            node(256, 256, 0),
        ];
        Tin::new(vertices, &[[0, 3, 1], [1, 3, 4], [1, 4, 2], [2, 4, 5]]).unwrap()
    }

    #[test]
    fn heights_of_a_roof() {
        let roof = roof();
        let ground = Ground::new(&roof, 0.5);
        for column in 0..=256_u16 {
            let expected = (128.0 - (f64::from(column) - 128.0).abs()) / 128.0 * 4.0;
            let height_m = ground.height_m([f64::from(column), 37.25]).unwrap();
            assert!((height_m - expected).abs() < 1e-9);
        }
        assert_eq!(ground.height_m([257.0, 3.0]), None);
    }

    #[test]
    fn an_edge_over_the_ridge_is_on_no_triangle_and_one_in_the_air_has_its_gap() {
        let roof = roof();
        let ground = Ground::new(&roof, 0.5);
        assert_eq!(ground.edge_gap_m([100.0, 10.0, 3.125], [150.0, 10.0, 3.3125]), None);
        let gap_m = ground.edge_gap_m([0.0, 3.0, 0.25], [1.0, 3.0, 4.0 / 128.0]).unwrap();
        assert!((gap_m - 0.25).abs() < 1e-9);
    }
}
