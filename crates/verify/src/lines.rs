//! The lines of a layer of all tiles: decoded, and compared with what the manifest says of them.

use corniche_areas::ClassedLayer;
use corniche_geom::{LatticeBounds, TileId};
use corniche_pieces::layers::tile_section::SectionOfTile;
use corniche_spec::Observer;
use corniche_tileset::{FilePackage, LineCounts, LineRecord, decode_lines, payload_sizes};

use super::{
    checks::{CheckId, Findings},
    each_tile::{OfTile, check_totals, look_at_layer, recorded},
    error::VerifyError,
};

/// The checks of a layer.
pub(crate) struct LineChecks {
    places: CheckId,
    order: CheckId,
    sums: CheckId,
    /// Against the extract, tile by tile.
    pub osm: CheckId,
    /// Against the counts of the extract.
    pub(crate) osm_counts: CheckId,
    /// Against the polygon that the package was cut with.
    pub polygon: CheckId,
}

impl LineChecks {
    pub(crate) fn of(layer: ClassedLayer) -> Self {
        match layer {
            ClassedLayer::Boundaries => Self {
                places: CheckId::BoundaryPlaces,
                order: CheckId::BoundaryOrder,
                sums: CheckId::BoundarySums,
                osm: CheckId::OsmBoundaries,
                osm_counts: CheckId::OsmBoundaryCounts,
                polygon: CheckId::BoundaryPolygon,
            },
        }
    }
}

pub(crate) fn verify(
    package: &FilePackage,
    layer: ClassedLayer,
    threads: usize,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let manifest = package.manifest();
    let (record, sums) = (manifest.lines(layer), LineChecks::of(layer).sums);
    let is_wanted = manifest.settings.lines().contains(&layer);
    findings.look(sums, record.is_some() == is_wanted, || {
        format!("{} are counted and were not asked for, or the other way round", layer.name())
    });
    let levels = record.iter().flat_map(|lines| &lines.levels);
    let recorded = (sums, levels.map(recorded).collect());
    let look_at = |id| look_at(package, layer, id);
    look_at_layer((package, threads), look_at, recorded, findings, observer)?;
    if let Some(lines) = record {
        let LineCounts { ways, kept, lost } = &lines.counts;
        let kept = kept.iter().map(|kept| kept.ways);
        check_totals(sums, "ways", (*ways, kept, lost), findings);
    }
    Ok(())
}

fn look_at(package: &FilePackage, layer: ClassedLayer, id: TileId) -> OfTile {
    let mut found = OfTile::default();
    // Tiles that cannot be read are told elsewhere.
    let Some(payload) = package.tile(id).ok().flatten() else { return found };
    let manifest = package.manifest();
    let LineChecks { places, order, .. } = LineChecks::of(layer);
    let Ok(lines) = decode_lines(&payload, id, layer) else { return found };
    let margin_m = manifest.levels.get(usize::from(id.z())).map_or(0.0, |of| of.width_margin_m);
    // Two steps for rounding.
    let margin = (margin_m / manifest.frame.lattice_step_m()).ceil() as i64 + 2;
    let around = manifest.frame.tile_lattice_bounds(id).expanded(margin);
    for line in &lines {
        found
            .findings
            .look(places, is_near(line, &around), || format!("way {} on tile {id}", line.way_id));
    }
    let is_sorted = lines.is_sorted_by_key(|of| (of.class, of.way_id));
    found.findings.look(order, is_sorted, || format!("tile {id}"));
    let points = lines.iter().map(|line| line.points.len() as u64).sum();
    let bytes = payload_sizes(&payload, id).map_or(0, |sizes| sizes.lines[layer as usize].stored);
    found.counts = SectionOfTile { parts: lines.len() as u64, points, bytes };
    found
}

/// Whether the rectangle of each segment touches these bounds.
fn is_near(line: &LineRecord, around: &LatticeBounds) -> bool {
    line.points
        .array_windows::<2>()
        .all(|pair| LatticeBounds::of(pair).is_some_and(|segment| segment.intersects(around)))
}
