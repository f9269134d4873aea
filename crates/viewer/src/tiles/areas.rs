//! The areas of a tile as volumes: a closed prism over each polygon, from below all ground in the
//! polygon to above it.
//!
//! ```text
//!  rings ──► border strips ──► plan mesh ──► walls (edges with inside on one side alone)
//!                                   │
//!                                   └──────► caps  (triangles inside, once at the bottom, once at the top)
//! ```
//!
//! Walls and caps come from one mesh, so each edge of a prism belongs to exactly two of its faces,
//! with the same ends. Then a ray enters the prism as often as it leaves it, also in the GPU's
//! arithmetic.
//!
//! Source: Schneider & Klein 2007, *Efficient and Accurate Rendering of Vector Data on Virtual
//! Landscapes*, Journal of WSCG 15.

mod border_strips;
mod plan_mesh;

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};
use std::{collections::BTreeSet, convert::Infallible, ops::Range};

use corniche_geom::{
    Bounds, GridFrame, LatticeBounds, LatticePoint, MOST_TILE_STEPS, StepBudget, TileId,
    TooMuchWork,
};
use corniche_layers::OsmObject;
use corniche_tileset::AreaPolygon;

use self::{
    border_strips::{Strip, with_strips},
    plan_mesh::PlanMesh,
};
use super::{GroundMesh, blocks, ground_mesh::relative_in_plan};
use crate::layer_class::LayerClass;

/// How far volumes extend beyond their ground, below and above, as a share of a cell of the tile's
/// level. This is far more than the rounding of the ground's heights when they are drawn.
const PAD_CELLS: f64 = 0.125;

/// Width of the strips along the tile's border, as a share of a cell of the tile's level. This is
/// far more than the rounding of positions on the border when they are drawn.
const STRIP_CELLS: f64 = 0.25;

/// An area that cannot be drawn.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the outline of {object} crosses itself")]
pub struct BadArea {
    /// OSM object of the area.
    pub object: OsmObject,
}

/// An area of a tile.
#[derive(Debug, Clone, PartialEq)]
pub struct TileArea {
    /// Its class.
    pub class: LayerClass,
    /// OSM object of the area.
    pub object: OsmObject,
    /// The parts of the area in the tile.
    pub polygons: Vec<AreaPolygon>,
}

/// Why the areas of a tile cannot be drawn.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum BadAreas {
    /// An area cannot be drawn.
    #[error(transparent)]
    Area(#[from] BadArea),
    /// The areas cover more triangles than any writer can have intended.
    #[error("the areas of the tile cannot be draped on its ground")]
    TooMuch(#[from] TooMuchWork),
}

/// A wall of a volume: upright over a segment of the outline, with the inside on the left.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct AreaWall {
    /// Metres from the tile's reference point, east and north.
    pub start_in_tile: [f32; 2],
    /// End of the wall, metres from the reference point, east and north.
    pub end_in_tile: [f32; 2],
    /// Bottom, without the skirt, and top: true metres above the reference point.
    pub heights_in_tile: [f32; 2],
}

/// A corner of the caps of a volume, at the bottom and at the top.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct AreaCorner {
    /// Metres from the tile's reference point, east and north.
    pub place_in_tile: [f32; 2],
    /// The heights as in [`AreaWall`].
    pub heights_in_tile: [f32; 2],
}

/// The volumes of one class.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ClassVolumes {
    /// The class.
    pub class: LayerClass,
    /// Range of the walls of the class.
    pub walls: Range<u32>,
    /// Range of the indices of the class in [`AreaVolumes::triangles`].
    pub triangles: Range<u32>,
    /// Box around all volumes of the class: west, south and bottom, then east, north and top, in
    /// metres from the reference point.
    pub box_in_tile: [[f32; 3]; 2],
    /// Number of polygons of the class.
    pub polygons: u32,
}

/// All volumes of a tile, by class.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct AreaVolumes {
    /// The walls of the volumes.
    #[serde(with = "blocks::plain")]
    pub walls: Vec<AreaWall>,
    /// Corners of caps.
    #[serde(with = "blocks::plain")]
    pub corners: Vec<AreaCorner>,
    /// Indices of `corners`, three for each triangle of a cap, counter-clockwise seen from above.
    #[serde(with = "blocks::plain")]
    pub triangles: Vec<u32>,
    /// The classes of the tile, in order.
    pub classes: Vec<ClassVolumes>,
    /// The box around all volumes, as [`ClassVolumes::box_in_tile`]; `None` without volumes.
    pub box_in_tile: Option<[[f32; 3]; 2]>,
}

impl AreaVolumes {
    /// Creates the volumes of some areas of a tile over its ground; without ground there are none.
    pub(crate) fn new(
        areas: &[TileArea],
        id: TileId,
        frame: &GridFrame,
        ground: &GroundMesh,
        reference_m: [f64; 3],
    ) -> Result<Self, BadAreas> {
        let work = StepBudget::new(MOST_TILE_STEPS);
        let site = Site::new(id, frame, ground, reference_m);
        Self::by_class(areas.iter().map(|area| area.class), |volumes, class, around| {
            let mut polygons = 0;
            for area in areas.iter().filter(|area| area.class == class) {
                for rings in &area.polygons {
                    let bad = || BadArea { object: area.object };
                    let mesh = site.mesh(rings).ok_or_else(bad)?;
                    work.check()?;
                    let Some(heights) = site.heights_in_tile(&mesh.points, &work) else { continue };
                    volumes.add(&site, &mesh, heights, around);
                    polygons += 1;
                }
            }
            Ok(polygons)
        })
    }

