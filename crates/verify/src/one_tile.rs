//! One tile by itself and beside the tiles above it.

use corniche_geom::TileId;
use corniche_spec::levels::Levels;
use corniche_tileset::Terrain;

use super::{
    attributes::{self, WayFacts},
    checks::{CheckId, Findings},
    decoded_tiles::DecodedTiles,
    geo_against_sv, relief,
    report::GapFigures,
    roads_of_parent,
    roads_on_tin::{self, RoadLengths},
    seams,
    tile_place::TilePlace,
    tile_sums::{Kept, TileSums},
    tin_against_parent::{self, Level},
};

/// What a worker found in a tile.
#[derive(Default)]
pub(crate) struct Found {
    pub kept: Option<Kept>,
    pub(crate) findings: Findings,
    pub gaps: GapFigures,
    pub(crate) lengths: RoadLengths,
    pub(crate) ways: Vec<(i64, WayFacts)>,
    pub sums: TileSums,
    pub(crate) sv_tail_bytes: u64,
    pub(crate) damage: Option<String>,
}

pub(crate) fn look_at(tiles: &DecodedTiles<'_>, id: TileId, levels: Option<&Levels>) -> Found {
    let manifest = tiles.package.manifest();
    let quantum_m = manifest.vertical.quantum_m;
    let tile = tiles.of(id);
    let (payload, sizes) = match &tile.whole {
        Ok(read) => read,
        Err(damage) => return Found { damage: Some(damage.clone()), ..Found::default() },
    };
    let mut findings = Findings::default();
    let least_class = manifest.levels.get(usize::from(id.z())).and_then(|level| level.least_class);
    let ways = attributes::of_tile(payload, least_class, &mut findings);
    roads_on_tin::verify_order(payload, &mut findings);
    let bounds = manifest.frame.tile_lattice_bounds(id);
    let sums = TileSums::of(payload, sizes, bounds);
    let mut found = Found { ways, sums, sv_tail_bytes: sizes.sv_tail, ..Found::default() };
    let Some(terrain) = &payload.terrain else {
        let bare = payload.roads_geo.is_empty() && payload.roads_sv.is_empty();
        findings.look(CheckId::OnTin, bare, || format!("tile {id} has roads but no ground"));
        return Found { findings, ..found };
    };
    let place = TilePlace::of(&manifest.frame, id);
    let ground = &*tiles.ground(id);
    let on_tin =
        roads_on_tin::verify_on_tin(payload, &terrain.tin, ground, manifest, &mut findings);
    (found.gaps, found.lengths) = (on_tin.gaps, on_tin.lengths);
    check_vertices(id, terrain, quantum_m, &mut findings);
    let has_relief = payload.relief.is_some();
    let settings = &manifest.settings;
    let wants_relief = settings.relief.has(id.z(), manifest.frame.max_level());
    findings.look(CheckId::ReliefThere, has_relief == wants_relief, || {
        let found = if has_relief { "a" } else { "no" };
        format!("tile {id} has {found} relief; the settings say {}", settings.relief.name())
    });
    if let Some(levels) = levels {
        let margin_steps = levels.margin_steps(id.z());
        let view = geo_against_sv::View { payload, ground, place, margin_steps, quantum_m };
        geo_against_sv::verify_lines(&view, &on_tin.positions, &mut findings);
        geo_against_sv::verify_ranges(&view, &mut findings);
        let parent = id.parent().map(|parent| tiles.of(parent));
        let parent = parent.as_ref().and_then(|parent| parent.payload());
        if let Some(parent) = parent.filter(|parent| parent.terrain.is_some()) {
            let ground_above = &*tiles.ground(parent.id);
            let above = roads_of_parent::Side { payload: parent, ground: ground_above };
            let own = roads_of_parent::Side { payload, ground };
            roads_of_parent::verify(&own, &above, levels, &mut findings);
        }
    }
    if id.z() == manifest.frame.max_level() {
        check_ancestors(tiles, id, &mut findings);
    }
    found.kept = Some(Kept {
        vertices: terrain.tin.vertices().len() as u64,
        triangles: terrain.tin.triangles().len() as u64,
        geometric_error_m: terrain.geometric_error_m,
        height_range_m: terrain.height_range_m,
        borders: seams::borders(&terrain.tin),
        relief_borders: payload.relief.as_ref().map(relief::borders),
    });
    Found { findings, ..found }
}

/// Looks at the heights of a TIN's vertices.
fn check_vertices(id: TileId, terrain: &Terrain, quantum_m: f64, findings: &mut Findings) {
    let [low_m, high_m] = terrain.height_range_m;
    // The height of a vertex is that of a node, rounded to the quantum.
    let range_m = low_m - quantum_m / 2.0..=high_m + quantum_m / 2.0;
    for vertex in terrain.tin.vertices() {
        let height_m = f64::from(vertex.height_q) * quantum_m;
        findings.look(CheckId::Vertices, range_m.contains(&height_m), || {
            format!("tile {id} has a vertex at {height_m} m, its range is {low_m} to {high_m} m")
        });
    }
}

/// Compares the TIN of a finest tile, and those above it, each with that of its parent. Tiles above that have no ground or cannot be read
/// are passed over; the latter are told when they are looked at themselves.
fn check_ancestors(tiles: &DecodedTiles<'_>, id: TileId, findings: &mut Findings) {
    let levels: Vec<Level> = (0..=id.z())
        .rev()
        .filter_map(|level| {
            let id = id.ancestor(level);
            let error_m = tiles.of(id).payload()?.terrain.as_ref()?.geometric_error_m;
            Some(Level { id, ground: tiles.ground(id), error_m })
        })
        .collect();
    tin_against_parent::verify(&tiles.package.manifest().frame, &levels, findings);
}
