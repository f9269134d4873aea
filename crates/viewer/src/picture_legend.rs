//! The legend of a picture: the features that the picture shows, as they look in its middle.

use corniche_roads::FunctionalRoadClass;
use corniche_styles::{AreaStyle, LayerLook, LineStyle, PointStyle, Rgb, RoadBand, RoadStyle};
use corniche_tileset::Manifest;

use crate::{
    annotations::{Legend, LegendEdge, LegendHeights, LegendRoad, LegendRow, LegendSample},
    class_scale,
    frame_view::FrameView,
    gpu::seen::{SeenClass, ShownTiles},
    layer_legend::class_title,
};

/// Remaining share of the colours of a tunnel's surface and of its edge, as in
/// `shaders/road_colors.wgsl`.
const TUNNEL_FILL: f32 = 0.35;
const TUNNEL_EDGE: f32 = 0.75;
/// Edges with a smaller share are not visible.
const LEAST_EDGE: f32 = 0.1;
/// Minimum share of the dashes of a tunnel in a legend.
const LEAST_DASH: f32 = 0.5;
/// Number of colours in a ramp of heights.
const RAMP_COLORS: usize = 64;
/// Colours of heights that differ by at most this do not show heights.
const LEAST_TINT: f32 = 0.03;

/// Additional data for a legend, besides the contents of the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct LegendRequest {
    /// The labels of the road classes, 0 first.
    pub road_labels: [String; FunctionalRoadClass::COUNT],
    /// The denominator of the scale of the printed picture, if it is known.
    pub scale: Option<u32>,
}

/// Returns the legend of a picture. `has_tint` tells whether the ground of any tile has colours by
/// its height.
pub(crate) fn legend(
    view: &FrameView<'_>,
    (request, manifest): (&LegendRequest, &Manifest),
    seen: &ShownTiles,
    has_tint: bool,
) -> Legend {
    let axes = view.camera.world_from_view;
    let road = |class: FunctionalRoadClass| {
        let label = request.road_labels[usize::from(class.number())].clone();
        LegendRow { label, sample: LegendSample::Road(road(view, class)) }
    };
    let tunnel = seen.tunnels.iter().next().map(|class| {
        let label = "tunnel".to_owned();
        LegendRow { label, sample: LegendSample::Tunnel(tunnel(view, class)) }
    });
    let rows = seen.roads.iter().map(road).chain(tunnel);
    let of_layer = |seen: &SeenClass| {
        let sample = layer_sample(view, seen)?;
        Some(LegendRow { label: class_title(manifest, seen.class), sample })
    };
    let rows = rows.chain(seen.layers.iter().filter_map(of_layer)).collect();
    Legend {
        pixel_m: view.camera.pixel_at_unit_depth_m() * view.camera.focus_m / view.point_scale,
        // The right axis of the view is level, and its angle from east is the angle of north from
        // the top.
        north_deg: axes.x_axis.y.atan2(axes.x_axis.x).to_degrees(),
        scale: request.scale,
        ground: tint(view, middle_m(view)),
        rows: LegendRow::joined(rows),
        heights: seen.heights_m.filter(|_| has_tint).and_then(|range_m| heights(view, range_m)),
    }
}

/// Width of a road of a class in the middle of the picture, pixels, before the minimum width is
/// applied.
fn seen_px(view: &FrameView<'_>, road: &RoadStyle) -> f32 {
    let (distance_m, scaling) = (view.camera.focus_m, view.roads.width_scaling(view.style, road));
    let near_m = f64::from(road.width_m) * view.point_scale;
    let grown_m = near_m * scaling.factor(distance_m / view.point_scale);
    let limit = class_scale::half_width_limit(road, view.roads.width_growth, view.camera);
    let width_m = grown_m.min((2.0 * distance_m * limit).max(near_m));
    (width_m / (view.camera.pixel_at_unit_depth_m() * distance_m)) as f32
}

/// How a road of a class looks in the middle of the picture, as `shaders/road_colors.wgsl` draws
/// it.
fn road(view: &FrameView<'_>, class: FunctionalRoadClass) -> LegendRoad {
    let road = view.style.road(class);
    let seen_px = seen_px(view, road);
    let least_px = road.min_width_px;
    let presence = (seen_px / least_px.max(f32::MIN_POSITIVE)).clamp(0.5, 1.0) * road.opacity;
    let thin = road.thin.unwrap_or(road.bands.main_color());
    let is_wide = smoothstep(1.0, 2.2, seen_px) * edge_share(view, road);
    let band = |band: &RoadBand| {
        let color = mix(thin, band.color, is_wide);
        RoadBand { color: over_ground(view, color, presence), ..*band }
    };
    let bands: Vec<RoadBand> = road.bands.all().iter().map(band).collect();
    // A road that is drawn in one colour has one band.
    let count = if is_wide > 0.0 { bands.len() } else { 1 };
    let edge = edge(view, road.outline, edge_presence(view, road, seen_px));
    LegendRoad { width_px: seen_px.max(least_px), bands: bands[..count].to_vec(), edge }
}

