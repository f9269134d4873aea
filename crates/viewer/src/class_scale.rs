//! Which road classes a picture shows: this depends on the ground that a pixel covers, not on the
//! level of a tile.
//!
//! The ground that a pixel covers is computed from a point's distance to the eye, as if the point
//! were in the middle of the picture and faced the eye. So what is shown at a point does not change
//! when the camera only turns. The shaders apply the rule to each pixel (`shown_share` in
//! `shaders/common.wgsl`). This module derives the consequences for whole tiles: the classes that
//! need not be drawn, and the level that has all the others.

use corniche_geom::MAX_LEVEL;
use corniche_roads::FunctionalRoadClass;
use corniche_styles::{RoadStyle, Style};
use corniche_tileset::LevelRecord;

use crate::{
    camera::Camera,
    frame_view::FrameView,
    options::{ClassSet, RoadMethod, RoadOptions, WidthGrowth},
};

/// Distances and widths are passed to shaders as f32. This value means a limit that is never
/// reached.
const EVERYWHERE_M: f64 = 1e30;

/// The distance from the eye, world metres, up to which a pixel covers at most `max_pixel_m` true
/// metres of ground.
pub(crate) fn distance_m(max_pixel_m: Option<f32>, camera: &Camera, point_scale: f64) -> f64 {
    max_pixel_m.map_or(EVERYWHERE_M, |max_pixel_m| {
        f64::from(max_pixel_m) * point_scale / camera.pixel_at_unit_depth_m()
    })
}

/// The distance from the eye, world metres, up to which roads of a short part of the network are
/// fully shown, per metre of the part's length.
pub(crate) fn part_distance_m(style: &Style, camera: &Camera) -> f64 {
    // Multiplied by the length of a part that is not short, the value still fits an f32.
    const ALL_M: f64 = 1e15;
    let shortest = f64::from(style.shortest_part_px) * camera.pixel_at_unit_depth_m();
    if shortest > 0.0 { (1.0 / shortest).min(ALL_M) } else { ALL_M }
}

/// The half width, as a share of the distance from the eye, at which roads stop growing with
/// distance.
pub(crate) fn half_width_limit(road: &RoadStyle, growth: WidthGrowth, camera: &Camera) -> f64 {
    match (road.max_width_px, growth) {
        (Some(max_width_px), WidthGrowth::ByDistance) => {
            f64::from(max_width_px) / 2.0 * camera.pixel_at_unit_depth_m()
        }
        _ => EVERYWHERE_M,
    }
}

/// The classes that are shown at a distance of `nearest_m` world metres or more.
pub(crate) fn shown_classes(view: &FrameView<'_>, nearest_m: f64) -> ClassSet {
    let pixel_m = view.camera.pixel_at_unit_depth_m() * nearest_m / view.point_scale;
    let classes = view.roads.classes.iter();
    classes.filter(|class| view.style.road(*class).last_pixel_m() > pixel_m).collect()
}

/// For each level, the ground per pixel from which on the level's tiles have every road that is
/// shown.
///
/// A package stores less important classes on fine levels only. If a style shows one of these
/// classes where the terrain alone would be drawn from a coarser level, the tiles there are
/// refined, both ground and roads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelScales([f64; MAX_LEVEL as usize + 1]);

impl LevelScales {
    /// No scales: roads do not affect the level.
    pub const ANY: Self = Self([0.0; MAX_LEVEL as usize + 1]);

    /// Computes the scales that the roads of a package need, by its levels from the root on.
    ///
    /// Classes that a style shows at every scale need no scale: they are drawn where the tiles have
    /// them. Otherwise a style without scales would draw a whole country from its finest level.
    #[must_use]
    pub fn of_roads(levels: &[LevelRecord], style: &Style, roads: RoadOptions) -> Self {
        let mut scales = Self::ANY;
        let Some(finest) = levels.last().and_then(|level| level.least_class) else { return scales };
        if roads.method == RoadMethod::None {
            return scales;
        }
        for (level, scale) in levels.iter().zip(&mut scales.0) {
            *scale = FunctionalRoadClass::all()
                .filter(|class| roads.classes.contains(*class) && class.number() <= finest)
                .filter(|class| level.least_class.is_none_or(|least| least < class.number()))
                .map(|class| style.road(class).last_pixel_m())
                .filter(|pixel_m| pixel_m.is_finite())
                .fold(0.0, f64::max);
        }
        scales
    }

    /// The true metres per pixel below which tiles of a level lack a road.
    #[must_use]
    pub fn least_pixel_m(&self, level: u8) -> f64 {
        self.0.get(usize::from(level)).copied().unwrap_or_default()
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "class_scale_tests.rs"]
mod tests;
