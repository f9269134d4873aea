//! What a page is told of a map, as JSON.

use serde::Serialize;

use crate::view_record::ViewRecord;

/// When the next frame is due.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Next {
    /// The next frame is due as soon as possible.
    Now,
    /// The next frame is due when something happens.
    Asked,
}

impl Serialize for Next {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(match self {
            Self::Now => "now",
            Self::Asked => "asked",
        })
    }
}

/// A place on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct GroundPlace {
    pub(crate) lon: f64,
    pub(crate) lat: f64,
    /// True height, metres.
    pub(crate) height: f64,
}

/// Tiles of the view.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub(crate) struct TileCounts {
    pub(crate) drawn: usize,
    /// The view needs them next, and they are not there.
    pub(crate) missing: usize,
    pub(crate) loading: usize,
    /// Whether the missing ones do not fit into the memory allowed.
    pub(crate) full: bool,
}

/// A message to the person.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Notice {
    pub(crate) kind: &'static str,
    pub(crate) text: String,
}

impl Notice {
    pub(crate) fn warning(text: impl Into<String>) -> Self {
        Self { kind: "warn", text: text.into() }
    }

    pub(crate) fn told(text: impl Into<String>) -> Self {
        Self { kind: "tell", text: text.into() }
    }
}

/// What came of a frame.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct FrameReport {
    pub(crate) next: Next,
    /// Whether nothing moves and nothing is loaded any more.
    pub(crate) is_settled: bool,
    pub(crate) view: Option<ViewRecord>,
    pub(crate) cursor: Option<GroundPlace>,
    /// True metres in a pixel in the middle.
    pub(crate) metres_per_pixel: Option<f64>,
    /// True metres in a point of the screen in the middle.
    pub(crate) metres_per_point: Option<f64>,
    pub(crate) mode: &'static str,
    pub(crate) tiles: TileCounts,
    pub(crate) triangles: u64,
    pub(crate) segments: u64,
    pub(crate) gpu_bytes: [u64; 2],
    /// Asked of the server so far, and what came.
    pub(crate) requests: u32,
    pub(crate) bytes: u64,
    /// How much of what the view needs is there, 0 to 1.
    pub(crate) progress: f64,
    pub(crate) recording_s: Option<f64>,
    pub(crate) is_playing: bool,
    /// New ones.
    pub(crate) notices: Vec<Notice>,
}

/// A class of roads, or of boundaries, in the legend.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct ClassEntry {
    pub(crate) label: String,
    /// The colour as in CSS: `#rrggbb`.
    pub(crate) color: String,
}

/// What a package may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub(crate) struct Has {
    pub(crate) photo: bool,
    pub(crate) areas: bool,
    pub(crate) boundaries: bool,
}

/// What is known of a map before anything is drawn.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct About {
    pub(crate) src: String,
    pub(crate) attribution: Vec<String>,
    /// West, south, east, north, degrees.
    pub(crate) bounds: [f64; 4],
    /// Lowest and highest ground, metres.
    pub(crate) heights: [f64; 2],
    pub(crate) tiles: u64,
    pub(crate) levels: usize,
    pub(crate) styles: Vec<String>,
    pub(crate) classes: Vec<ClassEntry>,
    /// Boundaries that the package has and the style draws.
    pub(crate) boundaries: Vec<ClassEntry>,
    pub(crate) has: Has,
    pub(crate) adapter: String,
    pub(crate) is_software: bool,
    pub(crate) max_side_px: u32,
    pub(crate) format_version: u64,
    /// Length of the package.
    pub(crate) bytes: u64,
}

/// A road that was picked.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct PickedRoad {
    /// OSM's id of the way.
    pub(crate) way: i64,
    pub(crate) class: u8,
    pub(crate) label: String,
    pub(crate) attributes: std::collections::BTreeMap<&'static str, String>,
}

/// What was picked.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Pick {
    #[serde(flatten)]
    pub(crate) at: GroundPlace,
    pub(crate) road: Option<PickedRoad>,
}

/// A value of this crate as JSON.
pub(crate) fn json(value: &impl serde::Serialize) -> String {
    // These values have text keys and finite numbers only, so there is always a text.
    serde_json::to_string(value).unwrap_or_default()
}