/// The share of the edge of these roads that is drawn in the middle of the picture: it fades within
/// a zoom step.
fn edge_share(view: &FrameView<'_>, road: &RoadStyle) -> f32 {
    let pixel_m = view.camera.pixel_at_unit_depth_m() * view.camera.focus_m / view.point_scale;
    road.edge_max_pixel_m.map_or(1.0, |max_pixel_m| {
        (1.0 - libm::log2(pixel_m / f64::from(max_pixel_m))).clamp(0.0, 1.0) as f32
    })
}

/// How much the edge of a road of this width hides.
fn edge_presence(view: &FrameView<'_>, road: &RoadStyle, seen_px: f32) -> f32 {
    smoothstep(1.2, 4.0, seen_px) * edge_share(view, road) * road.opacity
}

/// Returns an edge; `None` if it is not visible.
fn edge(view: &FrameView<'_>, color: Rgb, presence: f32) -> Option<LegendEdge> {
    let width_px = view.roads.outline_px(view.style);
    let is_seen = presence >= LEAST_EDGE && width_px > 0;
    is_seen.then(|| LegendEdge { color: over_ground(view, color, presence), width_px })
}

/// How a tunnel of a class looks: paler than a road above the ground, in one colour. If its edge is
/// as dark as the ground, its dashes have the colour of the road.
fn tunnel(view: &FrameView<'_>, class: FunctionalRoadClass) -> LegendRoad {
    let road = view.style.road(class);
    let (seen_px, main_color) = (seen_px(view, road), road.bands.main_color());
    let luma = |color: Rgb| 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
    let ground = luma(tint(view, middle_m(view)));
    let is_lost = (luma(main_color) - ground).abs() > (luma(road.outline) - ground).abs();
    let dashes = if is_lost { main_color } else { road.outline };
    // Without dashes, a tunnel in a legend would look like nothing.
    let presence = (edge_presence(view, road, seen_px) * TUNNEL_EDGE).max(LEAST_DASH);
    LegendRoad {
        width_px: seen_px.max(road.min_width_px),
        bands: vec![RoadBand {
            width_share: 1.0,
            color: over_ground(view, main_color, TUNNEL_FILL * road.opacity),
        }],
        edge: edge(view, dashes, presence),
    }
}

/// Blends a colour over the ground in the middle of the picture.
fn over_ground(view: &FrameView<'_>, color: Rgb, opacity: f32) -> Rgb {
    mix(tint(view, middle_m(view)), color, opacity)
}

/// Height of the camera's target.
fn middle_m(view: &FrameView<'_>) -> f64 {
    view.camera.target_in_world().z / view.vertical_scale()
}

/// The colour of the ground at a height.
fn tint(view: &FrameView<'_>, height_m: f64) -> Rgb {
    view.style.tint.color_at(height_m, view.height_range_m, view.latitude_deg)
}

/// How a class of a layer looks over the ground under it; `None` if it is not drawn.
fn layer_sample(view: &FrameView<'_>, seen: &SeenClass) -> Option<LegendSample> {
    let ground = tint(view, seen.height_m.unwrap_or_else(|| middle_m(view)));
    Some(match view.layers.look(seen.class)? {
        LayerLook::Area(AreaStyle { color, opacity, .. }) => {
            LegendSample::Area(mix(ground, color, opacity))
        }
        LayerLook::Line(line) => {
            let color = mix(ground, line.color, line.opacity);
            LegendSample::Line(LineStyle { color, ..line })
        }
        LayerLook::Point(point) => {
            let over = |color| mix(ground, color, point.opacity);
            let outline = point.outline.map(over);
            LegendSample::Point(PointStyle { color: over(point.color), outline, ..point })
        }
    })
}

/// The colours of the ground between two heights; `None` if they do not show heights.
fn heights(view: &FrameView<'_>, range_m: [f64; 2]) -> Option<LegendHeights> {
    let [low, high] = range_m;
    let color = |place: usize| {
        let share = (place as f64 + 0.5) / RAMP_COLORS as f64;
        tint(view, low + (high - low) * share)
    };
    let colors: Vec<Rgb> = (0..RAMP_COLORS).map(color).collect();
    let differ = |color: &Rgb| {
        color.iter().zip(colors[0]).any(|(here, first)| (here - first).abs() > LEAST_TINT)
    };
    colors.iter().any(differ).then(|| LegendHeights { range_m, colors: colors.clone() })
}

fn mix(from: Rgb, to: Rgb, share: f32) -> Rgb {
    [0, 1, 2].map(|k| from[k] + (to[k] - from[k]) * share)
}

/// Same as the function of this name in WGSL.
fn smoothstep(low: f32, high: f32, value: f32) -> f32 {
    let share = ((value - low) / (high - low)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "picture_legend_tests.rs"]
mod tests;
