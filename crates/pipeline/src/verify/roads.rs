//! P1: every vertex and edge of a geometric road lies on the TIN of its tile, as stored and decoded.

use corniche_geom::{Frame, TileId};
use corniche_tileset::TilePayload;
use corniche_tin::{Placement, Surface};

use super::{Check, GapFigures, ground::Ground};

/// What was found about one tile's roads.
pub(crate) struct RoadFindings {
    pub(crate) on_tin: Check,
    pub(crate) order: Check,
    pub(crate) gaps: GapFigures,
    /// Plan length of the GEO lines.
    pub(crate) length_m: f64,
}

/// The gap that P1 allows on a level with this tolerance.
fn allowed_gap_m(max_error_m: f64) -> f64 {
    (max_error_m / 100.0).max(0.01)
}

pub(crate) fn verify(
    payload: &TilePayload,
    frame: &Frame,
    quantum_m: f64,
    max_error_m: f64,
) -> RoadFindings {
    let id = payload.id;
    let mut findings = RoadFindings {
        on_tin: Check::new("P1: GEO roads lie on their TIN"),
        order: Check::new("roads are sorted by class, way and part"),
        gaps: GapFigures { level: id.z(), ..GapFigures::default() },
        length_m: 0.0,
    };
    let geo = payload.roads_geo.iter().map(|road| (road.class, road.way_id, road.part));
    let sv = payload.roads_sv.iter().map(|road| (road.class, road.way_id, road.part));
    findings.order.look(geo.is_sorted_by(|a, b| a < b), || format!("GEO section of tile {id}"));
    findings.order.look(sv.is_sorted_by(|a, b| a < b), || format!("SV section of tile {id}"));
    let Some(terrain) = &payload.terrain else {
        findings
            .on_tin
            .look(payload.roads_geo.is_empty(), || format!("tile {id} has roads but no ground"));
        return findings;
    };
    let placement = Placement::of_tile(frame, id, quantum_m);
    // The surface turns stored lines into positions, as a reader does; the ground judges them by itself.
    let surface = Surface::new(&terrain.tin, placement);
    let ground = Ground::new(&terrain.tin, quantum_m);
    let step_m = frame.lattice_step_m();
    for road in &payload.roads_geo {
        let name = || format!("way {} part {} in tile {id}", road.way_id, road.part);
        let positions = match corniche_drape::positions(&road.line, &surface) {
            Ok(positions) => positions,
            Err(error) => {
                findings.on_tin.look(false, || format!("{}: {error}", name()));
                continue;
            }
        };
        let in_cells = |p: [f64; 3]| {
            let [east, north] = placement.node_steps.map(|steps| steps as f64);
            [
                (p[0] - placement.corner.u as f64) / east,
                (placement.corner.v as f64 - p[1]) / north,
                p[2],
            ]
        };
        for pair in positions.windows(2) {
            findings.length_m += (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]) * step_m;
            let gap_m = ground.edge_gap_m(in_cells(pair[0]), in_cells(pair[1]));
            findings.gaps.edges += 1;
            findings.gaps.largest_m = findings.gaps.largest_m.max(gap_m.unwrap_or(0.0));
            findings.on_tin.look(
                gap_m.is_some_and(|gap_m| gap_m <= allowed_gap_m(max_error_m)),
                || match gap_m {
                    Some(gap_m) => format!("{} is {gap_m} m off", name()),
                    None => format!("{} has an edge on no single triangle", name()),
                },
            );
        }
    }
    findings
}

/// Whether a tile is at the finest level, where the lengths of roads add up to what the manifest says.
pub(crate) fn counts_for_sums(id: TileId, frame: &Frame) -> bool {
    id.z() == frame.max_level()
}
