//! The error at the DEM's own samples where they are not the nodes: the TINs of all levels at every sample used.

use std::collections::BTreeMap;

use corniche_dem::{Dem, GridPlan};
use corniche_geom::{Frame, LatticePoint, TileId};
use corniche_tin::{Placement, Surface};

use super::{
    levels::Levels,
    mesh::{self, Meshes},
};
use crate::{BuildError, Observer, Stage, Storage, sample_error::SampleSums, workers};

/// Surfaces that a worker keeps. Blocks of samples are compact and come row by row: few tiles of each level are needed
/// again soon.
const SURFACES: usize = 48;

/// Sums of every level, root first.
pub(crate) fn measure(
    dem: &Dem,
    plan: &GridPlan,
    meshes: &Meshes,
    levels: &Levels,
    threads: usize,
    storage: &dyn Storage,
    observer: &dyn Observer,
) -> Result<Vec<SampleSums>, BuildError> {
    let areas = dem.sample_areas();
    let none = vec![SampleSums::new(levels.quantum_m()); levels.numbers().count()];
    let mut sums = none.clone();
    observer.begin(Stage::Samples, Some(areas.len() as u64));
    workers::in_order(
        threads,
        areas.len(),
        || {
            let grounds = Grounds { meshes, levels, storage, surfaces: BTreeMap::new(), clock: 0 };
            Ok((dem.reader(plan)?, grounds))
        },
        |(reader, grounds), index| {
            if observer.is_cancelled() {
                return Err(BuildError::Interrupted);
            }
            let block = reader.used_samples(&areas[index])?;
            let mut found = none.clone();
            for (&position_m, &height_m) in block.positions_m.iter().zip(&block.heights_m) {
                let point = levels.frame().snap(position_m);
                grounds.look(point, f64::from(height_m), &mut found)?;
            }
            Ok(found)
        },
        |_, found| {
            for (sums, found) in sums.iter_mut().zip(&found) {
                sums.merge(found);
            }
            observer.advance(Stage::Samples, 1);
            Ok(())
        },
    )?;
    observer.end(Stage::Samples);
    Ok(sums)
}

/// The tile of a level to which a position belongs: on a border the one in the east or south; the root's own east and south
/// border belong to its last tiles. `None` outside the root.
fn tile_at(frame: &Frame, level: u8, point: LatticePoint) -> Option<TileId> {
    let last = (1_i64 << level) - 1;
    let [x, y] = frame.tile_column_row(level, point);
    let inside = frame.tile_lattice_bounds(TileId::ROOT).contains(point);
    inside.then(|| TileId::new(level, x.min(last) as u32, y.min(last) as u32).ok()).flatten()
}

/// The ground of the tiles looked at last.
struct Grounds<'a> {
    meshes: &'a Meshes,
    levels: &'a Levels,
    storage: &'a dyn Storage,
    /// With the time at which each was last asked.
    surfaces: BTreeMap<TileId, (u64, Surface)>,
    clock: u64,
}

impl Grounds<'_> {
    /// Takes a sample into the sums of all levels. It lies where the lattice has it, as roads do.
    fn look(
        &mut self,
        point: Option<LatticePoint>,
        height_m: f64,
        sums: &mut [SampleSums],
    ) -> Result<(), BuildError> {
        let frame = *self.levels.frame();
        for (level, sums) in self.levels.numbers().zip(sums) {
            let place = point.and_then(|point| Some((tile_at(&frame, level, point)?, point)));
            let distance_m = match place {
                Some((id, point)) => self.ground_m(id, point)?.map(|m| (m - height_m).abs()),
                None => None,
            };
            sums.add(distance_m);
        }
        Ok(())
    }

    /// Height of a tile's ground at a point.
    fn ground_m(&mut self, id: TileId, point: LatticePoint) -> Result<Option<f64>, BuildError> {
        let Some(&span) = self.meshes.get(&id) else { return Ok(None) };
        self.clock += 1;
        if !self.surfaces.contains_key(&id) {
            if self.surfaces.len() >= SURFACES {
                let oldest = self.surfaces.iter().min_by_key(|(_, (asked, _))| *asked);
                if let Some(oldest) = oldest.map(|(&id, _)| id) {
                    self.surfaces.remove(&oldest);
                }
            }
            let meshed = mesh::load(self.storage, id, span)?;
            let placement = Placement::of_tile(self.levels.frame(), id, self.levels.quantum_m());
            self.surfaces.insert(id, (0, Surface::new(&meshed.tin, placement)));
        }
        Ok(self.surfaces.get_mut(&id).and_then(|(asked, surface)| {
            *asked = self.clock;
            let triangle = surface.locate(point)?;
            Some(surface.height_at_point_m(triangle, point))
        }))
    }
}
