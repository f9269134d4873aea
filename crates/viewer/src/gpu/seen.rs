//! The classes and heights that a finished picture shows. A class counts if it covers as much of
//! the picture as a few pixels.

use std::collections::BTreeMap;

use corniche_roads::FunctionalRoadClass;
use glam::DVec2;

use super::labels::{class_of, is_tunnel};
use crate::{camera::Camera, layer_class::LayerClass, options::ClassSet};

/// Minimum number of pixels of a class in a picture. Fewer pixels are not noticed.
const LEAST_PX: u32 = 4;
/// Lines apart from roads are not drawn this close to roads of class [`LAST_WIDE_ROAD`] and above,
/// as in `shaders/lines.wgsl`.
const APART_PX: u32 = 2;
const LAST_WIDE_ROAD: u8 = 6;
/// Deck labels below this are labels of sides and undersides.
const DECK_ROADS: u8 = 3;

/// The classes and heights that a picture shows.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ShownTiles {
    /// Classes of roads, including tunnels.
    pub(crate) roads: ClassSet,
    /// Classes of roads in tunnels.
    pub(crate) tunnels: ClassSet,
    /// Classes of layers: those of the highest layer and the first class of a layer come first.
    pub(crate) layers: Vec<SeenClass>,
    /// The lowest and the highest ground, true metres; `None` without ground.
    pub(crate) heights_m: Option<[f64; 2]>,
}

/// A class of a layer in a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SeenClass {
    pub(crate) class: LayerClass,
    /// The mean true height of the visible ground under areas; `None` if it is unknown.
    pub(crate) height_m: Option<f64>,
}

/// The samples of a picture, all in the same order.
pub(crate) struct SeenSamples<'a> {
    /// Number of samples on each side of a pixel.
    pub(crate) per_side: u32,
    /// Number of samples in a row.
    pub(crate) columns: u32,
    /// Labels of roads on the ground, as defined in `gpu::labels`.
    pub(crate) roads: &'a [u8],
    /// Labels of decks, which hide the ground.
    pub(crate) decks: Option<&'a [u8]>,
    /// Lines of layers, for each time that lines are drawn.
    pub(crate) lines: &'a [LineSamples],
    /// Numbers of classes of areas; 0 without an area.
    pub(crate) areas: Option<&'a [u16]>,
    /// Numbers of classes of points; 0 without a point.
    pub(crate) points: Option<&'a [u16]>,
    /// The classes with the numbers 1, 2, and so on.
    pub(crate) numbered: &'a [LayerClass],
}

/// Samples of lines of layers.
pub(crate) struct LineSamples {
    /// Labels as defined in `gpu::labels`.
    pub(crate) labels: Vec<u8>,
    /// Labels of decks, which hide what is below them.
    pub(crate) decks: Option<Vec<u8>>,
    /// The class of each style, and whether it is apart from roads.
    pub(crate) classes: [Option<(LayerClass, bool)>; FunctionalRoadClass::COUNT],
}

impl SeenSamples<'_> {
    /// Returns the visible classes, without heights.
    pub(crate) fn seen(&self) -> ShownTiles {
        let mut roads = [0_u32; 256];
        let mut layers: BTreeMap<LayerClass, u32> = BTreeMap::new();
        let class = |number: Option<&u16>| {
            let number = usize::from(*number?).checked_sub(1)?;
            self.numbered.get(number).copied()
        };
        for (place, road) in self.roads.iter().enumerate() {
            let deck = self.decks.and_then(|all| all.get(place)).copied().unwrap_or(0);
            let label = match deck {
                0 => *road,
                1..DECK_ROADS => 0,
                _ => deck,
            };
            roads[usize::from(label)] += 1;
            let area = self.areas.and_then(|all| class(all.get(place)));
            let point = self.points.and_then(|all| class(all.get(place)));
            let area = area.filter(|_| label == 0 && deck == 0);
            for class in area.into_iter().chain(point) {
                *layers.entry(class).or_default() += 1;
            }
            for lines in self.lines {
                let on_deck = lines.decks.as_ref().and_then(|all| all.get(place));
                let on_deck = on_deck.filter(|label| **label >= DECK_ROADS);
                let label = on_deck.or(lines.labels.get(place).filter(|_| deck == 0));
                let style = label.and_then(|label| class_of(*label));
                let of_style = style.and_then(|style| *lines.classes.get(usize::from(style))?);
                let Some((class, is_apart)) = of_style else { continue };
                if !(is_apart && self.is_beside_road(place)) {
                    *layers.entry(class).or_default() += 1;
                }
            }
        }
        let least = LEAST_PX * self.per_side * self.per_side;
        let layers = layers.into_iter().filter(|(_, count)| *count >= least);
        let layers = LayerClass::topmost_first(layers.map(|(class, _)| class));
        ShownTiles {
            roads: classes(&roads, least, |_| true),
            tunnels: classes(&roads, least, is_tunnel),
            layers: layers.into_iter().map(|class| SeenClass { class, height_m: None }).collect(),
            heights_m: None,
        }
    }
}

