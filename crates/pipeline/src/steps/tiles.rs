//! Step *tiles*: processes each finest tile in one task, from its heights to its payload and
//! record; then the coarse tiles above, within the subtree.

use corniche_dem::{Dem, HeightReader};
use corniche_geom::TileId;
use corniche_ground::{heights::finest::FinestHeights, terrain::ground::GroundSource};
use corniche_spec::artifacts::ArtifactKind;
use corniche_work::Stage;

use super::{coarse_tiles, recorded_tiles, roads, top};
use crate::{
    BuildError,
    context::BuildContext,
    tile::{
        encode,
        measure::{Column, GroundCache},
        mesh::mesh_tile,
        record::{TileDeviation, TileRecord, TinStatistics},
        relief,
    },
};

/// Creates all missing tiles beneath and at `scope`. All heights and roads must be complete: those
/// of neighbours determine which borders a tile owns.
pub(crate) fn make(context: &BuildContext<'_>, scope: TileId) -> Result<(), BuildError> {
    top::check_done(context)?;
    roads::check_done(context)?;
    let dem = match context.source {
        GroundSource::Dem(dem) => dem,
        GroundSource::Package(terrain) => return recorded_tiles::make(context, terrain, scope),
    };
    context.pyramid_of(dem).check_complete(scope)?;
    // Tiles above the subtree exist unless heights were read for larger subtrees.
    let mut coarse: Vec<TileId> = (0..scope.z()).map(|level| scope.ancestor(level)).collect();
    for level in scope.z()..context.frame().max_level() {
        coarse.extend(context.data().above(level).in_order_within(scope));
    }
    top::make_tins(context, coarse)?;
    make_finest(context, dem, scope)?;
    coarse_tiles::make(context, scope)
}

fn make_finest(context: &BuildContext<'_>, dem: &Dem, scope: TileId) -> Result<(), BuildError> {
    let step_m = top::height_step_m(context)?;
    let grounds = GroundCache::new(context);
    context.make_missing(
        (Stage::Tiles, ArtifactKind::Record),
        context.data().in_order_within(scope),
        || Ok((dem, dem.reader(context.grid))),
        |source, id| make_tile(context, &grounds, source, id, step_m),
    )
}

fn make_tile(
    context: &BuildContext<'_>,
    grounds: &GroundCache<'_>,
    (dem, reader): &mut (&Dem, HeightReader<'_>),
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
    let own = levels.last().map_or(TinStatistics::default(), |share| share.seen);
    let owned = || encode::owned_by_heights(context, id, with_halo);
    let record = match meshed.zip(heights.as_ref()) {
        Some((meshed, heights)) => {
            let deviation = TileDeviation::from_statistics(own, 0.0, 0.0);
            let relief = relief::of_tile(context, id, &heights.with_halo(2), step_m)?;
            encode::with_ground(context, id, (meshed, relief), deviation, None, owned)?
        }
        None => encode::without_ground(context, id, owned)?,
    };
    Ok(TileRecord { levels, ..record }.put(context.store, id)?)
}
