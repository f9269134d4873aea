//! What a merge does first: the heights of bridges and tunnels on each level, and their runs by tile.

use corniche_geom::{LatticePoint, TileId};
use corniche_ground::terrain::ground::GroundSource;
use corniche_pieces::{
    ExtractError,
    layers::{
        SectionLayer,
        tile_section::{SectionOfTile, TileSection},
    },
    spans::{
        outer_ground::{OuterGrounds, WholeDem, whole_rectangle},
        solving::SpanSolving,
        span_network::SpanInputs,
        totals::SpanTotals,
    },
};
use corniche_spec::{
    Defect,
    artifacts::{self, Kind},
};
use corniche_tileset::{Sections, decode};
use corniche_tin::Tin;

use crate::{BuildError, context::Context};

/// Solves bridges and tunnels, and keeps the sections of all tiles, if they are wanted and not there yet. All tiles must be there. Tells of what is
/// to be known of them.
pub(crate) fn make(context: &Context<'_>) -> Result<(), BuildError> {
    if !context.settings.roads.spans || context.settings.osm.is_empty() {
        return Ok(());
    }
    let key = Kind::SpanTotals.item(0);
    let kept: Option<SpanTotals> = artifacts::get(context.store, key)?;
    let is_kept = kept.is_some();
    let totals = kept.map_or_else(|| solve(context), Ok)?;
    if let Some(terrain) = context.source.package().filter(|_| totals.without_ground > 0) {
        context.observer.warning(&totals.told_without_ground(terrain.path()));
    }
    if !is_kept {
        artifacts::put(context.store, key, &totals)?;
    }
    for (reason, way_id, node_id) in totals.problems {
        context.observer.defect(&Defect::Span { way_id, node_id, reason });
    }
    Ok(())
}

fn solve(context: &Context<'_>) -> Result<SpanTotals, BuildError> {
    let grid = context.grid;
    let data = grid.clip.map_or(grid.data_bounds, |clip| clip.whole_data_bounds);
    let whole = whole_rectangle(context.frame(), &data);
    let projection = context.source.projection(grid)?;
    let inputs =
        SpanInputs { store: context.store, frame: context.frame(), projection: &projection, whole };
    let (threads, observer) = (context.threads(), context.observer);
    let quantum_m = context.levels.quantum_m();
    let tin = |id| tin_of(context, id);
    let solve = |outer: &dyn OuterGrounds| {
        SpanSolving { of: inputs, quantum_m, tin: &tin, outer, threads, observer }.solve()
    };
    match context.source {
        GroundSource::Package(terrain) => {
            let recorded = terrain.manifest().spans.as_ref();
            Ok(solve(&recorded.map_or(&[][..], |spans| &spans.outer_grounds))?)
        }
        GroundSource::Dem(dem) => {
            let levels = context.levels;
            let dem = WholeDem { dem, plan: grid, levels, whole, threads, observer };
            let mut totals = solve(&dem)?;
            let places: Vec<LatticePoint> = totals.outer.iter().map(|own| own.at).collect();
            totals.inputs = context.inputs.hash_unused(&dem.needed_files(&places)?, observer)?;
            Ok(totals)
        }
    }
}

/// The TIN of a tile, out of its payload; `None` where it has no ground. TINs by themselves are only with the parts that made them.
fn tin_of(context: &Context<'_>, id: TileId) -> Result<Option<Tin>, ExtractError> {
    let key = Kind::Payload.of_tile(id);
    let Some(bytes) = context.store.get(key)? else { return Ok(None) };
    let quantum_m = context.levels.quantum_m();
    let payload = decode(&bytes, id, context.frame(), quantum_m, Sections::TERRAIN)
        .map_err(|error| artifacts::damaged(key, &error))?;
    Ok(payload.terrain.map(|terrain| terrain.tin).filter(|tin| !tin.is_empty()))
}

/// The payload of a tile with its section of spans, and what that takes.
pub(crate) fn added(
    context: &Context<'_>,
    id: TileId,
    payload: Vec<u8>,
) -> Result<(Vec<u8>, SectionOfTile), BuildError> {
    let Some(TileSection { section, parts, points }) =
        TileSection::get(SectionLayer::Spans, context.store, id)?
    else {
        return Ok((payload, SectionOfTile::default()));
    };
    let (bytes, size) = SectionLayer::Spans.add_to(&payload, id, section)?;
    Ok((bytes, SectionOfTile { parts, points, bytes: size.stored }))
}