impl SeenSamples<'_> {
    /// Whether a line apart from roads is hidden at a sample because it is close to a road, as in
    /// `shaders/lines.wgsl`. Checks four samples around it.
    fn is_beside_road(&self, place: usize) -> bool {
        let across = (APART_PX * self.per_side) as usize;
        let down = across * self.columns as usize;
        let is_road = |place: usize| {
            self.roads.get(place).is_some_and(|label| {
                !is_tunnel(*label) && class_of(*label).is_some_and(|class| class <= LAST_WIDE_ROAD)
            })
        };
        let row = place - place % self.columns as usize;
        let is_in_row = |beside: &usize| (row..row + self.columns as usize).contains(beside);
        let in_row = [place.checked_sub(across), Some(place + across)].into_iter().flatten();
        let above = place.checked_sub(down);
        in_row.filter(is_in_row).chain(above).chain([place, place + down]).any(is_road)
    }
}

/// The wanted classes of which at least `least` samples have labels.
fn classes(counts: &[u32; 256], least: u32, is_wanted: impl Fn(u8) -> bool) -> ClassSet {
    let mut of_classes = [0_u32; FunctionalRoadClass::COUNT];
    let there = (0_u8..=u8::MAX).zip(counts).filter(|(_, count)| **count > 0);
    for (label, count) in there.filter(|(label, _)| is_wanted(*label)) {
        if let Some(of_class) =
            class_of(label).and_then(|class| of_classes.get_mut(usize::from(class)))
        {
            *of_class += count;
        }
    }
    FunctionalRoadClass::all()
        .filter(|class| of_classes[usize::from(class.number())] >= least)
        .collect()
}

/// The true heights of the ground at some samples. Each sample is given by its index in the
/// camera's picture, row by row, and its value in the depth buffer. World heights are
/// `vertical_scale` times true heights. Samples without ground are skipped.
pub(crate) fn heights_m(
    camera: &Camera,
    vertical_scale: f64,
    depths: impl Iterator<Item = (usize, f64)>,
) -> impl Iterator<Item = (usize, f64)> {
    let columns = camera.size_px[0] as usize;
    depths.filter(|(_, depth)| *depth > 0.0).map(move |(place, depth)| {
        let middle = DVec2::new((place % columns) as f64, (place / columns) as f64) + 0.5;
        let start = camera.ray_start_in_world(middle).z;
        let height = start + camera.ray_in_world(middle).z * camera.depth_m(depth);
        (place, height / vertical_scale)
    })
}

impl ShownTiles {
    /// Adds the heights of samples; `areas` and `numbered` are as in [`SeenSamples`].
    pub(crate) fn with_heights(
        mut self,
        heights_m: impl Iterator<Item = (usize, f64)>,
        areas: Option<&[u16]>,
        numbered: &[LayerClass],
    ) -> Self {
        let count = numbered.len() + 1;
        let (mut sums_m, mut counts) = (vec![0.0_f64; count], vec![0_u32; count]);
        for (place, height_m) in heights_m {
            let [lowest, highest] = self.heights_m.unwrap_or([height_m; 2]);
            self.heights_m = Some([lowest.min(height_m), highest.max(height_m)]);
            let area =
                areas.and_then(|areas| areas.get(place)).map_or(0, |area| usize::from(*area));
            if let (Some(sum_m), Some(count)) = (sums_m.get_mut(area), counts.get_mut(area)) {
                *sum_m += height_m;
                *count += 1;
            }
        }
        for seen in &mut self.layers {
            let number = numbered.iter().position(|class| *class == seen.class);
            seen.height_m = number
                .map(|number| number + 1)
                .filter(|number| counts[*number] > 0)
                .map(|number| sums_m[number] / f64::from(counts[number]));
        }
        self
    }
}

#[cfg(test)]
#[path = "seen_tests.rs"]
mod tests;
