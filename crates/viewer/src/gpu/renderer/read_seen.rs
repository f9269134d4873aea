//! Finds what a finished drawing shows, sample by sample: classes of roads, boundaries and areas,
//! and heights.
//!
//! Labels of roads still exist after a picture is drawn. Labels of boundaries are drawn again,
//! because all layers of lines share one target. Areas are mixed with the colours of the ground, so
//! they are drawn again into a texture of their own, in a style whose colours are numbers of
//! classes.

use corniche_areas::AreaClass;
use corniche_styles::{AreaStyle, Style};

use super::{
    super::{
        Gpu, ReadBackError,
        formats::COLOR,
        inspection::{TileOwner, owners},
        seen::{SeenSamples, ShownTiles, heights_m},
        shared_bindings::{DrawnFrame, SharedBindings},
        target_texture::TargetTexture,
        targets::Targets,
        tile_buffers::DrawTile,
    },
    DrawnRoads, Renderer, areas_of,
};
use crate::{frame_view::FrameView, layer_view::view_of_lines, tiles::LineLayer};

/// Bytes of a sample of [`COLOR`].
const COLOR_BYTES: usize = 4;

impl Renderer {
    /// Returns what the last drawing shows. [`Renderer::draw`] must have just drawn the same view
    /// and tiles.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub(crate) fn seen(
        &self,
        gpu: &Gpu,
        view: &FrameView<'_>,
        tiles: &[DrawTile<'_>],
        targets: &Targets,
    ) -> Result<ShownTiles, ReadBackError> {
        let frame =
            DrawnFrame { gpu, shared: &self.shared(gpu, view, tiles, targets), view, targets };
        let boundaries = self.boundary_labels(frame, tiles)?;
        let areas = self.area_classes(frame, tiles)?;
        let samples_per_side = targets.picture.samples_per_side;
        let seen = SeenSamples {
            per_side: samples_per_side,
            columns: targets.picture.size_px[0] * samples_per_side,
            roads: &targets.read_labels(gpu)?,
            decks: targets.read_deck_labels(gpu)?.as_deref(),
            boundaries: boundaries.as_deref(),
            areas: areas.as_deref(),
        }
        .seen();
        drop(boundaries);
        let is_ground: Vec<bool> = owners(&targets.owners.read(gpu)?)
            .map(|owner| matches!(owner, TileOwner::Ground(_)))
            .collect();
        let depth = targets.read_depth(gpu)?;
        let depths =
            depth.iter().enumerate().filter(|(place, _)| is_ground.get(*place) == Some(&true));
        let camera = view.camera.supersampled(samples_per_side);
        let depths = depths.map(|(place, depth)| (place, f64::from(*depth)));
        let heights_m = heights_m(&camera, view.vertical_scale(), depths);
        Ok(seen.with_heights(heights_m, areas.as_deref()))
    }

    /// Draws the labels of boundaries; `None` if no tile has any that are drawn.
    fn boundary_labels(
        &self,
        frame: DrawnFrame<'_>,
        tiles: &[DrawTile<'_>],
    ) -> Result<Option<Vec<u8>>, ReadBackError> {
        let layer = LineLayer::Boundaries;
        let style = layer.style_of(frame.view.style);
        let frame = DrawnFrame { view: &view_of_lines(frame.view, &style), ..frame };
        let lines = DrawnRoads::of_layer(frame, tiles, layer);
        if lines.is_empty() {
            return Ok(None);
        }
        let frame =
            DrawnFrame { shared: &SharedBindings::with_view(frame, &self.layouts), ..frame };
        let labels = frame.targets.lines(frame.gpu);
        frame.gpu.submit("boundary labels", |encoder| {
            self.pass_labels(frame, encoder, &lines, labels);
        });
        labels.labels.read(frame.gpu).map(Some)
    }

    /// Returns the number of the area class at each sample plus 1, 0 without an area; `None` if no
    /// tile has areas that are drawn.
    fn area_classes(
        &self,
        frame: DrawnFrame<'_>,
        tiles: &[DrawTile<'_>],
    ) -> Result<Option<Vec<u8>>, ReadBackError> {
        let DrawnFrame { gpu, view, targets, .. } = frame;
        let style = with_numbers_as_colors(view.style);
        let view = &FrameView { style: &style, ..*view };
        let areas = areas_of(tiles, view, |tile| &tile.areas);
        if areas.is_empty() {
            return Ok(None);
        }
        let frame = DrawnFrame { view, ..frame };
        // A new texture contains zeros.
        let sampled_px = targets.picture.sampled_px();
        let classes = TargetTexture::new(gpu, "area classes", COLOR, sampled_px);
        gpu.submit("area classes", |encoder| self.pass_areas(frame, encoder, &areas, &classes));
        let texels = classes.read(gpu)?;
        let numbers = texels.chunks_exact(COLOR_BYTES).map(|texel| texel[0] / CLASS_STEP);
        Ok(Some(numbers.collect()))
    }
}

/// Step between numbers of classes in the red channel.
const CLASS_STEP: u8 = u8::MAX / (AreaClass::COUNT as u8 + 1);

/// A style in which the colour of each drawn area class is its number plus 1, fully opaque.
fn with_numbers_as_colors(style: &Style) -> Style {
    let mut style = style.clone();
    for (area, number) in style.areas.iter_mut().zip(1_u8..) {
        let opacity = if area.is_drawn() { 1.0 } else { 0.0 };
        // Half a step is added, so that rounding has no effect.
        let red = f32::from(number * CLASS_STEP + CLASS_STEP / 2) / 255.0;
        // A faded colour would be another number: so steep ground counts as the area on it.
        *area = AreaStyle { color: [red, 0.0, 0.0], opacity, steepest_deg: None };
    }
    style
}
