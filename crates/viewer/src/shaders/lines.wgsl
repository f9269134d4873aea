// Draws the labels of lines that are not roads as colours over the picture, block by block.

// The same fields as in gpu/drawables/line_layers.rs, in the same order.
struct LineColors {
    // rgb; w: distance at which haze hides two thirds of a colour.
    haze: vec4f,
    // x: 1 for lines that are omitted close to roads, by style.
    apart: array<vec4f, CLASSES>,
    bands: array<vec4f, BANDS * CLASSES>,
}

@group(1) @binding(3) var<uniform> colors: LineColors;
@group(1) @binding(4) var labels_of_roads: texture_2d<f32>;

// A line is not drawn this close to a road, in pixels of the final picture, and pale within twice
// this distance.
const APART_PX = 2.0;
const PALE = 0.3;
// Strength of a line in a tunnel.
const IN_TUNNEL = 0.6;
// Roads of these classes and above are wide enough to be found by samples on a circle, and to be
// confused with lines that follow them.
const LAST_ROAD = 6u;

fn is_road(pixel: vec2i) -> bool {
    let last = last_pixel();
    let label = label_of(textureLoad(labels_of_roads, clamp(pixel, vec2(0), last), 0).r);
    return label != 0u && !is_tunnel(label) && class_of(label) <= LAST_ROAD;
}

// Whether there is a road on a circle around a pixel. Samples are at most two pixels apart.
fn is_road_around(pixel: vec2i, radius_px: f32, samples: u32) -> bool {
    for (var k = 0u; k < samples; k++) {
        let angle = 6.2831853 * f32(k) / f32(samples);
        let offset = radius_px * frame.road_scale.w * vec2(cos(angle), sin(angle));
        if is_road(pixel + vec2i(round(offset))) {
            return true;
        }
    }
    return false;
}

// Share of a line that is drawn at a pixel. A line that follows a road would look like the dashes
// of a tunnel; with this rule a line that crosses a road leaves the road whole.
fn share_beside_roads(pixel: vec2i, line_class: u32) -> f32 {
    if colors.apart[line_class].x == 0.0 {
        return 1.0;
    }
    if is_road(pixel) || is_road_around(pixel, APART_PX, 8u) {
        return 0.0;
    }
    return select(1.0, PALE, is_road_around(pixel, 2.0 * APART_PX, 14u));
}

@fragment
fn line_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position.xy);
    let label = label_of(textureLoad(road_labels, pixel, 0).r);
    let depth_buffer = textureLoad(terrain_depth, pixel, 0).r;
    if label == 0u || depth_buffer == 0.0 {
        discard;
    }
    // Of a line in a tunnel only dashes are visible, and none under a road.
    let is_below = is_tunnel(label);
    let on_road = label_of(textureLoad(labels_of_roads, pixel, 0).r);
    if is_below && (label % 2u == 0u || (on_road != 0u && !is_tunnel(on_road))) {
        discard;
    }
    let line_class = class_of(label);
    let distance_m = scale_depth_of(depth_buffer) * length(ray_at(position.xy));
    let band = select(label % BANDS, 0u, is_below);
    let color = mix(colors.bands[line_class * BANDS + band].rgb, colors.haze.rgb, 0.5 * haze_at(distance_m));
    let opacity = frame.road_limits[line_class].z * share_beside_roads(pixel, line_class) * select(1.0, IN_TUNNEL, is_below);
    return vec4(color, opacity * shown_share(line_class, PLAIN, distance_m));
}
