//! What an export of terrain tiles tells of itself.

/// What was exported.
#[derive(Debug, Clone, PartialEq)]
pub struct QuantizedMeshSummary {
    /// Each level, coarsest first.
    pub levels: Vec<QuantizedMeshLevel>,
    /// What heights are, in words.
    pub heights: String,
}

/// What was exported of a level.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct QuantizedMeshLevel {
    /// The level.
    pub level: u8,
    /// The number of tiles.
    pub tiles: u64,
    /// The number of triangles.
    pub triangles: u64,
    /// Bytes of the files.
    pub bytes: u64,
    /// Cells along the sides of the rasters on which the ground was sampled.
    pub cells: u64,
    /// What CesiumJS takes the level's error to be, metres.
    pub assumed_error_m: f64,
    /// Places with ground at which the tiles were measured.
    pub places: u64,
    /// Largest vertical distance of a tile from the package's finest ground there, metres.
    pub deviation_m: f64,
    /// Root of the mean square of these distances.
    pub deviation_rms_m: f64,
}
