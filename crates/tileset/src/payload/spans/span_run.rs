//! A run of a bridge or tunnel in a tile, and the heights of its points.

use corniche_geom::LatticePoint;
use corniche_roads::{FunctionalRoadClass, Structure};
use corniche_tin::Surface;

use crate::layer_slot::LayerSlot;

/// What a run is a part of.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize,
)]
pub enum RunOwner {
    /// A road of this class.
    Road(FunctionalRoadClass),
    /// A line of a layer.
    Layer(LayerSlot),
}

impl RunOwner {
    /// Returns the number in a section: the class of a road; layers follow.
    #[must_use]
    pub fn number(self) -> u64 {
        match self {
            Self::Road(class) => class.number().into(),
            Self::Layer(slot) => (FunctionalRoadClass::COUNT + slot.index()) as u64,
        }
    }

    /// Returns the owner with a number; `None` if there is none.
    pub(crate) fn from_number(number: u64) -> Option<Self> {
        let number = usize::try_from(number).ok()?;
        match number.checked_sub(FunctionalRoadClass::COUNT) {
            None => FunctionalRoadClass::new(number as u8).map(Self::Road),
            Some(index) => LayerSlot::new(index).map(Self::Layer),
        }
    }

    /// Returns the class of a road; `None` for a line of a layer.
    #[must_use]
    pub fn road_class(self) -> Option<FunctionalRoadClass> {
        match self {
            Self::Road(class) => Some(class),
            Self::Layer(_) => None,
        }
    }

    /// Returns the layer of a line; `None` for a road.
    #[must_use]
    pub fn layer(self) -> Option<LayerSlot> {
        match self {
            Self::Road(_) => None,
            Self::Layer(slot) => Some(slot),
        }
    }
}

/// A stretch of a way of a bridge that is above the ground of its tile, or of a tunnel that is
/// below the ground. Its heights are estimates.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SpanRun {
    /// OSM's id of the way.
    pub way_id: i64,
    /// The road or the layer.
    pub owner: RunOwner,
    /// The structure: a bridge or a tunnel, never the ground.
    pub structure: Structure,
    /// At least two points; neighbouring points differ in plan. Only the first and the last may be
    /// on the ground.
    pub points: Vec<SpanPoint>,
}

impl SpanRun {
    /// The sort key of the runs of a tile; runs of one way are in their order along the way.
    pub(crate) fn key(&self) -> (RunOwner, i64) {
        (self.owner, self.way_id)
    }
}

/// A point of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SpanPoint {
    /// The position in plan.
    pub at: LatticePoint,
    /// The height.
    pub height: SpanHeight,
}

impl SpanPoint {
    /// The height in metres, for a tile with this ground and a package with this height quantum;
    /// `None` if the triangle does not exist.
    ///
    /// On the ground it is the height that a source point of a GEO road has there, to the last bit.
    #[must_use]
    pub fn height_m(&self, surface: &Surface, quantum_m: f64) -> Option<f64> {
        match self.height {
            SpanHeight::Steps(steps) => Some(steps as f64 * quantum_m),
            SpanHeight::Ground { triangle } => {
                let exists = (triangle as usize) < surface.triangles().len();
                exists.then(|| surface.height_at_point_m(triangle, self.at))
            }
        }
    }
}

/// The height of a point of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpanHeight {
    /// The height in steps of the package's height quantum; within 32 bits, like heights of the
    /// ground.
    Steps(i64),
    /// On the ground.
    Ground {
        /// The triangle of the tile's TIN whose plane contains the point.
        triangle: u32,
    },
}
