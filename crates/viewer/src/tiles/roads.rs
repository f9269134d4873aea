use std::ops::Range;

use corniche_drape::BadLine;
use corniche_geom::Frame;
use corniche_roads::FunctionalRoadClass;
use corniche_tileset::TilePayload;
use corniche_tin::{Placement, Surface};

use super::{GroundLine, class_ranges, ground::relative};

/// A straight piece of a road's centre-line on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoadSegment {
    /// Metres from the tile's reference point; z is true height, before exaggeration.
    pub start_in_tile: [f32; 3],
    /// The other end.
    pub end_in_tile: [f32; 3],
    /// Functional road class.
    pub class: FunctionalRoadClass,
}

/// Why a road of a tile cannot be drawn: the package is damaged.
#[derive(Debug, thiserror::Error)]
#[error("part {part} of way {way_id} does not fit the tile's ground")]
pub struct BadRoad {
    /// OSM's id of the way.
    pub way_id: i64,
    /// Which piece of it.
    pub part: u32,
    /// What is wrong.
    pub source: BadLine,
}

/// Recomputes the positions of a tile's clipped roads from its ground.
pub(super) fn ground_lines(
    payload: &TilePayload,
    frame: &Frame,
    quantum_m: f64,
) -> Result<Vec<GroundLine>, BadRoad> {
    let Some(terrain) = payload.terrain.as_ref().filter(|_| !payload.roads_geo.is_empty()) else {
        return Ok(Vec::new());
    };
    let surface = Surface::new(&terrain.tin, Placement::of_tile(frame, payload.id, quantum_m));
    let place = |[u, v, height_m]: [f64; 3]| {
        let [x, y] = frame.position_of_fraction_m([u, v]);
        [x, y, height_m]
    };
    let mut lines = Vec::with_capacity(payload.roads_geo.len());
    for road in &payload.roads_geo {
        let positions = corniche_drape::positions(&road.line, &surface)
            .map_err(|source| BadRoad { way_id: road.way_id, part: road.part, source })?;
        lines.push((road.class, positions.into_iter().map(place).collect()));
    }
    Ok(lines)
}

/// All segments of a tile, in order of class.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RoadSegments {
    segments: Vec<RoadSegment>,
    ranges: [Range<u32>; FunctionalRoadClass::COUNT],
}

impl RoadSegments {
    /// Cuts lines into segments. Positions are x, y in the working CRS and true height.
    #[must_use]
    pub fn new(lines: &[GroundLine], reference_m: [f64; 3]) -> Self {
        let mut segments: Vec<RoadSegment> = lines
            .iter()
            .flat_map(|(class, line)| {
                line.windows(2).map(move |pair| RoadSegment {
                    start_in_tile: relative(pair[0], reference_m),
                    end_in_tile: relative(pair[1], reference_m),
                    class: *class,
                })
            })
            .collect();
        segments.sort_by_key(|segment| segment.class);
        let ranges = class_ranges(&segments);
        Self { segments, ranges }
    }

    /// The segments, most important class first.
    #[must_use]
    pub fn all(&self) -> &[RoadSegment] {
        &self.segments
    }

    /// Where the segments of a class are.
    #[must_use]
    pub fn range_of(&self, class: FunctionalRoadClass) -> Range<u32> {
        self.ranges[usize::from(class.number())].clone()
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
mod tests {
    use super::*;

    #[test]
    fn segments_are_relative_and_sorted_by_class() {
        let class = |number| FunctionalRoadClass::new(number).unwrap();
        let lines = vec![
            (class(6), vec![[10.0, 20.0, 1.0], [11.0, 20.0, 1.5], [12.0, 20.0, 1.0]]),
            (class(0), vec![[0.0, 0.0, 0.0], [10.0, 20.0, 1.0]]),
        ];
        let roads = RoadSegments::new(&lines, [10.0, 20.0, 1.0]);
        assert_eq!(roads.range_of(class(0)), 0..1);
        assert_eq!(roads.range_of(class(6)), 1..3);
        assert!(roads.range_of(class(3)).is_empty());
        assert_eq!(roads.all()[0].end_in_tile, [0.0; 3]);
        assert_eq!(roads.all()[1].end_in_tile, [1.0, 0.0, 0.5]);
    }
}
