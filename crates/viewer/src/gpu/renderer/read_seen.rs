//! Finds what a finished drawing shows, sample by sample: classes of roads and of layers, and
//! heights.
//!
//! Labels of roads still exist after a picture is drawn. Labels of lines are drawn again, because
//! all lines share one target. Areas and points are mixed with the colours of the map, so they are
//! drawn again into textures of their own, with looks whose colours are numbers of classes.

use corniche_styles::{AreaStyle, FADE_FACTOR, LayerLook, LineStyle, PointStyle, Style};
use wgpu::CommandEncoder;

use super::{
    super::{
        Gpu, ReadBackError,
        formats::COLOR,
        inspection::{TileOwner, owners},
        seen::{LineSamples, SeenSamples, ShownTiles, heights_m},
        shared_bindings::DrawnFrame,
        target_texture::TargetTexture,
        targets::Targets,
        tile_buffers::DrawTile,
    },
    DrawnLines, Renderer, areas_of, points_of,
};
use crate::{
    frame_view::FrameView, layer_class::LayerClass, layers::PackageLooks, tiles::LineLayer,
};

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
        let lines = self.with_lines(frame, tiles, |lines| {
            let of_layer = |(layer, lines): &_| self.line_samples(*layer, lines).transpose();
            let samples = lines.iter().filter_map(of_layer);
            samples.collect::<Result<Vec<LineSamples>, _>>()
        })?;
        let numbered: Vec<LayerClass> = view.layers.all().map(|(class, _)| class).collect();
        let [areas, points] = self.class_numbers(frame, tiles)?;
        let has_decks = DrawnLines::new(frame, tiles, |tile| Some(&tile.roads)).has_decks();
        // Without decks the labels are those of an earlier frame.
        let decks = has_decks.then(|| targets.read_deck_labels(gpu)).transpose()?.flatten();
        let samples_per_side = targets.picture.samples_per_side;
        let seen = SeenSamples {
            per_side: samples_per_side,
            columns: targets.picture.size_px[0] * samples_per_side,
            roads: &targets.read_labels(gpu)?,
            decks: decks.as_deref(),
            lines: &lines,
            areas: areas.as_deref(),
            points: points.as_deref(),
            numbered: &numbered,
        }
        .seen();
        let is_ground: Vec<bool> = owners(&targets.owners.read(gpu)?)
            .map(|owner| matches!(owner, TileOwner::Ground(_)))
            .collect();
        let depth = targets.read_depth(gpu)?;
        let depths =
            depth.iter().enumerate().filter(|(place, _)| is_ground.get(*place) == Some(&true));
        let camera = view.camera.supersampled(samples_per_side);
        let depths = depths.map(|(place, depth)| (place, f64::from(*depth)));
        let heights_m = heights_m(&camera, view.vertical_scale(), depths);
        Ok(seen.with_heights(heights_m, areas.as_deref(), &numbered))
    }

    /// Draws the labels of lines of the package's layers; `None` if no tile has any that are drawn.
    fn line_samples(
        &self,
        layer: LineLayer,
        lines: &DrawnLines<'_>,
    ) -> Result<Option<LineSamples>, ReadBackError> {
        let DrawnLines { frame, on_ground, .. } = lines;
        let classes = frame.view.layers.classes_of(layer);
        let has_decks = lines.has_decks();
        if classes.iter().all(Option::is_none) || (on_ground.is_empty() && !has_decks) {
            return Ok(None);
        }
        let DrawnFrame { gpu, targets, .. } = *frame;
        let labels = targets.lines(gpu);
        gpu.submit("line labels", |encoder| {
            if has_decks {
                self.draw_line_labels(lines, encoder);
            } else {
                self.pass_labels(*frame, encoder, on_ground, labels);
            }
        });
        let decks = has_decks.then(|| targets.line_decks(gpu).labels.read(gpu)).transpose()?;
        Ok(Some(LineSamples { labels: labels.labels.read(gpu)?, decks, classes }))
    }

    /// Returns the numbers of the classes of areas and of points at each sample, from 1 in the
    /// order of the layers; 0 without an area or a point; `None` if no tile has any that are drawn.
    fn class_numbers(
        &self,
        frame: DrawnFrame<'_>,
        tiles: &[DrawTile<'_>],
    ) -> Result<[Option<Vec<u16>>; 2], ReadBackError> {
        let DrawnFrame { gpu, view, targets, .. } = frame;
        let looks = with_numbers_as_colors(view);
        // Haze would mix a number with another colour.
        let style = Style { haze_reach: 1e30, ..view.style.clone() };
        let view = &FrameView { layers: &looks, style: &style, ..*view };
        let frame = DrawnFrame { view, ..frame };
        let numbers = |draw: &dyn Fn(&mut CommandEncoder, &TargetTexture)| {
            // A new texture contains zeros.
            let sampled_px = targets.picture.sampled_px();
            let classes = TargetTexture::new(gpu, "class numbers", COLOR, sampled_px);
            gpu.submit("class numbers", |encoder| draw(encoder, &classes));
            let texels = classes.read(gpu)?;
            let number = |texel: &[u8; 4]| u16::from_le_bytes([texel[0], texel[1]]);
            Ok::<Vec<u16>, ReadBackError>(texels.as_chunks().0.iter().map(number).collect())
        };
        let areas = areas_of(tiles, view, |tile| &tile.areas);
        let points = points_of(tiles, view);
        let of_areas = (!areas.is_empty())
            .then(|| numbers(&|encoder, into| self.pass_areas(frame, encoder, &areas, into)));
        let of_points = (!points.is_empty()).then(|| {
            numbers(&|encoder, into| self.pass_points(frame, encoder, &points, &into.view))
        });
        Ok([of_areas.transpose()?, of_points.transpose()?])
    }
}

impl PackageLooks {
    /// For each style of lines that are drawn at once the class that has it, if it is drawn, and
    /// whether it is apart from roads.
    fn classes_of(&self, layer: LineLayer) -> [Option<(LayerClass, bool)>; LineStyle::MOST] {
        let mut classes = [None; LineStyle::MOST];
        for (class, look) in self.all() {
            if let (LayerLook::Line(line), Some((of, style))) = (look, self.places.place(class))
                && of == layer
                && look.is_drawn()
            {
                classes[usize::from(style)] = Some((class, line.is_apart_from_roads));
            }
        }
        classes
    }
}

/// Looks in which the colour of each class of areas or points is its number, fully opaque. Classes
/// of points that have faded out in the middle of the picture are not drawn.
fn with_numbers_as_colors(view: &FrameView<'_>) -> PackageLooks {
    let pixel_m = view.camera.pixel_at_unit_depth_m() * view.camera.focus_m / view.point_scale;
    let mut number = 0_u16;
    view.layers.map(|look| {
        number = number.saturating_add(1);
        let [red, green] = number.to_le_bytes().map(|byte| f32::from(byte) / 255.0);
        let color = [red, green, 0.0];
        match look {
            hidden if !hidden.is_drawn() => hidden,
            // A faded colour would be another number: so steep ground counts as the area on it.
            LayerLook::Area(_) => {
                LayerLook::Area(AreaStyle { color, opacity: 1.0, steepest_deg: None })
            }
            LayerLook::Point(point) => {
                let is_near = |most_m| pixel_m < f64::from(most_m) * FADE_FACTOR;
                let opacity = f32::from(u8::from(point.max_pixel_m.is_none_or(is_near)));
                let outline = point.outline.map(|_| color);
                LayerLook::Point(PointStyle { color, outline, opacity, max_pixel_m: None, ..point })
            }
            LayerLook::Line(_) => look,
        }
    })
}
