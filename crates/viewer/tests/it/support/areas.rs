//! Areas on scenes: drawn areas are divided by tile as in a build, while the references use whole
//! outlines in f64.

use corniche_areas::{Axis, OutlineWay, Polygon, assemble, divide};
use corniche_geom::{GridFrame, LatticePoint, TileId};
use corniche_layers::OsmObject;
use corniche_styles::{AreaStyle, LayerLook, Style};
use corniche_tileset::{AreaPolygon, LayerObject, LayerShape, LayerSlot};
use corniche_viewer::PackageLooks;
use glam::DVec2;

use super::scene::Scene;

/// The numbers of classes; a class is above those with larger numbers.
pub(crate) const WATER: u8 = 1;
pub(crate) const FOREST: u8 = 2;
pub(crate) const ROCK: u8 = 3;
pub(crate) const PARK: u8 = 4;
pub(crate) const MEADOW: u8 = 5;
pub(crate) const SETTLEMENT: u8 = 6;
/// The number of classes; there are no areas of the first one.
pub(crate) const CLASSES: u8 = 7;

/// An area: a class and rings, in the working CRS.
#[derive(Debug, Clone)]
pub(crate) struct PlanArea {
    pub(crate) class: u8,
    pub(crate) rings: Vec<Vec<DVec2>>,
}

impl PlanArea {
    /// Creates an area from rings relative to a point.
    pub(crate) fn new(class: u8, around: DVec2, rings: &[Vec<[f64; 2]>]) -> Self {
        let place = |point: &[f64; 2]| around + DVec2::from_array(*point);
        let rings = rings.iter().map(|ring| ring.iter().map(place).collect()).collect();
        Self { class, rings }
    }

    /// The part of the area in a tile.
    fn record(&self, frame: &GridFrame, id: TileId) -> Option<LayerObject> {
        let on_lattice = |ring: &Vec<DVec2>| -> Vec<LatticePoint> {
            ring.iter().chain(ring.first()).map(|at| frame.snap(at.to_array()).unwrap()).collect()
        };
        let rings: Vec<Vec<LatticePoint>> = self.rings.iter().map(on_lattice).collect();
        let ways: Vec<OutlineWay<'_>> = rings.iter().map(|points| OutlineWay { points }).collect();
        let tile = frame.tile_lattice_bounds(id);
        let parts = assemble(&ways).unwrap().polygons.into_iter().flat_map(|whole| {
            let cuts = [
                (Axis::East, tile.min.u, 1),
                (Axis::East, tile.max.u, 0),
                (Axis::North, tile.min.v, 1),
                (Axis::North, tile.max.v, 0),
            ];
            cuts.into_iter().fold(vec![whole], |parts, (axis, at, side)| {
                let part = |part: &Polygon| divide(part, axis, at).unwrap()[side].clone();
                parts.iter().flat_map(part).collect()
            })
        });
        let polygons: Vec<AreaPolygon> = parts
            .map(|part| AreaPolygon {
                rings: part.rings().map(|ring| ring.points().to_vec()).collect(),
            })
            .collect();
        (!polygons.is_empty()).then(|| LayerObject {
            class: self.class,
            object: OsmObject::Way(1),
            values: Vec::new(),
            shape: LayerShape::Area(polygons),
        })
    }
}

/// The same scene with areas, which are drawn in the colours of [`flat_color`].
pub(crate) fn with_areas(scene: &Scene, frame: &GridFrame, areas: &[PlanArea]) -> Scene {
    let style = flat_style(&scene.style);
    let mut scene = Scene { style, layers: flat_looks(1.0), ..scene.clone() };
    let layer = LayerSlot::new(0_u8).unwrap();
    for tile in &mut scene.tiles {
        let id = tile.geometry.id;
        let records: Vec<_> = areas.iter().filter_map(|area| area.record(frame, id)).collect();
        tile.geometry = tile.geometry.clone().with_layers(vec![(layer, records)], frame).unwrap();
    }
    scene
}

/// A colour for each class that the ground never has, because the ground has no blue.
fn flat_color(class: u8) -> [u8; 3] {
    [20 * class, 100, 255]
}

/// The looks of a layer of areas of flat colours with this opacity.
pub(crate) fn flat_looks(opacity: f32) -> PackageLooks {
    let look = |class| {
        let color = flat_color(class).map(|part| f32::from(part) / 255.0);
        LayerLook::Area(AreaStyle { color, opacity, steepest_deg: None })
    };
    PackageLooks::from_looks(vec![(0..CLASSES).map(look).collect()])
}

/// The same style with ground without blue.
fn flat_style(style: &Style) -> Style {
    let mut style = style.clone();
    style.tint.stops.iter_mut().for_each(|(_, color)| color[2] = 0.0);
    style.haze[2] = 0.0;
    style.light.shadow[2] = 0.0;
    style.light.sunlit[2] = 0.0;
    style.wall[2] = 0.0;
    style
}

/// The class that a sample of the ground shows; `None` where it shows ground. Any other colour
/// fails.
pub(crate) fn class_of(ground: &[u8]) -> Option<u8> {
    if ground[2] == 0 {
        return None;
    }
    let class = (0..CLASSES).find(|class| ground[..3] == flat_color(*class));
    assert!(class.is_some(), "a mixed colour: {ground:?}");
    class
}
