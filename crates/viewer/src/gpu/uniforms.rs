//! The uniform blocks that drawables share: rows of four f32, in the order of the shaders'
//! structures.
//!
//! The frame's block is shared because all drawables need the camera, and because GEO roads, SV
//! roads and the composite must compute the same road widths. Uniforms of a single drawable, such
//! as the colours of the ground, are in the drawable's file.

use glam::DVec4;

use corniche_styles::{Dash, OwnWidths, RoadBands};

use crate::{
    camera::CameraProjection,
    class_scale,
    frame_view::FrameView,
    options::{CapTest, Caps, Quads, RoadMethod},
};

/// Bytes of a tile's block.
pub(crate) const TILE_BYTES: u64 = 32;

/// The frame's block, as declared by `struct Frame` of `shaders/common.wgsl`.
pub(crate) fn frame_rows(view: &FrameView<'_>, samples_per_side: u32) -> Vec<[f32; 4]> {
    let style = view.style;
    // The passes know samples only: for them the picture has as many pixels as samples.
    let camera = view.camera.supersampled(samples_per_side);
    let axes = camera.world_from_view;
    let half = camera.half_extent();
    let [width_px, height_px] = camera.size_px.map(f64::from);
    let samples = samples_per_side as f32;
    // Without roads there are no outlines.
    let outline_px = match view.roads.method {
        RoadMethod::None => 0,
        _ => view.roads.outline_px(style),
    };
    let constant = view.roads.width_scaling(style, &style.roads[0]).constant;

    let mut rows: Vec<[f32; 4]> = camera
        .clip_from_relative()
        .to_cols_array_2d()
        .map(|column| column.map(|value| value as f32))
        .to_vec();
    rows.extend(
        [
            (axes.x_axis * half.x).extend(width_px),
            (axes.y_axis * half.y).extend(height_px),
            (-axes.z_axis).extend(camera.near_m),
        ]
        .map(row),
    );
    // Half the drawn width per metre of a road's own width: 0 if own widths are ignored.
    let half_of_own = if style.own_widths.is_some() { 0.5 * constant } else { 0.0 };
    let lane_m = style.own_widths.and_then(|widths| widths.lane_m).unwrap_or_default();
    rows.push([
        camera.pixel_at_unit_depth_m() as f32,
        view.vertical_scale() as f32,
        half_of_own,
        lane_m,
    ]);
    rows.push([
        style.width_scaling.threshold_m * view.point_scale as f32,
        0.0,
        outline_px as f32 * samples,
        samples,
    ]);
    rows.push([
        if view.roads.caps == Caps::Round { 1.0 } else { 0.0 },
        if view.roads.cap_test == CapTest::PaperQuadratic { 1.0 } else { 0.0 },
        view.point_scale as f32,
        OwnWidths::WIDEST_M,
    ]);
    let is_level = view.roads.quads == Quads::Level;
    let part_distance_m = class_scale::part_distance_m(style, view.camera) as f32;
    let parallel = match camera.projection {
        CameraProjection::Perspective => [0.0, 0.0],
        CameraProjection::FromAbove { far_m } => [far_m as f32, camera.focus_m as f32],
    };
    rows.push([part_distance_m, if is_level { 1.0 } else { 0.0 }, parallel[0], parallel[1]]);
    rows.extend(style.roads.iter().map(|road| {
        let bands = road.bands.all().len() as f32;
        let half_width_m = road.width_m / 2.0 * constant;
        // In pixels of the picture: the number of samples per pixel has no effect.
        let full_m = class_scale::distance_m(road.max_pixel_m, view.camera, view.point_scale);
        [half_width_m, road.min_width_px / 2.0 * samples, bands, full_m as f32]
    }));
    rows.extend(style.roads.iter().map(|road| {
        let exponent = view.roads.width_scaling(style, road).exponent;
        let edge_m = class_scale::distance_m(road.edge_max_pixel_m, view.camera, view.point_scale);
        [exponent, edge_m as f32, 0.0, 0.0]
    }));
    rows.extend(style.roads.iter().map(|road| {
        let limit = class_scale::half_width_limit(road, view.roads.width_growth, view.camera);
        [
            limit as f32,
            road.carriageway_width_m / road.width_m,
            road.opacity,
            road.bands.of_slip_roads() as f32,
        ]
    }));
    rows.extend(style.roads.iter().flat_map(|road| {
        let mut shares = [0.0; RoadBands::MOST];
        for (share, band) in shares.iter_mut().zip(road.bands.all()) {
            *share = band.width_share;
        }
        bytemuck::cast::<_, [[f32; 4]; RoadBands::MOST / 4]>(shares)
    }));
    rows.extend(style.roads.iter().map(|road| {
        let [first, gap, second] = road.dash.ends;
        [first, gap, second, road.dash.least_px]
    }));
    rows.extend(style.roads.iter().flat_map(|road| {
        // Without a pattern, a number that is not a valid width.
        let widths = road.dash.widths.unwrap_or([-1.0; Dash::WIDTHS]);
        bytemuck::cast::<_, [[f32; 4]; Dash::WIDTHS / 4]>(widths)
    }));
    rows
}

/// Converts a row of a block to f32.
pub(crate) fn row(values: DVec4) -> [f32; 4] {
    values.as_vec4().to_array()
}

/// A row with a colour and one more number.
pub(crate) fn color([red, green, blue]: [f32; 3], last: f32) -> [f32; 4] {
    [red, green, blue, last]
}
