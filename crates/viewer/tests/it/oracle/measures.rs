//! Measures a drawing: how much of the centre-lines is missing.

use corniche_roads::OwnWidth;
use corniche_viewer::{
    RoadMethod, RoadOptions,
    camera::{Camera, CameraProjection},
    for_tests::GroundLine,
    tiles::RoadLook,
};
use glam::{DVec2, DVec3};

use super::{
    ground_rays::Caster,
    reference::{Look, Tri, distance, half_width, lateness, shows},
    support::{
        Drawing,
        scene::{Scene, Tile},
    },
};

/// Length of the steps along a centre-line.
const STEP_PX: f64 = 0.25;

/// A centre-line: class, own width, look and points.
pub(crate) type Line = ((u8, OwnWidth, RoadLook), Vec<DVec3>);

/// Lengths in the picture.
#[derive(Debug, Clone, Copy, Default)]
#[expect(clippy::struct_field_names, reason = "the unit is part of each name")]
pub(crate) struct CenterLines {
    /// Length of centre-lines in view.
    pub(crate) seen_px: f64,
    /// Length in view without any road at the pixel.
    pub(crate) missing_px: f64,
    /// Missing length at silhouettes, where a pixel's centre may show other ground than its line.
    pub(crate) missing_at_jumps_px: f64,
}

/// Walks all centre-lines of a scene, except those of short parts of the network, which are not
/// drawn everywhere.
pub(crate) fn center_lines(scene: &Scene, camera: &Camera, drawing: &Drawing) -> CenterLines {
    let lines: Vec<Line> = scene
        .tiles
        .iter()
        .flat_map(|tile| tile.centers.iter().map(move |line| (tile, line)))
        .filter(|(tile, line)| scene.style.shortest_part_px == 0.0 || goes_on(tile, line))
        .map(|(_, line)| line)
        .map(|line| {
            let points = line.points_m.iter().map(|point| DVec3::from_array(*point)).collect();
            ((line.kind.class.number(), line.kind.own_width, line.kind.look), points)
        })
        .collect();
    walk(&lines, scene, &Caster::new(scene, camera), camera, drawing)
}

/// Whether a line belongs to a part of the network that leaves the tile.
fn goes_on(tile: &Tile, line: &GroundLine) -> bool {
    let at = DVec3::from_array(line.points_m[0]).truncate();
    let mut here = tile.segments_near(at).iter().filter(|segment| {
        segment.class == line.kind.class.number() && distance(at, segment.ends, [false; 2]) < 1e-3
    });
    here.all(|segment| segment.part_m[0].is_infinite())
}

/// Walks lines in quarter pixels; points behind ground do not count.
pub(crate) fn walk(
    lines: &[Line],
    scene: &Scene,
    caster: &Caster<'_>,
    camera: &Camera,
    drawing: &Drawing,
) -> CenterLines {
    let options = RoadOptions::for_method(RoadMethod::ShadowVolumes);
    let scale_m = |depth_m| camera.pixel_at_depth_m(depth_m) / camera.pixel_at_unit_depth_m();
    let half_px = |(class, own, kind): (u8, OwnWidth, RoadLook), depth_m: f64| {
        let look = Look { style: &scene.style, options, camera };
        let (half_m, least_px) = half_width(look, (class, own, kind), 1.0, scale_m(depth_m));
        (half_m / camera.pixel_at_depth_m(depth_m)).max(least_px)
    };
    let mut sum = CenterLines::default();
    let [width, height] = drawing.size_px;
    let size = DVec2::new(f64::from(width), f64::from(height));
    let pairs = lines.iter().flat_map(|line| line.1.windows(2).map(move |pair| (line, pair)));
    for (line, pair) in pairs {
        let [a, b] = [pair[0], pair[1]];
        let (Some((from, from_m)), Some((to, to_m))) = (camera.project(a), camera.project(b))
        else {
            continue;
        };
        let steps = (from.distance(to) / STEP_PX).ceil();
        if from.max(to).cmplt(DVec2::ZERO).any() || from.min(to).cmpge(size).any() {
            continue;
        }
        let step_px = from.distance(to) / steps.max(1.0);
        for k in 0..steps as u32 {
            let share = (f64::from(k) + 0.5) / steps;
            let at = from.lerp(to, share);
            if at.cmplt(DVec2::ZERO).any() || at.cmpge(size).any() {
                continue;
            }
            let depth_m = match camera.projection {
                // Depths along a line are linear in their reciprocals.
                CameraProjection::Perspective => 1.0 / ((1.0 - share) / from_m + share / to_m),
                CameraProjection::FromAbove { .. } => (1.0 - share) * from_m + share * to_m,
            };
            let in_view = |at: DVec2| {
                caster.hit(at).is_none_or(|hit| hit.depth_m >= depth_m * (1.0 - 1e-6) - 1e-3)
            };
            let place = camera.ray_start_in_world(at) + camera.ray_in_world(at) * depth_m;
            let distance_m = camera.seeing_distance_m(place);
            let (class, _, kind) = line.0;
            let seen_from_m = lateness(kind) * distance_m;
            let is_shown = shows(&scene.style, camera, class, seen_from_m) == Tri::Yes;
            if !in_view(at) || !is_shown {
                continue;
            }
            sum.seen_px += step_px;
            if !has_road(drawing, at, half_px(line.0, depth_m)) {
                let around = [[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]];
                let is_smooth = around.into_iter().map(DVec2::from_array).all(|offset| {
                    let hit = caster.hit(at + offset);
                    hit.is_some_and(|hit| (hit.depth_m / depth_m - 1.0).abs() < 0.01)
                });
                *(if is_smooth { &mut sum.missing_px } else { &mut sum.missing_at_jumps_px }) +=
                    step_px;
            }
        }
    }
    sum
}

/// Whether the pixel of a point on a centre-line shows a road. If the road is thinner than the
/// diagonal of a pixel, one of the four pixels around the point must show it.
fn has_road(drawing: &Drawing, at: DVec2, half_px: f64) -> bool {
    let [width, height] = drawing.size_px;
    let label = |at: DVec2| {
        let x = (at.x.max(0.0) as u32).min(width - 1);
        let y = (at.y.max(0.0) as u32).min(height - 1);
        drawing.labels[(y * width + x) as usize]
    };
    if half_px >= std::f64::consts::FRAC_1_SQRT_2 {
        return label(at) != 0;
    }
    let around = [[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]];
    around.into_iter().any(|offset| label(at + DVec2::from_array(offset)) != 0)
}
