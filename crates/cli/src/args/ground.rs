//! How the terrain is drawn, in every command that draws it.

use clap::Args;

#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct GroundArgs {
    /// Allowed terrain error on the screen, in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 2.0)]
    pub screen_space_error: f64,
    /// Largest size in pixels of one of a tile's 256 × 256 cells; with 'inf' only the terrain error
    /// selects tiles
    #[arg(long, value_name = "PIXELS", default_value_t = 2.0)]
    pub cell_px: f64,
    /// Vertical exaggeration
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    pub exaggeration: f64,
}
