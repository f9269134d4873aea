//! The points of a tile on its ground.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::{blocks, relative};
use crate::layer_class::LayerClass;

/// The points of a tile, by class.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PointMarks {
    /// Metres from the tile's reference point, east and north, and true height.
    #[serde(with = "blocks::plain")]
    pub places_in_tile: Vec<[f32; 3]>,
    /// The range of the points of each class, in order.
    pub classes: Vec<(LayerClass, Range<u32>)>,
}

impl PointMarks {
    /// Creates the marks of points at positions in the working CRS with true heights.
    pub(crate) fn new(mut points: Vec<(LayerClass, [f64; 3])>, reference_m: [f64; 3]) -> Self {
        points.sort_by_key(|(class, _)| *class);
        let mut marks = Self::default();
        for of_class in points.chunk_by(|one, next| one.0 == next.0) {
            let start = marks.places_in_tile.len() as u32;
            let places = of_class.iter().map(|(_, at_m)| relative(*at_m, reference_m));
            marks.places_in_tile.extend(places);
            marks.classes.push((of_class[0].0, start..marks.places_in_tile.len() as u32));
        }
        marks
    }
}
