//! How the ground is drawn, in every command that draws it.

use clap::Args;

#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct GroundArgs {
    /// Terrain error that may be seen, in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 2.0)]
    pub(crate) screen_space_error: f64,
    /// Size in pixels that one of a tile's 256 × 256 cells may have; 'inf' lets the terrain error decide alone
    #[arg(long, value_name = "PIXELS", default_value_t = 2.0)]
    pub(crate) cell_px: f64,
    /// Vertical exaggeration
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    pub(crate) exaggeration: f64,
}
