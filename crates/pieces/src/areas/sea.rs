//! The sea of an extract: its coastlines, closed along the edge of the area that data, extract and
//! bounds cover.

use corniche_areas::{Coastline, Polygon, Ring, close_sea};
use corniche_geom::{GridFrame, Projection};
use corniche_layers::{LayerTable, OsmObject};
use corniche_osm::{AreaLoss, AreaSummary, ExtractDefect, LayerArea};
use corniche_spec::{extent::AreaExtent, true_areas::lattice_ring_m2};

/// The sea, which is not an object of OSM.
const SEA: OsmObject = OsmObject::Way(0);

/// Closes coastlines in an extent to form the sea of a layer, if there are coastlines, and counts
/// the sea and the defects of coastlines in `summary`.
pub(crate) fn close(
    (table, extent): (&LayerTable, &AreaExtent),
    (frame, projection): (&GridFrame, &(dyn Projection + Sync)),
    summary: &mut AreaSummary,
    on_defect: &mut dyn FnMut(ExtractDefect),
) -> Option<LayerArea> {
    let class = table.coastline_class()?;
    let coastlines: Vec<Coastline> = std::mem::take(&mut summary.coastlines);
    let first = coastlines.iter().map(|coastline| coastline.way_id).min()?;
    let closed = close_sea(coastlines, &extent.polygons);
    let (polygons, left_out) = match closed {
        Ok(sea) => {
            let open = sea.bridged.into_iter();
            open.for_each(|way_id| on_defect(ExtractDefect::OpenCoastline { way_id }));
            (sea.polygons, sea.left_out)
        }
        Err(_) => (Vec::new(), vec![first]),
    };
    let loss = AreaLoss::ContradictingCoastline;
    for &id in &left_out {
        on_defect(ExtractDefect::LostArea { object: OsmObject::Way(id), loss });
    }
    if !left_out.is_empty() {
        summary.objects += left_out.len() as u64;
        *summary.lost.entry(loss).or_default() += left_out.len() as u64;
    }
    if polygons.is_empty() {
        return None;
    }
    let of_ring = |ring: &Ring| lattice_ring_m2(ring.points(), frame, projection);
    let area_of = |polygon: &Polygon| polygon.rings().map(of_ring).sum::<f64>();
    let area_m2 = polygons.iter().map(area_of).sum();
    summary.objects += 1;
    let kept = summary.kept.entry(class).or_default();
    kept.areas += 1;
    kept.polygons += polygons.len() as u64;
    let rings = polygons.iter().flat_map(Polygon::rings);
    kept.points += rings.map(|ring| ring.points().len() as u64).sum::<u64>();
    kept.area_m2 += area_m2;
    let values = vec![None; table.attributes().count()];
    Some(LayerArea { object: SEA, class, values, polygons, area_m2 })
}
