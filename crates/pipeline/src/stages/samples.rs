//! How far the TINs of all levels are from every used sample of the DEM, where the samples are not the nodes.

use std::collections::BTreeMap;

use corniche_dem::{Dem, GridPlan};
use corniche_geom::{Frame, LatticePoint, TileId};
use corniche_tin::{Placement, Surface};

use super::mesh::{self, Meshes};
use crate::{
    BuildError, Observer, Stage, Storage, levels::Levels, sample_deviation::SampleSums, workers,
};

/// Bytes of memory that a surface takes per triangle: corners, adjacency, fans, vertices, buckets.
const TRIANGLE_BYTES: u64 = 120;

/// What samples are measured against.
pub(crate) struct GroundInput<'a> {
    pub(crate) meshes: &'a Meshes,
    pub(crate) levels: &'a Levels,
    pub(crate) storage: &'a dyn Storage,
    /// Memory in which a worker keeps the tiles that it has used. Blocks of samples are compact and come row by row, so few
    /// tiles of each level are needed again soon. The tile used last is always kept.
    pub(crate) bytes: u64,
}

/// Sums of every level, root first.
pub(crate) fn measure(
    dem: &Dem,
    plan: &GridPlan,
    input: &GroundInput<'_>,
    threads: usize,
    observer: &dyn Observer,
) -> Result<Vec<SampleSums>, BuildError> {
    let levels = input.levels;
    let areas = dem.sample_areas();
    let none = vec![SampleSums::new(levels.quantum_m()); levels.numbers().count()];
    let mut sums = none.clone();
    observer.begin(Stage::Samples, Some(areas.len() as u64));
    workers::in_order_unless_cancelled(
        observer,
        threads,
        areas.len(),
        || {
            let grounds = Grounds { input, surfaces: BTreeMap::new(), bytes: 0, clock: 0 };
            Ok::<_, BuildError>((dem.reader(plan), grounds))
        },
        |(reader, grounds), index| {
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

fn memory_of(surface: &Surface) -> u64 {
    surface.triangles().len() as u64 * TRIANGLE_BYTES
}

/// The tile of a level to which a position belongs: on a border, the tile in the east or south; on the root's own east or
/// south border, the last tile. `None` outside the root.
fn tile_at(frame: &Frame, level: u8, point: LatticePoint) -> Option<TileId> {
    let last = (1_i64 << level) - 1;
    let [x, y] = frame.tile_column_row(level, point);
    let inside = frame.tile_lattice_bounds(TileId::ROOT).contains(point);
    inside.then(|| TileId::new(level, x.min(last) as u32, y.min(last) as u32).ok()).flatten()
}

/// The ground of the tiles used last.
struct Grounds<'a> {
    input: &'a GroundInput<'a>,
    /// Each with the time of its last use.
    surfaces: BTreeMap<TileId, (u64, Surface)>,
    /// The memory that all of them take, estimated.
    bytes: u64,
    clock: u64,
}

impl Grounds<'_> {
    /// Adds a sample to the sums of all levels. Its position is rounded to the lattice, as positions of roads are.
    fn look(
        &mut self,
        point: Option<LatticePoint>,
        height_m: f64,
        sums: &mut [SampleSums],
    ) -> Result<(), BuildError> {
        let levels = self.input.levels;
        let frame = *levels.frame();
        for (level, sums) in levels.numbers().zip(sums) {
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
        let GroundInput { meshes, levels, storage, bytes } = *self.input;
        let Some(&span) = meshes.get(&id) else { return Ok(None) };
        self.clock += 1;
        if !self.surfaces.contains_key(&id) {
            let meshed = mesh::load(storage, id, span)?;
            let placement = Placement::of_tile(levels.frame(), id, levels.quantum_m());
            let surface = Surface::new(&meshed.tin, placement);
            self.bytes += memory_of(&surface);
            while self.bytes > bytes {
                let oldest = self.surfaces.iter().min_by_key(|(_, (asked, _))| *asked);
                let Some(oldest) = oldest.map(|(&id, _)| id) else { break };
                if let Some((_, surface)) = self.surfaces.remove(&oldest) {
                    self.bytes -= memory_of(&surface);
                }
            }
            self.surfaces.insert(id, (0, surface));
        }
        Ok(self.surfaces.get_mut(&id).and_then(|(asked, surface)| {
            *asked = self.clock;
            let triangle = surface.locate(point)?;
            Some(surface.height_at_point_m(triangle, point))
        }))
    }
}
