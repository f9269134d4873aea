//! The grid of a package and the data's rectangle on it.

use corniche_geom::{GridFrame, LatticeBounds, TILE_CELLS, TileId};
use corniche_tileset::Manifest;

use super::checks::{CheckId, Findings};

pub(crate) fn verify(manifest: &Manifest, findings: &mut Findings) {
    let frame = &manifest.frame;
    let [south_west, north_east] = manifest.data_nodes();
    let bounds = manifest.data_bounds.to_array();
    let corners = [
        frame.x_m(south_west.i),
        frame.y_m(south_west.j),
        frame.x_m(north_east.i),
        frame.y_m(north_east.j),
    ];
    findings.look(CheckId::Grid, corners.map(f64::to_bits) == bounds.map(f64::to_bits), || {
        format!("the data's rectangle is {bounds:?}, but the nodes nearest to its corners are at {corners:?}")
    });
    let wanted = GridFrame::covering(frame.origin_m(), frame.cell(), south_west, north_east);
    findings.look(CheckId::Grid, wanted.as_ref() == Ok(frame), || {
        format!("the grid is {frame:?}, the smallest over the data is {wanted:?}")
    });
    let counted = |low: i64, high: i64| u64::try_from(high - low + 1).unwrap_or_default();
    let nodes =
        counted(south_west.i, north_east.i).saturating_mul(counted(south_west.j, north_east.j));
    let said = manifest.counts.samples.nodes;
    findings.look(CheckId::SampleSums, said == nodes, || {
        format!("{said} nodes are counted, the data's rectangle has {nodes}")
    });
}

/// The bounds that were asked for.
pub(crate) fn clip_of(manifest: &Manifest) -> Option<LatticeBounds> {
    Some(manifest.frame.lattice_bounds(manifest.clip.as_ref()?.nodes))
}

/// First and last of the finest tiles on which the data's rectangle lies: its north-western and south-eastern one.
pub(crate) fn data_tiles(manifest: &Manifest) -> Option<[TileId; 2]> {
    let frame = &manifest.frame;
    let [south_west, north_east] = manifest.data_nodes();
    let corner = frame.root_corner();
    let tile = |i: i64, j: i64| {
        let column = u32::try_from((i - corner.i).div_euclid(TILE_CELLS)).ok()?;
        let row = u32::try_from((corner.j - j).div_euclid(TILE_CELLS)).ok()?;
        TileId::new(frame.max_level(), column, row).ok()
    };
    Some([tile(south_west.i, north_east.j)?, tile(north_east.i, south_west.j)?])
}
