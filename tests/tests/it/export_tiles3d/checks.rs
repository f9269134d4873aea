//! Invariants of exported 3D tiles.

use std::collections::{BTreeMap, HashMap, HashSet};

use corniche_testing::Random;
use e2e::ground::{FromEarth, Region};

use super::tiles::{NamedTriangles, Tile, Tiles};

/// The difference between the ground of tiles and the package's.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    pub(crate) points: usize,
    /// Largest difference beyond the tolerance for chords on wide tiles.
    pub(crate) largest_m: f64,
    /// Largest difference, including chords.
    pub(crate) with_chords_m: f64,
    /// Points where the package has no ground.
    pub(crate) off_ground: usize,
}

fn ground(tile: &Tile) -> impl Iterator<Item = &NamedTriangles> {
    tile.parts.iter().filter(|part| part.name != "skirt")
}

/// Transforms every vertex, and random points inside triangles of each tile, back to the package's
/// CRS, and compares their heights.
pub(crate) fn check_heights(tiles: &Tiles, region: &Region, inside: usize) -> Findings {
    let from_earth = FromEarth::to(region);
    let mut numbers = Random::new(1);
    let mut found = Findings::default();
    for tile in &tiles.tiles {
        let mut points: Vec<[f64; 3]> = Vec::new();
        for part in ground(tile) {
            points.extend(&part.at_m);
        }
        let triangles: Vec<[[f64; 3]; 3]> = ground(tile)
            .flat_map(|part| part.triangles.iter().map(|corners| corners.map(|k| part.at_m[k])))
            .collect();
        for _ in 0..inside {
            let [a, b, c] = triangles[(numbers.share() * triangles.len() as f64) as usize];
            let (mut s, mut t) = (numbers.share(), numbers.share());
            if s + t > 1.0 {
                (s, t) = (1.0 - s, 1.0 - t);
            }
            points.push([0, 1, 2].map(|k| a[k] + s * (b[k] - a[k]) + t * (c[k] - a[k])));
        }
        let on_earth: Vec<_> = points.iter().map(|at| tiles.on_earth(*at)).collect();
        for [x, y, z] in from_earth.carry(&on_earth) {
            found.points += 1;
            match tile.ground.height([x, y]) {
                Some(height) => {
                    let off_m = (height - z).abs();
                    found.with_chords_m = found.with_chords_m.max(off_m);
                    found.largest_m = found.largest_m.max(off_m - tile.ground.chord_m());
                }
                None => found.off_ground += 1,
            }
        }
    }
    found
}

type PositionBits = [u64; 3];

fn place(at: [f64; 3]) -> PositionBits {
    at.map(|axis| (axis + 0.0).to_bits())
}

/// The edges of a tile's ground that belong to one triangle only, as positions.
fn open_edges(tile: &Tile) -> Result<HashSet<[PositionBits; 2]>, String> {
    let mut balance: HashMap<[PositionBits; 2], i32> = HashMap::new();
    for part in ground(tile) {
        for corners in &part.triangles {
            let at = corners.map(|k| place(part.at_m[k]));
            for k in 0..3 {
                let (one, other) = (at[k], at[(k + 1) % 3]);
                if one == other {
                    return Err(format!("{}: an edge without length", tile.name));
                }
                *balance.entry([one.min(other), one.max(other)]).or_default() +=
                    if one < other { 1 } else { -1 };
            }
        }
    }
    Ok(balance.into_iter().filter(|(_, sum)| *sum != 0).map(|(edge, _)| edge).collect())
}

/// Every edge has triangles on both sides, or is at the edge of the package's ground.
pub(crate) fn check_watertight(tiles: &Tiles, region: &Region) -> Result<(), String> {
    let from_earth = FromEarth::to(region);
    for tile in &tiles.tiles {
        let open = open_edges(tile)?;
        // Length of the package's own border and of the open edges of the tiles, in plan.
        let mut edges: HashMap<[usize; 2], i32> = HashMap::new();
        for corners in &tile.ground.triangles {
            for k in 0..3 {
                let (one, other) = (corners[k], corners[(k + 1) % 3]);
                *edges.entry([one.min(other), one.max(other)]).or_default() += 1;
            }
        }
        let own: f64 = edges
            .iter()
            .filter(|(_, count)| **count == 1)
            .map(|([one, other], _)| {
                let [a, b] = [one, other].map(|k| tile.ground.corners[*k]);
                (a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2])
            })
            .sum();
        let ends: Vec<[f64; 3]> =
            open.iter().flatten().map(|at| tiles.on_earth(at.map(f64::from_bits))).collect();
        let ends = from_earth.carry(&ends);
        let here: f64 = ends
            .as_chunks::<2>()
            .0
            .iter()
            .map(|[a, b]| (a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2]))
            .sum();
        if (own - here).abs() > own * 1e-5 {
            return Err(format!("{}: {here} m of edges are open, not {own}", tile.name));
        }
    }
    Ok(())
}

