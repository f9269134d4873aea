//! Step *tiles*: each finest tile in one task, from its heights to its payload and record; then the coarse tiles above, within
//! the subtree.

use corniche_dem::{Dem, Reader};
use corniche_geom::TileId;
use corniche_ground::{heights::finest::FinestHeights, terrain::ground::GroundSource};
use corniche_spec::artifacts::Kind;
use corniche_work::Stage;

use super::{coarse_tiles, recorded_tiles, roads, top};
use crate::{
    BuildError,
    context::Context,
    tile::{
        encode,
        measure::{Column, Grounds},
        mesh::mesh_tile,
        record::{Seen, TileDeviation, TileRecord},
        relief,
    },
};

/// Makes all tiles beneath and at `scope` that are not there yet. All heights and roads must be there: those of neighbours decide
/// which borders are a tile's own.
pub(crate) fn make(context: &Context<'_>, scope: TileId) -> Result<(), BuildError> {
    top::check_done(context)?;
    roads::check_done(context)?;
    let dem = match context.source {
        GroundSource::Dem(dem) => dem,
        GroundSource::Package(terrain) => return recorded_tiles::make(context, terrain, scope),
    };
    context.pyramid_of(dem).check_complete(scope)?;
    // Tiles above the subtree are there unless heights were made for larger subtrees.
    let mut coarse: Vec<TileId> = (0..scope.z()).map(|level| scope.ancestor(level)).collect();
    for level in scope.z()..context.frame().max_level() {
        coarse.extend(context.data().above(level).in_order_within(scope));
    }
    top::make_tins(context, coarse)?;
    make_finest(context, dem, scope)?;
    coarse_tiles::make(context, scope)
}

fn make_finest(context: &Context<'_>, dem: &Dem, scope: TileId) -> Result<(), BuildError> {
    let step_m = top::height_step_m(context)?;
    let grounds = Grounds::new(context);
    context.make_missing(
        (Stage::Tiles, Kind::Record),
        context.data().in_order_within(scope),
        || Ok((dem, dem.reader(context.grid))),
        |source, id| make_tile(context, &grounds, source, id, step_m),
    )
}

fn make_tile(
    context: &Context<'_>,
    grounds: &Grounds<'_>,
    (dem, reader): &mut (&Dem, Reader<'_>),
    id: TileId,
    step_m: f64,
) -> Result<(), BuildError> {
    let heights = FinestHeights::get(context.store, id)?;
    let with_halo = heights.as_ref().map(|heights| heights.with_halo(1));
    let with_halo = with_halo.as_ref();
    let meshed = with_halo.map(|heights| mesh_tile(heights, id, context.levels)).transpose()?;
    let meshed = meshed.filter(|meshed| !meshed.tin.is_empty());
    let column = Column::new(context, grounds, id, meshed.as_ref().map(|meshed| &meshed.tin))?;
    let levels = column.measure(context, dem, reader, heights.as_ref())?;
    drop(column);
    let own = levels.last().map_or(Seen::default(), |share| share.seen);
    let owned = || encode::owned_by_heights(context, id, with_halo);
    let record = match meshed.zip(heights.as_ref()) {
        Some((meshed, heights)) => {
            let deviation = TileDeviation::of(own, 0.0, 0.0);
            let relief = relief::of_tile(context, id, &heights.with_halo(2), step_m)?;
            encode::with_ground(context, id, (meshed, relief), deviation, None, owned)?
        }
        None => encode::without_ground(context, id, owned)?,
    };
    Ok(TileRecord { levels, ..record }.put(context.store, id)?)
}
