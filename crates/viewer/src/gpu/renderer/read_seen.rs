//! What a finished drawing shows, sample by sample: classes of roads, boundaries and areas, and heights.
//!
//! Labels of roads are still there after a picture is drawn. Those of boundaries are drawn again, because all layers of lines take turns in one target; and
//! areas leave a mixture of colours on the ground, so they are drawn once more into a texture of their own, in a style whose colours are numbers of classes.

use corniche_areas::AreaClass;
use corniche_styles::{AreaStyle, Style};

use super::{
    super::{
        Gpu, ReadBackError,
        formats::COLOR,
        inspection::{Owner, owners},
        seen::{Seen, SeenSamples, heights_m},
        target_texture::TargetTexture,
        targets::Targets,
        tile_buffers::DrawTile,
    },
    DrawnRoads, FramePasses, Renderer, areas_of,
};
use crate::{frame_view::FrameView, layer_view::view_of_lines, tiles::LineLayer};

/// Bytes of a sample of [`COLOR`].
const COLOR_BYTES: usize = 4;

impl Renderer {
    /// What a drawing shows that [`Renderer::draw`] has just made of the same view and tiles.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub(crate) fn seen(
        &self,
        gpu: &Gpu,
        view: &FrameView<'_>,
        tiles: &[DrawTile<'_>],
        targets: &Targets,
    ) -> Result<Seen, ReadBackError> {
        let boundaries = self.boundary_labels(gpu, view, tiles, targets)?;
        let areas = self.area_classes(gpu, view, tiles, targets)?;
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
            .map(|owner| matches!(owner, Owner::Ground(_)))
            .collect();
        let depth = targets.read_depth(gpu)?;
        let depths =
            depth.iter().enumerate().filter(|(place, _)| is_ground.get(*place) == Some(&true));
        let camera = view.camera.supersampled(samples_per_side);
        let depths = depths.map(|(place, depth)| (place, f64::from(*depth)));
        let heights_m = heights_m(&camera, view.vertical_scale(), depths);
        Ok(seen.with_heights(heights_m, areas.as_deref()))
    }

    /// The labels of boundaries; `None` if no tile has any that are drawn.
    fn boundary_labels(
        &self,
        gpu: &Gpu,
        view: &FrameView<'_>,
        tiles: &[DrawTile<'_>],
        targets: &Targets,
    ) -> Result<Option<Vec<u8>>, ReadBackError> {
        let layer = LineLayer::Boundaries;
        let style = layer.style_of(view.style);
        let view = &view_of_lines(view, &style);
        let lines = DrawnRoads::of_layer(gpu, tiles, view, layer);
        if lines.is_empty() {
            return Ok(None);
        }
        let shared = &self.shared(gpu, view, tiles, targets);
        let passes = FramePasses { renderer: self, gpu, shared, view, targets };
        let labels = targets.lines(gpu);
        gpu.submit("boundary labels", |encoder| passes.labels(encoder, &lines, labels));
        labels.labels.read(gpu).map(Some)
    }

    /// The number of the class of the area at each sample plus 1, 0 where there is none; `None` if no tile has areas that are drawn.
    fn area_classes(
        &self,
        gpu: &Gpu,
        view: &FrameView<'_>,
        tiles: &[DrawTile<'_>],
        targets: &Targets,
    ) -> Result<Option<Vec<u8>>, ReadBackError> {
        let style = with_numbers_as_colors(view.style);
        let view = &FrameView { style: &style, ..*view };
        let areas = areas_of(tiles, view, |tile| &tile.areas);
        if areas.is_empty() {
            return Ok(None);
        }
        let shared = &self.shared(gpu, view, tiles, targets);
        let passes = FramePasses { renderer: self, gpu, shared, view, targets };
        // A new texture is all 0.
        let sampled_px = targets.picture.sampled_px();
        let classes = TargetTexture::new(gpu, "area classes", COLOR, sampled_px);
        gpu.submit("area classes", |encoder| passes.areas(encoder, &areas, &classes));
        let texels = classes.read(gpu)?;
        let numbers = texels.chunks_exact(COLOR_BYTES).map(|texel| texel[0] / CLASS_STEP);
        Ok(Some(numbers.collect()))
    }
}

/// Numbers of classes are so far apart in the red of a texel.
const CLASS_STEP: u8 = u8::MAX / (AreaClass::COUNT as u8 + 1);

/// A style in which the colour of each class of areas that is drawn is its number plus 1, and hides what is beneath it.
fn with_numbers_as_colors(style: &Style) -> Style {
    let mut style = style.clone();
    for (area, number) in style.areas.iter_mut().zip(1_u8..) {
        let opacity = if area.is_drawn() { 1.0 } else { 0.0 };
        // Half a step more, so that rounding does no harm.
        let red = f32::from(number * CLASS_STEP + CLASS_STEP / 2) / 255.0;
        // Half a number would be another one: cliffs count as what lies on them.
        *area = AreaStyle { color: [red, 0.0, 0.0], opacity, steepest_deg: None };
    }
    style
}
