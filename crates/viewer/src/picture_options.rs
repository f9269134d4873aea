//! Options of the pictures of a package, for single pictures and for flights.

use corniche_styles::Style;
use corniche_tileset::Manifest;

use crate::{
    camera::Camera,
    frame_view::FrameView,
    layers::{PackageLooks, ShownLayers},
    lod::{Fineness, Quality},
    options::RoadOptions,
    range::{self, OutOfRange},
};

/// How pictures are drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureOptions {
    /// Width and height of a picture.
    pub size_px: [u32; 2],
    /// How roads are drawn.
    pub roads: RoadOptions,
    /// A tile is refined while its error looks larger than this.
    pub screen_space_error_px: f64,
    /// A tile is refined while one of its cells looks larger than this, pixels.
    pub cell_px: f64,
    /// Factor on heights; 1 is true.
    pub exaggeration: f64,
    /// Samples along each side of a pixel, averaged; with 1, only the pixel's centre is sampled.
    pub supersampling: u32,
    /// Colours and widths.
    pub style: Style,
    /// The layers to draw.
    pub layers: ShownLayers,
}

impl PictureOptions {
    pub(crate) fn check(&self) -> Result<(), OutOfRange> {
        range::check_ground(self.screen_space_error_px, self.cell_px, self.exaggeration)?;
        range::check_supersampling(self.supersampling)
    }

    /// The quality of the ground of a package.
    pub(crate) fn quality(&self, manifest: &Manifest) -> Quality {
        let Self { screen_space_error_px, cell_px, roads, exaggeration, .. } = *self;
        let fineness = Fineness { screen_space_error_px, cell_px };
        Quality::of_package(manifest, fineness, &self.style, roads, exaggeration)
    }

    /// How the layers of a package are drawn.
    #[must_use]
    pub fn looks(&self, manifest: &Manifest) -> PackageLooks {
        PackageLooks::new(manifest, &self.style, &self.layers)
    }

    /// The view of a camera on a package whose ground has these heights.
    pub(crate) fn view<'a>(
        &'a self,
        camera: &'a Camera,
        layers: &'a PackageLooks,
        manifest: &Manifest,
        height_range_m: [f64; 2],
    ) -> FrameView<'a> {
        FrameView {
            camera,
            style: &self.style,
            layers,
            roads: self.roads,
            exaggeration: self.exaggeration,
            point_scale: manifest.point_scale,
            height_range_m,
            wall_m: FrameView::wall_beside_m(height_range_m),
            cell_px: self.cell_px,
            latitude_deg: manifest.wgs84_bounds.center()[1],
            is_wireframe: false,
        }
    }
}
