// Ground, roads and sky into one picture.
//
// Outlines as in Vaaraniemi, Treib & Westermann 2011, section 6.2: a maximum filter over the importance of the
// roads around a pixel, minus the pixel's own. Whatever is left is the edge of the more important road.

@group(1) @binding(0) var ground_color: texture_2d<f32>;
@group(1) @binding(1) var terrain_depth: texture_2d<f32>;
@group(1) @binding(2) var road_labels: texture_2d<f32>;

// Ground that many times farther away than its neighbour in the picture lies behind it.
const FARTHER = 1.1;

// From what the target stores.
fn label_of(stored: f32) -> u32 {
    return u32(round(stored * 255.0));
}

fn class_of(label: u32) -> u32 {
    return CLASSES - label / 2u;
}

// The largest label around a pixel, of roads on ground of at least this depth in the buffer.
fn largest_around(pixel: vec2<i32>, own: f32, least_depth: f32) -> f32 {
    let radius = i32(frame.road_scale.z);
    let last = vec2<i32>(i32(frame.right.w), i32(frame.up.w)) - 1;
    var largest = own;
    for (var y = -radius; y <= radius; y++) {
        for (var x = -radius; x <= radius; x++) {
            let near = clamp(pixel + vec2(x, y), vec2(0), last);
            let stored = textureLoad(road_labels, near, 0).r;
            if stored > largest {
                // A road behind a crest has no edge on the crest.
                if textureLoad(terrain_depth, near, 0).r >= least_depth {
                    largest = stored;
                }
            }
        }
    }
    return largest;
}

fn background_at(ray: vec3<f32>) -> vec3<f32> {
    let elevation = ray.z / length(ray);
    let above = mix(frame.haze.rgb, frame.sky.rgb, smoothstep(0.0, 0.35, elevation));
    return mix(frame.background.rgb, above, smoothstep(-0.25, 0.0, elevation));
}

// Width of a road at a place in pixels of the final picture, before it is kept from getting too thin.
fn width_px(road_class: u32, distance_m: f32, depth: f32) -> f32 {
    return 2.0 * scaled_half_width_m(road_class, distance_m) / (frame.sky.w * depth * frame.road_scale.w);
}

@fragment
fn fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(position.xy);
    let ray = ray_at(position.xy);
    let depth_buffer = textureLoad(terrain_depth, pixel, 0).r;
    if depth_buffer == 0.0 {
        return vec4(background_at(ray), 1.0);
    }
    let depth = view_depth_of(depth_buffer);
    let distance_m = depth * length(ray);
    let reach = distance_m / frame.haze.w;
    let haze = 1.0 - exp(-reach * reach);
    var color = mix(textureLoad(ground_color, pixel, 0).rgb, frame.haze.rgb, haze);

    let own = textureLoad(road_labels, pixel, 0).r;
    let label = label_of(own);
    if label != 0u {
        let road_class = class_of(label);
        let fill = select(frame.road_fills[road_class].rgb, frame.road_centers[road_class].rgb, (label & 1u) == 1u);
        // A road drawn wider than it is, to be seen at all, fades instead.
        let least_px = 2.0 * frame.road_widths[road_class].y / frame.road_scale.w;
        let presence = clamp(width_px(road_class, distance_m, depth) / least_px, 0.35, 1.0);
        color = mix(color, mix(fill, frame.haze.rgb, 0.5 * haze), presence);
    }

    let most = label_of(largest_around(pixel, own, depth_buffer / FARTHER));
    if most / 2u > label / 2u {
        let road_class = class_of(most);
        // An edge around a thread of a road would be all one sees of it.
        let presence = smoothstep(1.5, 5.0, width_px(road_class, distance_m, depth));
        color = mix(color, mix(frame.road_outlines[road_class].rgb, frame.haze.rgb, 0.5 * haze), presence);
    }
    return vec4(color, 1.0);
}
