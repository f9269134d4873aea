//! The sea of an extract: its coastlines, closed along the edge of what the extract and the data cover.

use std::path::PathBuf;

use corniche_areas::{Area, AreaClass, AreaObject, Coastline, Polygon, close_sea};
use corniche_geom::{GridFrame, LatticeBounds, LatticePoint, Projection, wgs84};
use corniche_osm::{AreaLoss, AreaSummary, Defect};

use crate::{BuildError, extract_bounds};

/// The sea is no object of OSM.
const SEA: AreaObject = AreaObject::Way(0);
/// Each side of the boxes in extracts is looked at in so many places.
const PLACES_PER_SIDE: usize = 33;

/// Where the sea is made of coastlines.
#[derive(Clone, Copy)]
pub(crate) struct SeaPlace<'a> {
    /// The extracts, whose headers may say what they cover.
    pub(crate) osm: &'a [PathBuf],
    /// What the data cover.
    pub(crate) data: LatticeBounds,
    pub(crate) frame: &'a GridFrame,
    pub(crate) projection: &'a (dyn Projection + Sync),
}

impl SeaPlace<'_> {
    /// What both the data and the extracts cover, as far as these have boxes in their headers: beyond, coastlines are missing.
    fn bounds(&self) -> Result<LatticeBounds, BuildError> {
        let boxes: Result<Option<Vec<[f64; 4]>>, _> =
            self.osm.iter().map(|path| corniche_osm::header_bounds_deg(path)).collect();
        let data = self.data_on_map();
        let Some(boxes) = boxes.map_err(BuildError::Osm)? else { return Ok(data) };
        let around = extract_bounds::around(&boxes);
        let covered = inner_rectangle(around, self.frame, self.projection);
        let both = covered.map(|covered| data.intersection(&covered));
        Ok(both.filter(has_area).unwrap_or(data))
    }

    /// The data's rectangle as far as the map of the earth goes: where it is cut open, coastlines end.
    fn data_on_map(&self) -> LatticeBounds {
        let Some(seam) = self.projection.seam() else { return self.data };
        let [west, east] = seam.on_lattice(self.frame).ends().map(|end| end as i64);
        let LatticeBounds { min, max } = self.data;
        LatticeBounds {
            min: LatticePoint::new(min.u.max(west), min.v),
            max: LatticePoint::new(max.u.min(east), max.v),
        }
    }

    /// Makes the sea, if there are coastlines, and counts it in `summary`, and what is wrong with coastlines.
    pub(crate) fn close(
        &self,
        summary: &mut AreaSummary,
        on_defect: &mut dyn FnMut(Defect),
    ) -> Result<Option<Area>, BuildError> {
        let coastlines: Vec<Coastline> = std::mem::take(&mut summary.coastlines);
        let Some(first) = coastlines.iter().map(|coastline| coastline.way_id).min() else {
            return Ok(None);
        };
        let closed = close_sea(coastlines, &self.bounds()?);
        let (polygons, left_out) = match closed {
            Ok(sea) => {
                let open = sea.bridged.into_iter();
                open.for_each(|way_id| on_defect(Defect::OpenCoastline { way_id }));
                (sea.polygons, sea.left_out)
            }
            Err(_) => (Vec::new(), vec![first]),
        };
        let loss = AreaLoss::ContradictingCoastline;
        for &id in &left_out {
            on_defect(Defect::LostArea { is_relation: false, id, loss });
        }
        if !left_out.is_empty() {
            summary.objects += left_out.len() as u64;
            *summary.lost.entry(loss).or_default() += left_out.len() as u64;
        }
        if polygons.is_empty() {
            return Ok(None);
        }
        let area_m2 = polygons.iter().map(|polygon| self.area_m2(polygon)).sum();
        summary.objects += 1;
        let kept = summary.kept.entry(AreaClass::Sea).or_default();
        kept.areas += 1;
        kept.polygons += polygons.len() as u64;
        let rings = polygons.iter().flat_map(Polygon::rings);
        kept.points += rings.map(|ring| ring.points().len() as u64).sum::<u64>();
        kept.area_m2 += area_m2;
        Ok(Some(Area { object: SEA, class: AreaClass::Sea, name: None, polygons, area_m2 }))
    }

    /// The true area. Long straight edges are taken as if they were straight in degrees.
    fn area_m2(&self, polygon: &Polygon) -> f64 {
        let of_ring = |points: &[LatticePoint]| {
            let mut positions: Vec<[f64; 2]> =
                points.iter().map(|&point| self.frame.position_m(point)).collect();
            match self.projection.wgs84_from_working(&mut positions) {
                Ok(()) => wgs84::area_m2(&positions),
                // What was projected from degrees goes back.
                Err(_) => 0.0,
            }
        };
        polygon.rings().map(|ring| of_ring(ring.points())).sum()
    }
}

/// The largest rectangle of the lattice inside a box in degrees; `None` if there is none.
fn inner_rectangle(
    [west, south, east, north]: [f64; 4],
    frame: &GridFrame,
    projection: &dyn Projection,
) -> Option<LatticeBounds> {
    let side = |from: [f64; 2], to: [f64; 2]| -> Option<Vec<LatticePoint>> {
        let share = |index: usize| index as f64 / (PLACES_PER_SIDE - 1) as f64;
        let mut positions: Vec<[f64; 2]> = (0..PLACES_PER_SIDE)
            .map(|index| [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * share(index)))
            .collect();
        projection.working_from_wgs84(&mut positions).ok()?;
        positions.into_iter().map(|position_m| frame.snap(position_m)).collect()
    };
    let min_u = side([west, south], [west, north])?.iter().map(|point| point.u).max()?;
    let max_u = side([east, south], [east, north])?.iter().map(|point| point.u).min()?;
    let min_v = side([west, south], [east, south])?.iter().map(|point| point.v).max()?;
    let max_v = side([west, north], [east, north])?.iter().map(|point| point.v).min()?;
    let bounds = LatticeBounds {
        min: LatticePoint::new(min_u, min_v),
        max: LatticePoint::new(max_u, max_v),
    };
    Some(bounds).filter(has_area)
}

const fn has_area(bounds: &LatticeBounds) -> bool {
    bounds.min.u < bounds.max.u && bounds.min.v < bounds.max.v
}
