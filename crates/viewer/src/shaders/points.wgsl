// Points: a disc around each point. A point is visible if the ground does not hide the point
// itself, so no disc is cut off where it stands.

struct PointLook {
    // rgb; w: opacity.
    color: vec4f,
    // rgb of the edge.
    outline: vec4f,
    // rgb; w: distance at which haze hides two thirds of a colour.
    haze: vec4f,
    // x: radius of the disc; y: radius with its edge, both in pixels of the final picture; z:
    // distance from the eye up to which the class is fully shown.
    size: vec4f,
}

@group(2) @binding(0) var terrain_depth: texture_2d<f32>;
@group(3) @binding(0) var<uniform> look: PointLook;

struct Corner {
    @builtin(position) clip: vec4f,
    // Place on the disc, pixels of the final picture.
    @location(0) on_disc: vec2f,
    // Distance from the eye.
    @location(1) @interpolate(flat) distance_m: f32,
}

// Ground in front of a point by less than this share of its depth does not hide it.
const BIAS = 0.001;

// Whether the ground hides a point with this clip position: it is nearer at the point's pixel and
// at all pixels next to it. From above nothing is hidden.
fn is_hidden(clip: vec4f) -> bool {
    if is_from_above() {
        return false;
    }
    let at = vec2(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w);
    let pixel = vec2i(floor(at * vec2(frame.right.w, frame.up.w)));
    var depth_buffer = 1e30;
    for (var k = 0; k < 9; k++) {
        let near = clamp(pixel + vec2(k % 3 - 1, k / 3 - 1), vec2(0), last_pixel());
        depth_buffer = min(depth_buffer, textureLoad(terrain_depth, near, 0).r);
    }
    return depth_buffer > 0.0 && view_depth_of(depth_buffer) < clip.w * (1.0 - BIAS);
}

@vertex
fn vertex(@builtin(vertex_index) corner: u32, @location(0) place: vec3f) -> Corner {
    let position = vec3(tile.offset.xy + place.xy, tile.offset.z + place.z * frame.scale.y);
    let side = vec2(f32(corner & 1u), f32(corner >> 1u)) * 2.0 - 1.0;
    var out = Corner(clip_of(position), side * look.size.y, distance_to(position));
    // Points behind the eye have no place on the picture.
    if out.clip.w <= frame.forward.w && !is_from_above() || is_hidden(out.clip) {
        out.clip = vec4(2.0, 2.0, 0.5, 1.0);
        return out;
    }
    let reach = out.on_disc * 2.0 * frame.road_scale.w / vec2(frame.right.w, frame.up.w);
    out.clip += vec4(reach * out.clip.w, 0.0, 0.0);
    return out;
}

@fragment
fn fragment(in: Corner) -> @location(0) vec4f {
    let from_middle = length(in.on_disc);
    if from_middle > look.size.y {
        discard;
    }
    let color = select(look.color.rgb, look.outline.rgb, from_middle > look.size.x);
    let haze = 0.5 * haze_share(in.distance_m, look.haze.w);
    return vec4(mix(color, look.haze.rgb, haze), look.color.w * share_within(look.size.z, in.distance_m));
}
