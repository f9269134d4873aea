//! Decodes the boundaries of all tiles, and compares them with the manifest.

use corniche_geom::{LatticeBounds, TileId};
use corniche_pieces::layers::tile_section::SectionOfTile;
use corniche_tileset::{FilePackage, LineCounts, LineRecord, decode_boundaries, payload_sizes};
use corniche_work::Stage;

use super::{
    checks::{CheckId, Findings},
    each_tile::{OfTile, VerifyRun, check_totals, look_at_layer, recorded},
    error::VerifyError,
};

pub(crate) fn verify(run: &VerifyRun<'_>, findings: &mut Findings) -> Result<(), VerifyError> {
    let package = run.package;
    let manifest = package.manifest();
    let (record, sums) = (&manifest.boundaries, CheckId::BoundarySums);
    findings.look(sums, record.is_some() == manifest.settings.boundaries, || {
        "boundaries are counted but the settings do not include them, or the other way round"
            .to_owned()
    });
    let levels = record.iter().flat_map(|lines| &lines.levels);
    let recorded = (sums, levels.map(recorded).collect());
    look_at_layer(run, Stage::VerifyBoundaries, |id| look_at(package, id), recorded, findings)?;
    if let Some(lines) = record {
        let LineCounts { ways, kept, lost } = &lines.counts;
        let kept = kept.iter().map(|kept| kept.ways);
        check_totals(sums, "ways", *ways, kept, lost, findings);
    }
    Ok(())
}

fn look_at(package: &FilePackage, id: TileId) -> OfTile {
    let mut found = OfTile::default();
    // Unreadable tiles are reported by the check of tiles.
    let Some(payload) = package.tile(id).ok().flatten() else { return found };
    let manifest = package.manifest();
    let Ok(lines) = decode_boundaries(&payload, id) else { return found };
    let margin_m = manifest.levels.get(usize::from(id.z())).map_or(0.0, |of| of.width_margin_m);
    // Two steps for rounding.
    let margin = (margin_m / manifest.frame.lattice_step_m()).ceil() as i64 + 2;
    let around = manifest.frame.tile_lattice_bounds(id).expanded(margin);
    for line in &lines {
        found.findings.look(CheckId::BoundaryPlaces, is_near(line, &around), || {
            format!("way {} in tile {id}", line.way_id)
        });
    }
    let is_sorted = lines.is_sorted_by_key(|of| (of.class, of.way_id));
    found.findings.look(CheckId::BoundaryOrder, is_sorted, || format!("tile {id}"));
    let points = lines.iter().map(|line| line.points.len() as u64).sum();
    let bytes = payload_sizes(&payload, id).map_or(0, |sizes| sizes.boundaries.stored);
    found.counts = SectionOfTile { parts: lines.len() as u64, points, bytes };
    found
}

/// Whether the rectangle of each segment touches these bounds.
fn is_near(line: &LineRecord, around: &LatticeBounds) -> bool {
    line.points
        .array_windows::<2>()
        .all(|pair| LatticeBounds::around(pair).is_some_and(|segment| segment.intersects(around)))
}
