//! What a merge does first: the heights of bridges and tunnels on each level, and their runs by tile.

use corniche_geom::TileId;
use corniche_tileset::{Sections, decode};
use corniche_tin::Tin;

use crate::{
    BuildError, Defect,
    artifacts::{self, Kind},
    context::Context,
    layers::{
        SectionLayer,
        tile_section::{SectionOfTile, TileSection},
    },
    spans::{solving::SpanSolving, span_network::SpanInputs, totals::SpanTotals},
};

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
    if !is_kept {
        artifacts::put(context.store, key, &totals)?;
    }
    for (reason, way_id) in totals.problems {
        context.observer.defect(&Defect::Span { way_id, reason });
    }
    Ok(())
}

fn solve(context: &Context<'_>) -> Result<SpanTotals, BuildError> {
    let data = context.node_bounds();
    let inputs = SpanInputs {
        osm: &context.settings.osm,
        store: context.store,
        frame: context.frame(),
        coordinates: context.coordinates,
        within: context.clip().map_or(data, |clip| clip.intersection(&data)),
    };
    let solving = SpanSolving {
        of: inputs,
        quantum_m: context.levels.quantum_m(),
        tin: &|id| tin_of(context, id),
        threads: context.threads(),
        observer: context.observer,
    };
    solving.solve()
}

/// The TIN of a tile, out of its payload; `None` where it has no ground. TINs by themselves are only with the parts that made them.
fn tin_of(context: &Context<'_>, id: TileId) -> Result<Option<Tin>, BuildError> {
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
