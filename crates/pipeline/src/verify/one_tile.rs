//! One tile by itself and beside the tiles above it.

use std::{collections::BTreeMap, rc::Rc};

use corniche_geom::TileId;
use corniche_tileset::{FilePackage, Sections, Terrain, TilePayload, decode, payload_sizes};

use super::{
    attributes::{self, WayFacts},
    checks::{CheckId, Findings},
    geo_against_sv, relief,
    report::GapFigures,
    roads_of_parent, roads_on_tin, seams,
    tile_place::TilePlace,
    tile_sums::{Kept, TileSums},
    tin_against_parent::{self, Level},
    triangle_soup::TriangleSoup,
};
use crate::levels::Levels;

/// What a worker found in a tile.
pub(crate) struct Found {
    pub(crate) kept: Option<Kept>,
    pub(crate) findings: Findings,
    pub(crate) gaps: GapFigures,
    pub(crate) length_m: f64,
    pub(crate) ways: Vec<(i64, WayFacts)>,
    pub(crate) sums: TileSums,
    pub(crate) damage: Option<String>,
}

impl Found {
    fn empty(id: TileId) -> Self {
        Self {
            kept: None,
            findings: Findings::default(),
            gaps: GapFigures { level: id.z(), ..GapFigures::default() },
            length_m: 0.0,
            ways: Vec::new(),
            sums: TileSums::default(),
            damage: None,
        }
    }

    fn damaged(id: TileId, damage: String) -> Self {
        Self { damage: Some(damage), ..Self::empty(id) }
    }
}

/// A tile with its ground, kept for the tiles beneath.
pub(crate) struct Parent {
    payload: TilePayload,
    ground: TriangleSoup,
}

/// The loaded ancestors of the tile checked last. The next tile shares most of them.
pub(crate) type Ancestors = BTreeMap<TileId, Option<Rc<Parent>>>;

impl Parent {
    fn level(&self) -> Option<Level<'_>> {
        let error_m = self.payload.terrain.as_ref()?.geometric_error_m;
        Some(Level { id: self.payload.id, ground: &self.ground, error_m })
    }
}

pub(crate) fn look_at(
    package: &FilePackage,
    id: TileId,
    levels: Option<&Levels>,
    above: &mut Ancestors,
) -> Found {
    let manifest = package.manifest();
    let quantum_m = manifest.vertical.quantum_m;
    let bytes = match package.tile(id) {
        Ok(Some(bytes)) => bytes,
        Ok(None) => return Found::damaged(id, format!("tile {id} is listed but not there")),
        Err(error) => return Found::damaged(id, chain(&error)),
    };
    let read = decode(&bytes, id, &manifest.frame, quantum_m, Sections::ALL)
        .and_then(|payload| Ok((payload, payload_sizes(&bytes, id)?)));
    let (payload, sizes) = match read {
        Ok(read) => read,
        Err(error) => return Found::damaged(id, chain(&error)),
    };
    let mut findings = Findings::default();
    let least_class = manifest.levels.get(usize::from(id.z())).and_then(|level| level.least_class);
    let ways = attributes::of_tile(&payload, least_class, &mut findings);
    roads_on_tin::verify_order(&payload, &mut findings);
    let bounds = manifest.frame.tile_lattice_bounds(id);
    let mut found =
        Found { ways, sums: TileSums::of(&payload, &sizes, bounds), ..Found::empty(id) };
    let Some(terrain) = &payload.terrain else {
        let bare = payload.roads_geo.is_empty() && payload.roads_sv.is_empty();
        findings.look(CheckId::OnTin, bare, || format!("tile {id} has roads but no ground"));
        return Found { findings, ..found };
    };
    let place = TilePlace::of(&manifest.frame, id);
    let ground = TriangleSoup::placed(&terrain.tin, quantum_m, place.steps);
    let on_tin =
        roads_on_tin::verify_on_tin(&payload, &terrain.tin, &ground, manifest, &mut findings);
    (found.gaps, found.length_m) = (on_tin.gaps, on_tin.length_m);
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
        let view = geo_against_sv::View {
            payload: &payload,
            ground: &ground,
            place,
            margin_steps,
            quantum_m,
        };
        geo_against_sv::verify_lines(&view, &on_tin.positions, &mut findings);
        geo_against_sv::verify_ranges(&view, &mut findings);
        let parent = id.parent().and_then(|parent| ancestor(package, id, parent, above));
        if let Some(parent) = parent {
            let above = roads_of_parent::Side { payload: &parent.payload, ground: &parent.ground };
            let own = roads_of_parent::Side { payload: &payload, ground: &ground };
            roads_of_parent::verify(&own, &above, levels, &mut findings);
        }
    }
    if id.z() == manifest.frame.max_level() {
        let own = Level { id, ground: &ground, error_m: terrain.geometric_error_m };
        check_ancestors(package, own, above, &mut findings);
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

/// Compares the TIN of a finest tile, and those above it, each with that of its parent.
fn check_ancestors(
    package: &FilePackage,
    own: Level<'_>,
    above: &mut Ancestors,
    findings: &mut Findings,
) {
    let id = own.id;
    let parents: Vec<Rc<Parent>> = (0..id.z())
        .rev()
        .filter_map(|level| ancestor(package, id, id.ancestor(level), above))
        .collect();
    let levels: Vec<Level<'_>> =
        std::iter::once(own).chain(parents.iter().filter_map(|parent| parent.level())).collect();
    tin_against_parent::verify(&package.manifest().frame, &levels, findings);
}

/// A tile above `id`. `None` if it has no ground or cannot be read; the latter is reported when that tile itself is
/// checked.
fn ancestor(
    package: &FilePackage,
    id: TileId,
    wanted: TileId,
    above: &mut Ancestors,
) -> Option<Rc<Parent>> {
    // One tile a level is kept: memory does not grow with the package.
    above.retain(|&kept, _| kept.z() < id.z() && kept == id.ancestor(kept.z()));
    let load = || {
        let manifest = package.manifest();
        let payload = package.payload(wanted, Sections::ALL).ok().flatten()?;
        let tin = &payload.terrain.as_ref()?.tin;
        let steps = TilePlace::of(&manifest.frame, wanted).steps;
        let ground = TriangleSoup::placed(tin, manifest.vertical.quantum_m, steps);
        Some(Rc::new(Parent { payload, ground }))
    };
    above.entry(wanted).or_insert_with(load).clone()
}

/// An error with its causes, on one line.
fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        text = format!("{text}: {cause}");
        source = cause.source();
    }
    text
}
