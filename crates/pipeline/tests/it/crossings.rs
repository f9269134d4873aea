//! Positions of the vertices of GEO lines, by a second implementation of the formulas in FORMAT.md,
//! section 7.

#![allow(clippy::unwrap_used, reason = "helpers of tests may unwrap")]

use crate::support::parts::{Parts, SOUND};
use corniche_drape::{DrapedLine, DrapedVertex};
use corniche_geom::{LatticePoint, TileId};
use corniche_tin::{Placement, Surface, Tin};

/// A tile's TIN as the format describes it: whole lattice steps and whole height steps.
struct Nodes<'a> {
    tin: &'a Tin,
    /// Lattice point of column 0, row 0.
    corner: [i64; 2],
    /// Lattice steps from node to node, east and north.
    steps: [i64; 2],
    quantum_m: f64,
}

impl<'a> Nodes<'a> {
    /// Applies the rules of section 2 to the numbers in the manifest.
    fn new(parts: &Parts, id: TileId, tin: &'a Tin) -> Self {
        let json = serde_json::to_value(&parts.manifest).unwrap();
        let number = |at: &str| json.pointer(at).unwrap().as_f64().unwrap();
        let [east_m, north_m] = [number("/frame/cell_m/0"), number("/frame/cell_m/1")];
        let mut bits = 0;
        while north_m / f64::from(1_u32 << bits) > 0.001 {
            bits += 1;
        }
        let step_m = north_m / f64::from(1_u32 << bits);
        let cell = [(east_m / step_m).round() as i64, 1 << bits];
        let s = 1_i64 << (number("/frame/max_level") as i64 - i64::from(id.z()));
        let root = [number("/frame/root_corner/i") as i64, number("/frame/root_corner/j") as i64];
        let node = [root[0] + 256 * s * i64::from(id.x()), root[1] - 256 * s * i64::from(id.y())];
        Self {
            tin,
            corner: [node[0] * cell[0], node[1] * cell[1]],
            steps: cell.map(|steps| steps * s),
            quantum_m: number("/vertical/quantum_m"),
        }
    }

    fn at(&self, vertex: u32) -> [i64; 2] {
        let vertex = &self.tin.vertices()[vertex as usize];
        [
            self.corner[0] + i64::from(vertex.column) * self.steps[0],
            self.corner[1] - i64::from(vertex.row) * self.steps[1],
        ]
    }

    fn height_m(&self, vertex: u32) -> f64 {
        f64::from(self.tin.vertices()[vertex as usize].height_q) * self.quantum_m
    }

    fn source(&self, point: LatticePoint, triangle: u32) -> [f64; 3] {
        let corners = self.tin.triangles()[triangle as usize];
        let [a, b, c] = corners.map(|corner| self.at(corner));
        let [ha, hb, hc] = corners.map(|corner| self.height_m(corner));
        let from_a = |p: [i64; 2]| [(p[0] - a[0]) as f64, (p[1] - a[1]) as f64];
        let ([bu, bv], [cu, cv], [du, dv]) = (from_a(b), from_a(c), from_a([point.u, point.v]));
        let total = bu * cv - bv * cu;
        let of_b = (du * cv - dv * cu) / total * (hb - ha);
        let of_c = (bu * dv - bv * du) / total * (hc - ha);
        [point.u as f64, point.v as f64, ha + (of_b + of_c)]
    }

    fn crossing(&self, [p, q]: [LatticePoint; 2], [a, b]: [u32; 2]) -> [f64; 3] {
        let s = |vertex: u32| {
            let [u, v] = self.at(vertex);
            i128::from(q.u - p.u) * i128::from(v - p.v)
                - i128::from(q.v - p.v) * i128::from(u - p.u)
        };
        let (near, far) = if s(a).abs() <= s(b).abs() { (a, b) } else { (b, a) };
        let t = s(near) as f64 / (s(near) - s(far)) as f64;
        let (from, to) = (self.at(near), self.at(far));
        let along = |axis: usize| from[axis] as f64 + t * (to[axis] - from[axis]) as f64;
        let (h_near, h_far) = (self.height_m(near), self.height_m(far));
        [along(0), along(1), h_near + t * (h_far - h_near)]
    }

    fn positions(&self, line: &DrapedLine) -> Vec<[f64; 3]> {
        let point_of = |vertex: &DrapedVertex| match vertex {
            DrapedVertex::Source { point, .. } => Some(*point),
            DrapedVertex::Crossing { .. } | DrapedVertex::Vertex { .. } => None,
        };
        line.vertices
            .iter()
            .enumerate()
            .map(|(at, vertex)| match *vertex {
                DrapedVertex::Source { point, triangle } => self.source(point, triangle),
                DrapedVertex::Vertex { vertex } => {
                    let [u, v] = self.at(vertex);
                    [u as f64, v as f64, self.height_m(vertex)]
                }
                DrapedVertex::Crossing { a, b } => {
                    let before =
                        line.vertices[..at].iter().rev().find_map(point_of).or(line.lead_in);
                    let after = line.vertices[at..].iter().find_map(point_of).or(line.lead_out);
                    self.crossing([before.unwrap(), after.unwrap()], [a, b])
                }
            })
            .collect()
    }
}

/// Checks all vertices of all lines of the sample, on every level, to the last bit.
#[test]
fn positions_of_lines_are_those_of_the_format() {
    let parts = &SOUND.parts;
    let (mut crossings, mut sources) = (0, 0);
    for tile in &parts.tiles {
        let Some(terrain) = &tile.terrain else { continue };
        let nodes = Nodes::new(parts, tile.id, &terrain.tin);
        let placement = Placement::of_tile(parts.frame(), tile.id, nodes.quantum_m);
        let surface = Surface::new(&terrain.tin, placement);
        for road in &tile.roads_geo {
            let bits = |positions: Vec<[f64; 3]>| -> Vec<[u64; 3]> {
                positions.into_iter().map(|position| position.map(f64::to_bits)).collect()
            };
            let expected = bits(corniche_drape::positions(&road.line, &surface).unwrap());
            assert_eq!(
                bits(nodes.positions(&road.line)),
                expected,
                "way {} in {}",
                road.way_id,
                tile.id
            );
            for vertex in &road.line.vertices {
                match vertex {
                    DrapedVertex::Crossing { .. } => crossings += 1,
                    DrapedVertex::Source { .. } => sources += 1,
                    DrapedVertex::Vertex { .. } => {}
                }
            }
        }
    }
    println!("{crossings} crossings and {sources} source points agree bit for bit");
    assert!(crossings > 4000 && sources > 4000, "{crossings} crossings, {sources} source points");
}

/// Checks x and y in working metres in the same way.
#[test]
fn working_metres_are_those_of_the_format() {
    let frame = SOUND.parts.frame();
    let (origin, cell) = (frame.origin_m(), frame.cell().to_array());
    let steps = frame.node_steps(frame.max_level()).map(|steps| steps as f64);
    for at in [[8_748_400_000.25, 85_030_000_000.75], [-3.5, 1e9]] {
        let expected = [0, 1].map(|axis| origin[axis] + cell[axis] * (at[axis] / steps[axis]));
        assert_eq!(frame.position_of_fraction_m(at).map(f64::to_bits), expected.map(f64::to_bits));
    }
}
