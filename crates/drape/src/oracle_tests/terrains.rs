//! Generates TINs of many shapes.

use corniche_geom::HeightGrid;
use corniche_tin::{Tin, TinSpec, TinVertex, triangulate};

use corniche_testing::Random;

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Terrain {
    /// Up to 5 × 5 quadrangles with shifted corners and either diagonal; some triangles missing.
    Quadrangles,
    /// One triangle, any shape.
    OneTriangle,
    /// Two triangles that share an edge, flat.
    TwoFlat,
    /// A strip that is one node high and up to 30 000 long, of triangles a thousand times longer
    /// than high.
    Slivers,
    /// Up to 240 triangles around one vertex, some missing.
    Fan,
    /// Squares like those of a chess board: islands that touch at corners.
    ChessBoard,
    /// Triangulated from heights with gaps, like a tile.
    Meshed,
}

impl Terrain {
    pub(crate) const ALL: [Self; 7] = [
        Self::Quadrangles,
        Self::OneTriangle,
        Self::TwoFlat,
        Self::Slivers,
        Self::Fan,
        Self::ChessBoard,
        Self::Meshed,
    ];

    /// Generates a TIN; `None` if no triangle is left.
    pub(crate) fn make(self, random: &mut Random) -> Option<Tin> {
        match self {
            Self::Quadrangles => quadrangles(random),
            Self::OneTriangle => one_triangle(random),
            Self::TwoFlat => {
                let (right, down) = (1 + random.below(9) as u16, 1 + random.below(9) as u16);
                let at = |row, column| TinVertex { row, column, height_q: 77 };
                let corners = vec![at(0, 0), at(0, right), at(down, 0), at(down, right)];
                Tin::new(corners, &[[0, 2, 1], [1, 2, 3]]).ok()
            }
            Self::Slivers => slivers(random),
            Self::Fan => fan(random),
            Self::ChessBoard => chess_board(random),
            Self::Meshed => meshed(random),
        }
    }
}

fn quadrangles(random: &mut Random) -> Option<Tin> {
    let (columns, rows) = (2 + random.below(5), 2 + random.below(5));
    // In a regular grid, lines along edges and through many vertices are common.
    let jitter = random.below(2) + 1;
    let missing = [0, 0, 8, 3][random.below(4) as usize];
    let mut vertices = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            vertices.push(TinVertex {
                row: (3 * row + random.below(jitter)) as u16,
                column: (3 * column + random.below(jitter)) as u16,
                height_q: random.below(4000) as i32,
            });
        }
    }
    let mut triangles = Vec::new();
    for row in 0..rows - 1 {
        for column in 0..columns - 1 {
            let nw = (row * columns + column) as u32;
            let (ne, sw) = (nw + 1, nw + columns as u32);
            let se = sw + 1;
            let pair = if random.below(2) == 0 {
                [[nw, sw, se], [nw, se, ne]]
            } else {
                [[nw, sw, ne], [sw, se, ne]]
            };
            triangles
                .extend(pair.into_iter().filter(|_| missing == 0 || random.below(missing) != 0));
        }
    }
    Tin::new(vertices, &triangles).ok()
}

fn one_triangle(random: &mut Random) -> Option<Tin> {
    let reach = random.one_of(&[2, 5, 257]);
    let mut node = || TinVertex {
        row: random.below(reach) as u16,
        column: random.below(reach) as u16,
        height_q: random.around(4000) as i32,
    };
    let corners = vec![node(), node(), node()];
    Tin::new(corners.clone(), &[[0, 1, 2]]).or_else(|_| Tin::new(corners, &[[0, 2, 1]])).ok()
}

