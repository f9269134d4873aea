//! An extract is read onto the lattice of a package.

use std::{
    path::PathBuf,
    sync::{Mutex, PoisonError},
};

use corniche_geom::{GridFrame, LatticePoint, ProjectError, Projection, TILE_CELLS};
use corniche_osm::{OnProgress, ReadOsmError, ReadRequest};
use corniche_roads::FrcTable;
use corniche_store::Scratch;

use super::kept::not_read;
use crate::{BuildError, Observer, true_areas::degrees_ring_m2};

/// How extracts are read for a package.
pub(crate) struct PlacedReading<'a> {
    /// Never empty.
    pub(crate) osm: &'a [PathBuf],
    pub(crate) table: &'a FrcTable,
    pub(crate) frame: &'a GridFrame,
    pub(crate) projection: &'a (dyn Projection + Sync),
    /// Whether roads come with the ids of their nodes.
    pub(crate) node_ids: bool,
    pub(crate) pool: &'a rayon::ThreadPool,
    /// Memory for sorting.
    pub(crate) memory_bytes: u64,
}

impl PlacedReading<'_> {
    /// Lets `read` read the extracts. Points that cannot be projected make it fail.
    pub(crate) fn read(
        &self,
        scratch: &dyn Scratch,
        (observer, on_progress): (&dyn Observer, &OnProgress<'_>),
        read: impl FnOnce(&ReadRequest<'_>) -> Result<(), ReadOsmError>,
    ) -> Result<(), BuildError> {
        let unprojected = Mutex::new(None);
        let place = |positions_deg: &[[f64; 2]]| {
            place(positions_deg, self.frame, self.projection).unwrap_or_else(|error| {
                // The points are not at fault: the run fails with this error after reading.
                *unprojected.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
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
        if observer.is_cancelled() {
            return Err(BuildError::Interrupted);
        }
        done.map_err(not_read)?;
        match unprojected.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some(error) => Err(BuildError::Project(error)),
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
