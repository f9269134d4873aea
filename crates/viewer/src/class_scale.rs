//! Which classes of roads a picture shows: by how much ground a pixel covers, whatever the level of a tile.
//!
//! The ground that a pixel covers is counted at a place's distance from the eye, as if it lay in the middle of the picture
//! and faced the eye. So what is shown at a place does not change when the camera only turns. The shaders apply the rule to
//! each pixel (`shown_share` in `shaders/common.wgsl`). Here is what follows from it for whole tiles: the classes that need
//! not be drawn, and the level that has all the others.

use corniche_geom::MAX_LEVEL;
use corniche_roads::FunctionalRoadClass;
use corniche_styles::{RoadStyle, Style};
use corniche_tileset::LevelRecord;

use crate::{
    camera::Camera,
    frame_view::FrameView,
    options::{ClassSet, RoadMethod, RoadOptions, WidthGrowth},
};

/// Distances and widths are passed to shaders as f32. This one stands for a limit that is never reached.
const EVERYWHERE_M: f64 = 1e30;

/// The distance from the eye, world metres, up to which a pixel covers at most so many true metres of ground.
pub(crate) fn distance_m(max_pixel_m: Option<f32>, camera: &Camera, point_scale: f64) -> f64 {
    max_pixel_m.map_or(EVERYWHERE_M, |max_pixel_m| {
        f64::from(max_pixel_m) * point_scale / camera.pixel_at_unit_depth_m()
    })
}

/// The distance from the eye, world metres, up to which roads of a short part of the network are shown in full, for each metre of
/// the part's length.
pub(crate) fn part_distance_m(style: &Style, camera: &Camera) -> f64 {
    // Times the length of a part that is not short, it still is an f32.
    const ALL_M: f64 = 1e15;
    let shortest = f64::from(style.shortest_part_px) * camera.pixel_at_unit_depth_m();
    if shortest > 0.0 { (1.0 / shortest).min(ALL_M) } else { ALL_M }
}

/// The half width, as a share of the distance from the eye, beyond which roads do not grow with distance.
pub(crate) fn half_width_limit(road: &RoadStyle, growth: WidthGrowth, camera: &Camera) -> f64 {
    match (road.max_width_px, growth) {
        (Some(max_width_px), WidthGrowth::ByDistance) => {
            f64::from(max_width_px) / 2.0 * camera.pixel_at_unit_depth_m()
        }
        _ => EVERYWHERE_M,
    }
}

/// The classes of which something is shown `nearest_m` world metres from the eye or farther away.
pub(crate) fn shown_classes(view: &FrameView<'_>, nearest_m: f64) -> ClassSet {
    let pixel_m = view.camera.pixel_at_unit_depth_m() * nearest_m / view.point_scale;
    let classes = view.roads.classes.iter();
    classes.filter(|class| view.style.road(*class).last_pixel_m() > pixel_m).collect()
}

/// How much ground a pixel covers on each level where the level's tiles lack no road that is shown there.
///
/// A package stores less important classes on fine levels only. If a style shows one of them where the terrain alone would
/// be drawn from a coarser level, the tiles there are refined, ground and roads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelScales([f64; MAX_LEVEL as usize + 1]);

impl LevelScales {
    /// Roads do not matter.
    pub const ANY: Self = Self([0.0; MAX_LEVEL as usize + 1]);

    /// The scales that the roads of a package need, by its levels from the root on.
    ///
    /// Classes that a style shows at every scale need none: they are drawn where the tiles have them. Else a style without
    /// scales would draw all of a country from its finest level.
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

    /// True metres: tiles of a level lack something where a pixel covers less.
    #[must_use]
    pub fn least_pixel_m(&self, level: u8) -> f64 {
        self.0.get(usize::from(level)).copied().unwrap_or_default()
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "class_scale_tests.rs"]
mod tests;
