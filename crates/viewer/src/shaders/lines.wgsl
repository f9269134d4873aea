// Lines beside the roads, over the picture: block by block, what their labels say.

// The same fields as in gpu/drawables/line_layers.rs, in the same order.
struct LineColors {
    // rgb; w: distance at which haze hides two thirds of a colour.
    haze: vec4<f32>,
    bands: array<vec4<f32>, BANDS * CLASSES>,
}

@group(1) @binding(3) var<uniform> colors: LineColors;

@fragment
fn line_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(position.xy);
    let label = label_of(textureLoad(road_labels, pixel, 0).r);
    let depth_buffer = textureLoad(terrain_depth, pixel, 0).r;
    if label == 0u || depth_buffer == 0.0 {
        discard;
    }
    let line_class = class_of(label);
    let distance_m = scale_depth_of(depth_buffer) * length(ray_at(position.xy));
    let reach = distance_m / colors.haze.w;
    let haze = 1.0 - exp(-reach * reach);
    let color = mix(colors.bands[line_class * BANDS + label % BANDS].rgb, colors.haze.rgb, 0.5 * haze);
    return vec4(color, frame.road_limits[line_class].z * shown_share(line_class, PLAIN, distance_m));
}
