//! How slabs of bridges look in all models and tiles, but for the road on top.

use corniche_styles::Rgb;

/// The name of their material.
pub(crate) const SLAB_NAME: &str = "bridge_slab";
/// Concrete, sRGB.
pub(crate) const SLAB_COLOR: Rgb = [0.62, 0.61, 0.59];
