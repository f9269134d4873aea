//! P1: every vertex and edge of a GEO road lies on the TIN of its tile, as stored and decoded. Also
//! checks the order of roads.

use std::collections::BTreeMap;

use corniche_roads::{FunctionalRoadClass, Structure};
use corniche_tileset::{Manifest, TilePayload};
use corniche_tin::Tin;

use super::{
    checks::{CheckId, Findings},
    report::GapFigures,
    tile_place::TilePlace,
    triangle_soup::TriangleSoup,
};

/// The findings about the GEO roads of a tile.
#[derive(Default)]
pub(crate) struct OnTin {
    pub gaps: GapFigures,
    /// The true horizontal lengths of the lines, and their number.
    pub lengths: RoadLengths,
    /// The positions of the vertices of each line, as a reader computes them; `None` for an invalid
    /// line.
    pub positions: Vec<Option<Vec<[f64; 3]>>>,
}

/// The lengths of roads by structure, in the order of [`Structure::ALL`].
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct RoadLengths {
    /// True horizontal metres.
    pub by_structure_m: [f64; Structure::ALL.len()],
    /// The number of lines: each part of a way in a tile is one.
    pub lines: [u64; Structure::ALL.len()],
    /// The total tolerance of lengths, because vertices are rounded to the lattice.
    rounding_m: f64,
}

impl RoadLengths {
    /// Adds the lengths of another tile.
    pub(crate) fn add(&mut self, other: Self) {
        for (own, other) in self.by_structure_m.iter_mut().zip(other.by_structure_m) {
            *own += other;
        }
        for (own, other) in self.lines.iter_mut().zip(other.lines) {
            *own += other;
        }
        self.rounding_m += other.rounding_m;
    }

    /// Adds an edge. Its ends may each be half a lattice step off along both axes. Across the edge,
    /// this lengthens the edge by the square of a step divided by its length.
    fn add_edge(&mut self, structure: usize, length_m: f64, step_m: f64) {
        self.by_structure_m[structure] += length_m;
        self.rounding_m += step_m * (step_m / length_m).min(1.0);
    }

    /// The tolerance of a length, because vertices are rounded to the lattice. It is capped at a
    /// hundredth of the length: a package must not get an unlimited tolerance.
    pub(crate) fn rounding_m(&self, length_m: f64) -> f64 {
        self.rounding_m.min(length_m / 100.0)
    }

    /// The total length.
    pub(crate) fn length_m(&self) -> f64 {
        self.by_structure_m.iter().sum()
    }
}

/// The sort key of roads in a section: class, way id, part.
type Key = (FunctionalRoadClass, i64, u32);

/// The gap that P1 allows on a level with this tolerance.
fn allowed_gap_m(max_error_m: f64) -> f64 {
    (max_error_m / 100.0).max(0.01)
}

/// Checks the order of roads and of the parts of ways.
pub(crate) fn verify_order(payload: &TilePayload, findings: &mut Findings) {
    let id = payload.id;
    let geo = payload.roads_geo.iter().map(|road| (road.class, road.way_id, road.part));
    let sv = payload.roads_sv.iter().map(|road| (road.class, road.way_id, road.part));
    let sections: [(&str, Vec<Key>); 2] = [("GEO", geo.collect()), ("SV", sv.collect())];
    for (section, roads) in sections {
        let sorted = roads.is_sorted_by(|a, b| a < b);
        let mut next: BTreeMap<i64, u32> = BTreeMap::new();
        let counted = roads.iter().all(|&(_, way_id, part)| {
            let wanted = next.entry(way_id).or_default();
            *wanted += 1;
            part + 1 == *wanted
        });
        look!(findings, Order, sorted && counted, "{section} section of tile {id}");
    }
}

/// Compares every GEO line with the ground.
pub(crate) fn verify_on_tin(
    payload: &TilePayload,
    tin: &Tin,
    ground: &TriangleSoup,
    manifest: &Manifest,
    findings: &mut Findings,
) -> OnTin {
    let (id, frame) = (payload.id, &manifest.frame);
    let max_error_m =
        manifest.levels.get(usize::from(id.z())).map_or(0.0, |level| level.max_error_m);
    let mut found =
        OnTin { gaps: GapFigures { level: id.z(), ..GapFigures::default() }, ..OnTin::default() };
    // The surface converts stored lines to positions, like a reader; the ground then checks the
    // positions independently.
    let surface = manifest.surface(id, tin);
    let place = TilePlace::from_frame(frame, id);
    let [least_x, least_y] = manifest.scale.least;
    let step_m = frame.lattice_step_m() / least_x.min(least_y);
    let position_m = |[u, v, _]: [f64; 3]| frame.position_of_fraction_m([u, v]);
    let structures: BTreeMap<i64, Structure> = payload
        .attributes
        .iter()
        .map(|record| (record.way_id, record.attributes.structure))
        .collect();
    for road in &payload.roads_geo {
        let structure = structures.get(&road.way_id).copied().unwrap_or_default() as usize;
        found.lengths.lines[structure] += 1;
        let name = || format!("way {} part {} in tile {id}", road.way_id, road.part);
        let positions = match corniche_drape::positions(&road.line, &surface) {
            Ok(positions) => positions,
            Err(error) => {
                look!(findings, OnTin, false, "{}: {error}", name());
                found.positions.push(None);
                continue;
            }
        };
        let in_cells = |p: [f64; 3]| {
            let [column, row] = place.cells(place.local_of([p[0], p[1]]));
            [column, row, p[2]]
        };
        for pair in positions.windows(2) {
            if id.z() == frame.max_level() {
                // The same formula as in the build: near a pole it deviates from the geodesic by
                // more than the tolerance of the sums.
                let ends = [pair[0], pair[1]].map(position_m);
                let length_m = manifest.coordinates.line_length_m(ends);
                found.lengths.add_edge(structure, length_m, step_m);
            }
            let gap_m = ground.edge_gap_m(in_cells(pair[0]), in_cells(pair[1]));
            found.gaps.edges += 1;
            found.gaps.largest_m = found.gaps.largest_m.max(gap_m.unwrap_or(0.0));
            findings.look(
                CheckId::OnTin,
                gap_m.is_some_and(|gap_m| gap_m <= allowed_gap_m(max_error_m)),
                || match gap_m {
                    Some(gap_m) => format!("{} is {gap_m} m off the TIN", name()),
                    None => format!("{} has an edge that is not on one triangle", name()),
                },
            );
        }
        found.positions.push(Some(positions));
    }
    found
}