    /// Merges several sets of volumes of one tile.
    #[must_use]
    pub fn joined(parts: &[&Self]) -> Self {
        let classes = parts.iter().flat_map(|part| &part.classes).map(|of| of.class);
        let Ok(joined) = Self::by_class::<Infallible>(classes, |joined, class, around| {
            let mut polygons = 0;
            for part in parts {
                let Some(of) = part.classes.iter().find(|of| of.class == class) else { continue };
                let in_list = |range: &Range<u32>| range.start as usize..range.end as usize;
                let first = joined.corners.len() as u32;
                joined.walls.extend_from_slice(&part.walls[in_list(&of.walls)]);
                joined.corners.extend_from_slice(&part.corners);
                let triangles = part.triangles[in_list(&of.triangles)].iter();
                joined.triangles.extend(triangles.map(|corner| first + corner));
                *around = united(*around, of.box_in_tile);
                polygons += of.polygons;
            }
            Ok(polygons)
        });
        joined
    }

    /// Creates volumes class by class. `add` adds those of a class, extends the box around them,
    /// and returns the number of its polygons.
    fn by_class<E>(
        classes: impl Iterator<Item = LayerClass>,
        mut add: impl FnMut(&mut Self, LayerClass, &mut [[f32; 3]; 2]) -> Result<u32, E>,
    ) -> Result<Self, E> {
        let mut volumes = Self::default();
        for class in classes.collect::<BTreeSet<_>>() {
            let (first_wall, first_index) = (volumes.walls.len(), volumes.triangles.len());
            let mut box_in_tile = NOWHERE;
            let polygons = add(&mut volumes, class, &mut box_in_tile)?;
            if polygons > 0 {
                volumes.classes.push(ClassVolumes {
                    class,
                    walls: first_wall as u32..volumes.walls.len() as u32,
                    triangles: first_index as u32..volumes.triangles.len() as u32,
                    box_in_tile,
                    polygons,
                });
            }
        }
        let boxes = volumes.classes.iter().map(|class| class.box_in_tile);
        volumes.box_in_tile = boxes.reduce(united);
        Ok(volumes)
    }

    /// Whether there are no volumes.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.classes.is_empty()
    }

    /// Adds the prism over a mesh, and extends `around` by its box.
    fn add(
        &mut self,
        site: &Site<'_>,
        mesh: &PlanMesh,
        heights_in_tile: [f32; 2],
        around: &mut [[f32; 3]; 2],
    ) {
        let first = self.corners.len() as u32;
        self.corners.extend(mesh.points.iter().map(|point| AreaCorner {
            place_in_tile: site.place_in_tile(*point),
            heights_in_tile,
        }));
        let corners = &self.corners[first as usize..];
        let place = |index: u32| corners[index as usize].place_in_tile;
        self.walls.extend(mesh.edges.iter().map(|[start, end]| AreaWall {
            start_in_tile: place(*start),
            end_in_tile: place(*end),
            heights_in_tile,
        }));
        self.triangles.extend(mesh.triangles.iter().flatten().map(|index| first + index));
        for AreaCorner { place_in_tile: [x, y], heights_in_tile: [bottom, top] } in corners {
            *around = united(*around, [[*x, *y, *bottom], [*x, *y, *top]]);
        }
    }
}

/// The empty box.
const NOWHERE: [[f32; 3]; 2] = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];

/// The box around two boxes.
fn united([low, high]: [[f32; 3]; 2], [other_low, other_high]: [[f32; 3]; 2]) -> [[f32; 3]; 2] {
    [
        [0, 1, 2].map(|axis: usize| low[axis].min(other_low[axis])),
        [0, 1, 2].map(|axis: usize| high[axis].max(other_high[axis])),
    ]
}

/// The tile in which areas are placed.
struct Site<'a> {
    frame: &'a GridFrame,
    tile: LatticeBounds,
    ground: &'a GroundMesh,
    reference_m: [f64; 3],
    strip: Strip,
    pad_m: f64,
}

impl<'a> Site<'a> {
    fn new(
        id: TileId,
        frame: &'a GridFrame,
        ground: &'a GroundMesh,
        reference_m: [f64; 3],
    ) -> Self {
        let tile = frame.tile_lattice_bounds(id);
        let wide = frame.node_steps(id.z()).map(|steps| (steps as f64 * STRIP_CELLS) as i64);
        Self {
            frame,
            tile,
            ground,
            reference_m,
            strip: Strip { tile, wide },
            pad_m: frame.level_cell(id.z()).shorter_m() * PAD_CELLS,
        }
    }

    /// The mesh of the inside of the rings; `None` if they cross.
    fn mesh(&self, AreaPolygon { rings }: &AreaPolygon) -> Option<PlanMesh> {
        let rings: Vec<_> = rings.iter().map(|ring| with_strips(ring, self.strip)).collect();
        PlanMesh::inside(&rings, self.tile.min)
    }

    fn place_in_tile(&self, point: LatticePoint) -> [f32; 2] {
        relative_in_plan(self.frame.position_m(point), self.reference_m)
    }

    /// Bottom and top of a volume over these points; `None` without ground near them.
    fn heights_in_tile(&self, points: &[LatticePoint], work: &StepBudget) -> Option<[f32; 2]> {
        let mut around = Bounds::EMPTY;
        for point in points {
            around.include(self.place_in_tile(*point).map(f64::from));
        }
        let (low, high) = ([around.min_x, around.min_y], [around.max_x, around.max_y]);
        let [lowest_m, highest_m] = self.ground.height_range_within(low, high, work)?;
        Some([(lowest_m - self.pad_m) as f32, (highest_m + self.pad_m) as f32])
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "areas_tests.rs"]
mod tests;
