//! Reads an extract onto the lattice of a package.

use std::{
    path::PathBuf,
    sync::{Mutex, PoisonError},
};

use corniche_geom::{GridFrame, LatticePoint, ProjectError, Projection, TILE_CELLS};
use corniche_osm::{OnProgress, ReadOsmError, ReadRequest};
use corniche_roads::FrcTable;
use corniche_spec::{BuildObserver, true_areas::degrees_ring_m2};
use corniche_store::ScratchSpace;
use corniche_work::locked;

use super::kept::not_read;
use crate::ExtractError;

/// Reads extracts for a package.
pub struct PlacedReading<'a> {
    /// The extracts; at least one.
    pub osm: &'a [PathBuf],
    /// Which `highway` values are roads, and their classes.
    pub table: &'a FrcTable,
    /// The package's grid.
    pub frame: &'a GridFrame,
    /// WGS84 ⇄ the grid's working CRS.
    pub projection: &'a (dyn Projection + Sync),
    /// Whether roads include the ids of their nodes.
    pub node_ids: bool,
    /// Threads for reading.
    pub pool: &'a rayon::ThreadPool,
    /// Memory for sorting.
    pub memory_bytes: u64,
}

impl PlacedReading<'_> {
    /// Lets `read` read the extracts. Fails if a point cannot be projected.
    ///
    /// # Errors
    /// See [`ExtractError`].
    pub fn read(
        &self,
        scratch: &dyn ScratchSpace,
        (observer, on_progress): (&dyn BuildObserver, &OnProgress<'_>),
        read: impl FnOnce(&ReadRequest<'_>) -> Result<(), ReadOsmError>,
    ) -> Result<(), ExtractError> {
        let unprojected = Mutex::new(None);
        let place = |positions_deg: &[[f64; 2]]| {
            place(positions_deg, self.frame, self.projection).unwrap_or_else(|error| {
                // The points are not the cause: the run fails with this error after reading.
                *locked(&unprojected) = Some(error);
                vec![None; positions_deg.len()]
            })
        };
        let Some((path, others)) = self.osm.split_first() else { return Ok(()) };
        let cell_steps = self.frame.node_steps(self.frame.max_level());
        let done = read(&ReadRequest {
            path,
            others,
            table: self.table,
            place: &place,
            ring_area_m2: &|ring_deg| degrees_ring_m2(ring_deg, self.projection),
            seam: self.projection.seam().map(|seam| seam.on_lattice(self.frame)),
            square_steps: TILE_CELLS * cell_steps[0].min(cell_steps[1]),
            node_ids: self.node_ids,
            pool: self.pool,
            memory_bytes: self.memory_bytes,
            scratch,
            on_progress: Some(on_progress),
        });
        observer.check()?;
        done.map_err(not_read)?;
        match unprojected.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some(error) => Err(ExtractError::Project(error)),
            None => Ok(()),
        }
    }
}

fn place(
    positions_deg: &[[f64; 2]],
    frame: &GridFrame,
    projection: &dyn Projection,
) -> Result<Vec<Option<LatticePoint>>, ProjectError> {
    let mut positions = positions_deg.to_vec();
    projection.working_from_wgs84(&mut positions)?;
    Ok(positions.into_iter().map(|position_m| frame.snap(position_m)).collect())
}