fn slivers(random: &mut Random) -> Option<Tin> {
    let reach = random.one_of(&[8, 300, 30_000]);
    let mut sides = [vec![0, reach], vec![0, reach]];
    for side in &mut sides {
        side.extend((0..random.below(12)).map(|_| random.below(reach)));
        side.sort_unstable();
        side.dedup();
    }
    let mut vertices = Vec::new();
    for (row, side) in sides.iter().enumerate() {
        let node = |&column: &i64| TinVertex {
            row: row as u16,
            column: column as u16,
            height_q: random.below(4000) as i32,
        };
        vertices.extend(side.iter().map(node));
    }
    // Like a zip, the next triangle is on either side.
    let north_count = sides[0].len();
    let (mut n, mut s) = (0, 0);
    let mut triangles = Vec::new();
    while n + 1 < north_count || s + 1 < sides[1].len() {
        let on_north = s + 1 == sides[1].len() || (n + 1 < north_count && random.below(2) == 0);
        let (north, south) = (n as u32, (north_count + s) as u32);
        if on_north {
            triangles.push([north, south, north + 1]);
            n += 1;
        } else {
            triangles.push([north, south, south + 1]);
            s += 1;
        }
    }
    Tin::new(vertices, &triangles).ok()
}

fn fan(random: &mut Random) -> Option<Tin> {
    let half = 1 + random.below(30);
    let missing = random.one_of(&[0, 0, 10, 3]);
    let mut rim = Vec::new();
    // Around the square, counter-clockwise seen from above: rows count southwards.
    for k in 0..2 * half {
        rim.push((0, 2 * half - k));
    }
    for k in 0..2 * half {
        rim.push((k, 0));
    }
    for k in 0..2 * half {
        rim.push((2 * half, k));
    }
    for k in 0..2 * half {
        rim.push((2 * half - k, 2 * half));
    }
    // The hub is anywhere inside; a wedge along a side of the square would only be flat if the hub
    // were on that side.
    let hub = (1 + random.below(2 * half - 1), 1 + random.below(2 * half - 1));
    let mut vertices = Vec::new();
    for (row, column) in std::iter::once(hub).chain(rim.iter().copied()) {
        let height_q = random.below(4000) as i32;
        vertices.push(TinVertex { row: row as u16, column: column as u16, height_q });
    }
    let count = rim.len() as u32;
    let triangles: Vec<[u32; 3]> = (0..count)
        .filter(|_| missing == 0 || random.below(missing) != 0)
        .map(|k| [0, 1 + k, 1 + (k + 1) % count])
        .collect();
    Tin::new(vertices, &triangles).ok()
}

fn chess_board(random: &mut Random) -> Option<Tin> {
    let side = 2 + random.below(5);
    let parity = random.below(2);
    let wide = 1 + random.below(3);
    let node = |row: i64, column: i64| (row * (side + 1) + column) as u32;
    let mut vertices = Vec::new();
    for row in 0..=side {
        for column in 0..=side {
            let (row, column) = ((row * wide) as u16, (column * wide) as u16);
            vertices.push(TinVertex { row, column, height_q: random.below(4000) as i32 });
        }
    }
    let mut triangles = Vec::new();
    for row in 0..side {
        for column in (0..side).filter(|column| (row + column) % 2 == parity) {
            let (nw, ne) = (node(row, column), node(row, column + 1));
            let (sw, se) = (node(row + 1, column), node(row + 1, column + 1));
            triangles.extend([[nw, sw, se], [nw, se, ne]]);
        }
    }
    Tin::new(vertices, &triangles).ok()
}

fn meshed(random: &mut Random) -> Option<Tin> {
    let side = 4 + random.below(9) as usize;
    let gaps = random.one_of(&[0, 20, 6]);
    let heights = HeightGrid::from_fn(side, side, |_, _| {
        if gaps != 0 && random.below(gaps) == 0 { f32::NAN } else { random.below(40) as f32 }
    });
    let max_error_m = random.one_of(&[0.5, 8.0, 30.0]);
    let tin = triangulate(&heights, TinSpec { max_error_m, quantum_m: 0.25 }).ok()?;
    (!tin.is_empty()).then_some(tin)
}
