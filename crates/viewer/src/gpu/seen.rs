//! The classes and heights that a finished picture shows. A class counts if it covers as much of
//! the picture as a few pixels.

use corniche_areas::AreaClass;
use corniche_roads::FunctionalRoadClass;
use glam::DVec2;

use super::labels::{class_of, is_tunnel};
use crate::{camera::Camera, options::ClassSet};

/// Minimum number of pixels of a class in a picture. Fewer pixels are not noticed.
const LEAST_PX: u32 = 4;
/// Boundaries are not drawn this close to roads of class [`LAST_WIDE_ROAD`] and above, as in
/// `shaders/lines.wgsl`.
const BOUNDARY_APART_PX: u32 = 2;
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
    /// Classes of boundaries, by their numbers.
    pub(crate) boundaries: ClassSet,
    /// Classes of areas, in order of their numbers.
    pub(crate) areas: Vec<SeenArea>,
    /// The lowest and the highest ground, true metres; `None` without ground.
    pub(crate) heights_m: Option<[f64; 2]>,
}

/// A class of areas in a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SeenArea {
    pub(crate) class: AreaClass,
    /// The mean true height of the visible ground under the areas; `None` if it is unknown.
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
    /// Labels of boundaries.
    pub(crate) boundaries: Option<&'a [u8]>,
    /// Numbers of area classes plus 1; 0 without an area.
    pub(crate) areas: Option<&'a [u8]>,
}

impl SeenSamples<'_> {
    /// Returns the visible classes, without heights.
    pub(crate) fn seen(&self) -> ShownTiles {
        let (mut roads, mut areas) = ([0_u32; 256], [0_u32; 256]);
        for (place, road) in self.roads.iter().enumerate() {
            let at = |samples: Option<&[u8]>| samples.and_then(|all| all.get(place).copied());
            let deck = at(self.decks).unwrap_or(0);
            let label = match deck {
                0 => *road,
                1..DECK_ROADS => 0,
                _ => deck,
            };
            roads[usize::from(label)] += 1;
            if let (0, 0, Some(area)) = (label, deck, at(self.areas)) {
                areas[usize::from(area)] += 1;
            }
        }
        let mut boundaries = [0_u32; 256];
        for (place, label) in self.boundaries.unwrap_or_default().iter().enumerate() {
            let deck = self.decks.and_then(|all| all.get(place)).copied().unwrap_or(0);
            if *label != 0 && deck == 0 && !self.is_beside_road(place) {
                boundaries[usize::from(*label)] += 1;
            }
        }
        let least = LEAST_PX * self.per_side * self.per_side;
        let is_seen = |class: &AreaClass| areas[usize::from(class.number()) + 1] >= least;
        let area = |class| SeenArea { class, height_m: None };
        ShownTiles {
            roads: classes(&roads, least, |_| true),
            tunnels: classes(&roads, least, is_tunnel),
            boundaries: classes(&boundaries, least, |_| true),
            areas: AreaClass::ALL.into_iter().filter(is_seen).map(area).collect(),
            heights_m: None,
        }
    }
}

impl SeenSamples<'_> {
    /// Whether a boundary is hidden at a sample because it is close to a road, as in
    /// `shaders/lines.wgsl`. Checks four samples around it.
    fn is_beside_road(&self, place: usize) -> bool {
        let across = (BOUNDARY_APART_PX * self.per_side) as usize;
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
    /// Adds the heights of samples; `areas` has their classes as in [`SeenSamples`].
    pub(crate) fn with_heights(
        mut self,
        heights_m: impl Iterator<Item = (usize, f64)>,
        areas: Option<&[u8]>,
    ) -> Self {
        let (mut sums_m, mut counts) = ([0.0_f64; 256], [0_u32; 256]);
        for (place, height_m) in heights_m {
            let [lowest, highest] = self.heights_m.unwrap_or([height_m; 2]);
            self.heights_m = Some([lowest.min(height_m), highest.max(height_m)]);
            let area =
                areas.and_then(|areas| areas.get(place)).map_or(0, |area| usize::from(*area));
            sums_m[area] += height_m;
            counts[area] += 1;
        }
        for area in &mut self.areas {
            let place = usize::from(area.class.number()) + 1;
            area.height_m = (counts[place] > 0).then(|| sums_m[place] / f64::from(counts[place]));
        }
        self
    }
}

#[cfg(test)]
#[path = "seen_tests.rs"]
mod tests;
