//! The image of a polygon in the working CRS, and on the lattice of a package.

use corniche_geom::{Bounds, GridFrame, LatticePoint, LatticeRegion, Seam, along};

use crate::crs::horizontal::GridCrs;
use crate::crs::operation::CrsOperation;
use crate::polygon::{FileRing, PolygonRings, RegionPolygons};
use crate::{CrsError, PolygonError};

/// Edges that are curved in the working CRS are approximated to this tolerance, in cells.
const TOLERANCE_CELLS: f64 = 0.01;
/// The largest number of times that an edge is halved: an edge that is still curved then crosses a
/// discontinuity of the CRS.
const MOST_HALVINGS: u32 = 24;

impl GridCrs {
    /// The rectangle around a polygon in working metres, over data in `area_deg`, with cells of
    /// `cell_m`.
    ///
    /// # Errors
    /// When the polygon has no position in the CRS.
    pub fn polygon_bounds_m(
        &self,
        polygon: &RegionPolygons,
        area_deg: Bounds,
        cell_m: f64,
    ) -> Result<Bounds, PolygonError> {
        let parts = self.polygon_parts_m(polygon, area_deg, cell_m)?;
        Ok(Bounds::around(parts.iter().flatten().flatten()))
    }

    /// A polygon on the lattice of a package over data in `area_deg`: the same to the last step as
    /// when the package was built.
    ///
    /// # Errors
    /// When the polygon has no position in the CRS, or encloses no area.
    pub fn polygon_on_lattice(
        &self,
        polygon: &RegionPolygons,
        area_deg: Bounds,
        frame: &GridFrame,
    ) -> Result<LatticeRegion, PolygonError> {
        let ring = |ring: &FileRing| -> Option<Vec<LatticePoint>> {
            ring.iter().map(|&corner| frame.snap(corner)).collect()
        };
        let parts = self.polygon_parts_m(polygon, area_deg, frame.cell().shorter_m())?;
        let parts: Option<Vec<Vec<Vec<LatticePoint>>>> =
            parts.iter().map(|rings| rings.iter().map(ring).collect()).collect();
        let parts = parts.ok_or_else(|| self.outside(polygon))?;
        let no_area = || PolygonError::NoArea { path: polygon.path().to_path_buf() };
        LatticeRegion::new(&parts).ok_or_else(no_area)
    }

    /// The rings of each part in working metres. Corners are added where edges are curved.
    fn polygon_parts_m(
        &self,
        polygon: &RegionPolygons,
        area_deg: Bounds,
        cell_m: f64,
    ) -> Result<Vec<Vec<FileRing>>, PolygonError> {
        let carried = |part| {
            let rings = of_part(part, self, area_deg, cell_m * TOLERANCE_CELLS)?;
            rings.ok_or_else(|| self.outside(polygon))
        };
        polygon.parts().iter().map(carried).collect()
    }

    fn outside(&self, polygon: &RegionPolygons) -> PolygonError {
        let (path, crs) = (polygon.path().to_path_buf(), self.crs.label.clone());
        PolygonError::OutsideCrs { path, crs }
    }
}

/// The rings of a part in working metres, next to the middle of the data; `None` where the CRS ends
/// or is discontinuous.
fn of_part(
    part: &PolygonRings,
    working: &GridCrs,
    area_deg: Bounds,
    tolerance_m: f64,
) -> Result<Option<Vec<FileRing>>, CrsError> {
    let operation = CrsOperation::into_working(&part.crs, working, Some(area_deg)).around(None);
    let seam_m = working.seam_m();
    let mut rings: Vec<FileRing> = Vec::with_capacity(part.rings.len());
    let mut center_m = None;
    for ring in &part.rings {
        let Some(mut ring) = of_ring(ring, &operation, seam_m, tolerance_m)? else {
            return Ok(None);
        };
        if let Some(seam_m) = seam_m {
            // The outer ring is moved next to the middle of the data, and holes are moved with it.
            let [own, _] = Bounds::around(&ring).center();
            let near = *center_m.get_or_insert(own - seam_m.turn() * seam_m.turns(own));
            let away = seam_m.turn() * seam_m.around(near).turns(own);
            for corner in &mut ring {
                corner[0] -= away;
            }
        }
        rings.push(ring);
    }
    Ok(Some(rings))
}

/// A corner, its image, and whether the edge to the next corner needs no more corners.
#[derive(Clone, Copy)]
struct Corner {
    own: [f64; 2],
    image: [f64; 2],
    is_done: bool,
}

/// A ring in working metres. Longitudes are continuous along the ring.
fn of_ring(
    ring: &FileRing,
    operation: &CrsOperation,
    seam_m: Option<Seam>,
    tolerance_m: f64,
) -> Result<Option<FileRing>, CrsError> {
    let carry = |own: &[[f64; 2]]| -> Result<Option<Vec<[f64; 2]>>, CrsError> {
        let mut images = own.to_vec();
        operation.apply(&mut images)?;
        Ok(images.iter().flatten().all(|value| value.is_finite()).then_some(images))
    };
    let beside = |image: [f64; 2], near: [f64; 2]| match seam_m {
        Some(seam_m) => [seam_m.around(near[0]).image(image[0]), image[1]],
        None => image,
    };
    let Some(mut images) = carry(ring)? else { return Ok(None) };
    if let (Some(&first), Some(seam_m)) = (images.first(), seam_m) {
        seam_m.around(first[0]).unroll(&mut images);
    }
    if let (Some(first), Some(last), Some(seam_m)) = (images.first(), images.last(), seam_m)
        && seam_m.parts(first, last)
    {
        // The ring encloses a pole.
        return Ok(None);
    }
    if operation.is_identity() {
        return Ok(Some(images));
    }
    let mut corners: Vec<Corner> = ring
        .iter()
        .zip(images)
        .map(|(&own, image)| Corner { own, image, is_done: false })
        .collect();
    for _ in 0..MOST_HALVINGS {
        let next = |index: usize| corners[(index + 1) % corners.len()];
        let open: Vec<usize> =
            (0..corners.len()).filter(|&index| !corners[index].is_done).collect();
        // Points at a quarter and half along each edge: an edge with the shape of an S is straight
        // at its middle.
        let probes: Vec<[f64; 2]> = open
            .iter()
            .flat_map(|&index| [0.25, 0.5].map(|t| along(corners[index].own, next(index).own, t)))
            .collect();
        let Some(found) = carry(&probes)? else { return Ok(None) };
        let mut middles = vec![None; corners.len()];
        for (&index, (found, own)) in open.iter().zip(found.chunks(2).zip(probes.chunks(2))) {
            let (from, to) = (corners[index].image, next(index).image);
            let to = beside(to, from);
            let found = [beside(found[0], from), beside(found[1], from)];
            let off = |image: [f64; 2], t: f64| {
                let straight = along(from, to, t);
                (image[0] - straight[0]).hypot(image[1] - straight[1])
            };
            if off(found[0], 0.25) > tolerance_m || off(found[1], 0.5) > tolerance_m {
                middles[index] = Some(Corner { own: own[1], image: found[1], is_done: false });
            }
        }
        let all_done = middles.iter().all(Option::is_none);
        let refined = corners.iter().zip(&middles).flat_map(|(corner, middle)| {
            let is_done = corner.is_done || middle.is_none();
            [Some(Corner { is_done, ..*corner }), *middle].into_iter().flatten()
        });
        corners = refined.collect();
        if all_done {
            return Ok(Some(corners.iter().map(|corner| corner.image).collect()));
        }
    }
    Ok(None)
}