/// Tiles of a level have the same points on the border between them.
pub(crate) fn check_borders(tiles: &Tiles, region: &Region) -> Result<(), String> {
    let mut open: BTreeMap<[u32; 3], HashSet<[PositionBits; 2]>> = BTreeMap::new();
    for tile in &tiles.tiles {
        let name: Vec<u32> = tile.name.split('/').map(|part| part.parse().unwrap()).collect();
        open.insert(name.try_into().unwrap(), open_edges(tile)?);
    }
    let from_earth = FromEarth::to(region);
    let grounds: BTreeMap<&str, &Tile> =
        tiles.tiles.iter().map(|tile| (tile.name.as_str(), tile)).collect();
    // The positions of a tile's open edges on a line of the CRS where its neighbour has ground,
    // too.
    let on_line = |edges: &HashSet<[PositionBits; 2]>, beside: &Tile, axis: usize, line: f64| {
        let places: Vec<PositionBits> = edges.iter().flatten().copied().collect();
        let on_earth: Vec<_> =
            places.iter().map(|at| tiles.on_earth(at.map(f64::from_bits))).collect();
        let carried = from_earth.carry(&on_earth);
        let is_shared = |at: &[f64; 3]| {
            (at[axis] - line).abs() < 0.005 && beside.ground.height([at[0], at[1]]).is_some()
        };
        places
            .into_iter()
            .zip(carried)
            .filter(|(_, at)| is_shared(at))
            .map(|(at, _)| at)
            .collect::<HashSet<PositionBits>>()
    };
    let mut shared = 0;
    for (&[z, x, y], edges) in &open {
        let tile = grounds[format!("{z}/{x}/{y}").as_str()];
        let [_, south, east, _] = tile.ground.bounds;
        for (beside, axis, line) in [([z, x + 1, y], 0, east), ([z, x, y + 1], 1, south)] {
            let Some(others) = open.get(&beside) else { continue };
            let other_tile = grounds[beside.map(|part| part.to_string()).join("/").as_str()];
            let own = on_line(edges, other_tile, axis, line);
            let other = on_line(others, tile, axis, line);
            if own != other {
                let missing = own.symmetric_difference(&other).count();
                return Err(format!("{z}/{x}/{y} and {beside:?}: {missing} points differ"));
            }
            shared += own.len();
        }
    }
    if shared > 100 { Ok(()) } else { Err(format!("only {shared} points are shared")) }
}

/// Points well inside a road are on a road, of that way or of a more important one, and points away
/// from all roads are ground.
pub(crate) fn check_roads(tiles: &Tiles, region: &Region) -> Result<(), String> {
    let from_earth = FromEarth::to(region);
    let mut seen = [0_usize; 2];
    let finest = tiles.levels().max().unwrap().to_string();
    for tile in &tiles.tiles {
        // Coarser levels omit roads that are too thin to be visible.
        let boxes: Vec<[[f64; 2]; 2]> =
            tile.ground.roads.iter().map(|(_, _, line)| around(line)).collect();
        let has_all = tile.name.split('/').next() == Some(finest.as_str());
        for part in ground(tile) {
            let centroids: Vec<[f64; 3]> = part
                .triangles
                .iter()
                .map(|corners| {
                    let at = corners.map(|k| part.at_m[k]);
                    tiles.on_earth([0, 1, 2].map(|k| (at[0][k] + at[1][k] + at[2][k]) / 3.0))
                })
                .collect();
            for (number, [x, y, _]) in from_earth.carry(&centroids).into_iter().enumerate() {
                let near = tile.ground.roads.iter().zip(&boxes).filter(|(_, [low, high])| {
                    (low[0]..=high[0]).contains(&x) && (low[1]..=high[1]).contains(&y)
                });
                let nearest = near
                    .map(|((_, class, line), _)| (distance(line, [x, y]), *class))
                    .min_by(|one, other| one.0.0.total_cmp(&other.0.0));
                let ((nearest_m, is_beside), class) =
                    nearest.unwrap_or(((f64::INFINITY, false), 9));
                let way = part.triangles[number].iter().find_map(|k| part.ways.get(*k));
                match way {
                    // Half of the widest road is 12 m, and a mitre extends twice as far.
                    Some(_) if nearest_m > 26.0 && is_inside(tile, [x, y], 30.0) => {
                        return Err(format!("{}: a road {nearest_m} m from any", tile.name));
                    }
                    // The narrowest road is a path of 1.5 m or more. Ends and sharp bends are cut
                    // off square.
                    None if nearest_m < 0.5 && is_beside && has_all => {
                        return Err(format!(
                            "{}: no road at {x} {y}, {nearest_m} m from the middle of one of class {class}",
                            tile.name
                        ));
                    }
                    Some(_) => seen[0] += 1,
                    None => seen[1] += 1,
                }
            }
        }
    }
    if seen.iter().all(|count| *count > 1000) { Ok(()) } else { Err(format!("only {seen:?}")) }
}

/// The rectangle around a line with a margin of 30 m.
fn around(line: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let all = |pick: fn(f64, f64) -> f64, axis: usize| {
        line.iter().map(|at| at[axis]).reduce(pick).unwrap()
    };
    [
        [all(f64::min, 0) - 30.0, all(f64::min, 1) - 30.0],
        [all(f64::max, 0) + 30.0, all(f64::max, 1) + 30.0],
    ]
}

fn is_inside(tile: &Tile, [x, y]: [f64; 2], margin: f64) -> bool {
    let [west, south, east, north] = tile.ground.bounds;
    x > west + margin && x < east - margin && y > south + margin && y < north - margin
}

/// The distance to a line, and whether its nearest point is within a segment, rather than at a bend
/// or an end.
fn distance(line: &[[f64; 2]], [x, y]: [f64; 2]) -> (f64, bool) {
    let of_segment = |pair: &[[f64; 2]]| {
        let ([ax, ay], [bx, by]) = (pair[0], pair[1]);
        let (dx, dy) = (bx - ax, by - ay);
        let share = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy);
        let is_within = (0.0..=1.0).contains(&share);
        let share = share.clamp(0.0, 1.0);
        ((ax + share * dx - x).hypot(ay + share * dy - y), is_within)
    };
    let all = line.windows(2).map(of_segment);
    all.min_by(|one, other| one.0.total_cmp(&other.0)).unwrap()
}
