// The frame's uniform block, which every pass binds. It has the same fields as gpu/uniforms.rs, in
// the same order.
//
// Positions are relative to the eye, along the world's axes (x east, y north, z up), in metres.
// Depth is reversed with an infinite far plane: depth_buffer = near / view_depth, 0 where nothing
// was drawn.
//
// In a view from above all rays run straight down, and depth is linear from 1 above all ground to 0
// below it. Everything that depends on the distance from the eye then has one value in the whole
// picture: `distance_to`, `scale_depth_of`.

const CLASSES = 9u;
// The maximum number of bands of a road.
const BANDS = 16u;
// The number of widths of a pattern along a line: `Dash::WIDTHS`.
const PATTERN_WIDTHS = 16u;

struct Frame {
    clip_from_relative: mat4x4f,
    // xyz: the view's right axis × half width at depth 1, from above at any depth; w: width of the
    // picture in pixels.
    right: vec4f,
    // xyz: the view's up axis × half height, likewise; w: height of the picture in pixels.
    up: vec4f,
    // xyz: the direction of view; w: depth of the near plane.
    forward: vec4f,
    // x: side of a pixel at depth 1, metres; y: world height of one metre of true height; z: half
    // the drawn width per metre of a road's own width, 0 if own widths are ignored; w: width of a
    // lane, 0 if lanes are ignored.
    scale: vec4f,
    // x: distance up to which roads have their true width; z: radius of the outline kernel in
    // pixels of this target; w: how many of these pixels make one pixel of the final picture.
    road_scale: vec4f,
    // x: 1 with caps, 0 without; y: 1 for the paper's test in the fragment shader of volumes; z:
    // world metres per true metre, one value for the whole package; w: maximum width from a road's
    // own tags, true metres.
    road_options: vec4f,
    // x: distance from the eye up to which roads of a part of the network are fully shown, per
    // metre of that part; y: 1 for the paper's level quads of geometry; z: in a view from above,
    // depth of the far plane; w: in a view from above, the distance at which a perspective view has
    // pixels of this size, otherwise 0.
    network: vec4f,
    // x: half width in true metres near the eye; y: minimum half width in pixels of this target; z:
    // number of bands; w: distance from the eye up to which the class is fully shown.
    road_widths: array<vec4f, CLASSES>,
    // x: exponent with which widths grow beyond the distance of true widths; y: distance from the
    // eye up to which the edge of roads is fully drawn.
    road_growth: array<vec4f, CLASSES>,
    // x: half width, as a share of the distance from the eye, at which roads stop growing; y: width
    // of one of two carriageways as a share of the width of its class; z: how much of the ground a
    // road hides; w: number of bands of a slip road.
    road_limits: array<vec4f, CLASSES>,
    // The widths of the bands of each class as shares of the road's width, four in each row.
    road_bands: array<vec4f, BANDS / 4u * CLASSES>,
    // The dashes of each class. xyz: where the first dash, the first gap and the second dash end,
    // as shares of the pattern; w: minimum length of the pattern in pixels of the final picture, 0
    // without gaps.
    dashes: array<vec4f, CLASSES>,
    // The widths of the lines of each class along their pattern, as shares of their width, four in
    // each row; below 0 without a pattern.
    pattern_widths: array<vec4f, PATTERN_WIDTHS / 4u * CLASSES>,
}

@group(0) @binding(0) var<uniform> frame: Frame;

// Whether this is a view from above.
fn is_from_above() -> bool {
    return frame.network.w > 0.0;
}

// Direction through a pixel position, scaled to depth 1.
fn ray_at(pixel: vec2f) -> vec3f {
    if is_from_above() {
        return frame.forward.xyz;
    }
    let at = in_clip_space(pixel);
    return frame.forward.xyz + at.x * frame.right.xyz + at.y * frame.up.xyz;
}

// A pixel position in clip space, from -1 to 1, upwards.
fn in_clip_space(pixel: vec2f) -> vec2f {
    return vec2(2.0 * pixel.x / frame.right.w - 1.0, 1.0 - 2.0 * pixel.y / frame.up.w);
}

// The last pixel of the last row.
fn last_pixel() -> vec2i {
    return vec2i(i32(frame.right.w), i32(frame.up.w)) - 1;
}

// Clip position for drawing without depth test. In a view from above, nothing may be cut off at the
// planes between which all ground is.
fn clip_of(position: vec3f) -> vec4f {
    var clip = frame.clip_from_relative * vec4(position, 1.0);
    if is_from_above() {
        clip.z = 0.5;
    }
    return clip;
}

// Start of the ray through a pixel position: the eye, or in a view from above the level plane
// through the eye.
fn ray_start_at(pixel: vec2f) -> vec3f {
    if !is_from_above() {
        return vec3(0.0);
    }
    let at = in_clip_space(pixel);
    return at.x * frame.right.xyz + at.y * frame.up.xyz;
}

fn view_depth_of(depth_buffer: f32) -> f32 {
    if is_from_above() {
        return frame.network.z - depth_buffer * (frame.network.z - frame.forward.w);
    }
    return frame.forward.w / depth_buffer;
}

// Converts a depth to a value of the depth buffer.
fn depth_buffer_of(view_depth: f32) -> f32 {
    if is_from_above() {
        return (frame.network.z - view_depth) / (frame.network.z - frame.forward.w);
    }
    return frame.forward.w / max(view_depth, frame.forward.w);
}

// The position of the ground at a pixel, relative to the eye.
fn position_at(pixel: vec2f, depth_buffer: f32) -> vec3f {
    return ray_start_at(pixel) + ray_at(pixel) * view_depth_of(depth_buffer);
}

// The distance from the eye that decides how large things look at a position.
fn distance_to(position: vec3f) -> f32 {
    return select(length(position), frame.network.w, is_from_above());
}

// The depth that decides the size of a pixel.
fn scale_depth_of(depth_buffer: f32) -> f32 {
    return select(view_depth_of(depth_buffer), frame.network.w, is_from_above());
}

// How a road is drawn: its class, its look (PLAIN, LINK, TUNNEL, SERVICE, BORE, CARRIAGEWAY, …),
// half its width near the eye, and the length of its part of the network, both world metres.
struct Road {
    class_number: u32,
    look: u32,
    half_width_m: f32,
    part_m: f32,
}

// The length of a part of the network that is not short.
const OPEN_M = 1e15;
const PLAIN = 0u;
const LINK = 1u;
const TUNNEL = 2u;
const SERVICE = 3u;
// A tunnel in a package that stores where tunnels are under the ground.
const BORE = 4u;
// One of the two carriageways of a road, on or above the ground, and in tunnels of both kinds.
const CARRIAGEWAY = 5u;
const CARRIAGEWAY_TUNNEL = 6u;
const CARRIAGEWAY_BORE = 7u;

fn is_bore(look: u32) -> bool {
    return look == BORE || look == CARRIAGEWAY_BORE;
}

fn is_carriageway(look: u32) -> bool {
    return look >= CARRIAGEWAY;
}

fn is_under_ground(look: u32) -> bool {
    return look == TUNNEL || look == CARRIAGEWAY_TUNNEL || is_bore(look);
}

// Bores have half the width of other roads of their class.
const BORE_SHARE = 0.5;
// Width of slip roads and service roads: `RoadStyle::NARROW_WIDTH_SHARE`.
const NARROW_SHARE = 0.6;

// Width of a carriageway as a share of its class's width, if the road is a carriageway, or a slip
// road, which is narrower than a carriageway.
fn carriageway_share(class_number: u32, look: u32) -> f32 {
    return select(1.0, frame.road_limits[class_number].y, is_carriageway(look) || look == LINK);
}

// Width of a road as a share of its class's width.
fn class_share(class_number: u32, look: u32) -> f32 {
    let narrow = select(1.0, NARROW_SHARE, look == LINK || look == SERVICE);
    return narrow * carriageway_share(class_number, look) * select(1.0, BORE_SHARE, is_bore(look));
}

// The same share for widths in pixels; service roads are visible only near the eye, and have the
// widths of their class.
fn px_share(class_number: u32, look: u32) -> f32 {
    return select(class_share(class_number, look), 1.0, look == SERVICE);
}

// `own_width` is metres above 0, lanes below 0, 0 for no own width; `width_factor` is world metres
// across the road per true metre.
fn road_with(class_number: u32, look: u32, own_width: f32, width_factor: f32) -> Road {
    let own_m = select(own_width, -own_width * frame.scale.w, own_width < 0.0);
    var half_width_m = frame.road_widths[class_number].x;
    var share = class_share(class_number, look);
    if own_m > 0.0 && frame.scale.z > 0.0 {
        half_width_m = min(own_m, frame.road_options.w) * frame.scale.z;
        // The tags of a carriageway give its own width.
        share /= carriageway_share(class_number, look);
    }
    return Road(class_number, look, half_width_m * width_factor * share, OPEN_M);
}

// Half width of a road in world metres, before the minimum width in pixels is applied.
fn scaled_half_width_m(road: Road, distance_m: f32) -> f32 {
    let growth = pow(max(distance_m / frame.road_scale.x, 1.0), frame.road_growth[road.class_number].x);
    let limit = frame.road_limits[road.class_number].x * px_share(road.class_number, road.look);
    let limit_m = max(road.half_width_m, limit * distance_m);
    return min(road.half_width_m * growth, limit_m);
}

// Minimum half width in world metres at a depth.
fn least_half_width_m(road: Road, view_depth: f32) -> f32 {
    return frame.road_widths[road.class_number].y * px_share(road.class_number, road.look) * frame.scale.x * view_depth;
}

// A class has faded out at this multiple of the distance up to which it is fully shown: half a zoom
// step.
const FADE_FACTOR = 1.41421356;

// Service roads appear one zoom step later than the rest of their class.
const SERVICE_SHARE = 0.5;

// The distance from the eye up to which a road is fully shown.
fn full_distance_m(class_number: u32, look: u32) -> f32 {
    return frame.road_widths[class_number].w * select(1.0, SERVICE_SHARE, look == SERVICE);
}

// Share that is shown at a distance from the eye of what is fully shown up to another one: it fades
// over half a zoom step, linear in the zoom.
fn share_within(full_m: f32, distance_m: f32) -> f32 {
    return clamp(1.0 - log2(max(distance_m, 1e-3) / full_m) / log2(FADE_FACTOR), 0.0, 1.0);
}

// Share of a road's width that is drawn at a distance from the eye: 1, except for roads in short
// parts of the network.
fn part_share(road: Road, distance_m: f32) -> f32 {
    return share_within(road.part_m * frame.network.x, distance_m);
}

// Whether any part of a road is shown at a distance from the eye. Both methods and the connectors
// of levels use this test.
fn is_shown(road: Road, distance_m: f32) -> bool {
    return distance_m < road.part_m * frame.network.x * FADE_FACTOR
        && distance_m < full_distance_m(road.class_number, road.look) * FADE_FACTOR;
}

// Share of a road's colour that is shown at a distance from the eye.
fn shown_share(class_number: u32, look: u32, distance_m: f32) -> f32 {
    return share_within(full_distance_m(class_number, look), distance_m);
}

// The share of a colour that haze hides at a distance from the eye; at `reach_m` it is two thirds.
fn haze_share(distance_m: f32, reach_m: f32) -> f32 {
    let reach = distance_m / reach_m;
    return 1.0 - exp(-reach * reach);
}

// Share of the edge of a road that is drawn at a distance from the eye: it fades within a zoom
// step, before adjacent parallel roads merge.
fn edge_share(class_number: u32, distance_m: f32) -> f32 {
    return clamp(1.0 - log2(max(distance_m, 1e-3) / frame.road_growth[class_number].y), 0.0, 1.0);
}

// Width of a band as a share of the road's width. Band 0 is the whole road.
fn band_share(class_number: u32, band: u32) -> f32 {
    return frame.road_bands[class_number * (BANDS / 4u) + band / 4u][band % 4u];
}

// Labels below these are labels of tunnels, and of tunnels and service roads (gpu/labels.rs). Roads
// on the ground hide roads below it, and service roads are hidden by every other road on the
// ground.
const SERVICE_LABELS = 20u;
const ROAD_LABELS = 2u * BANDS;

// Side of a pixel of the final picture at a distance from the eye or at a depth, metres.
fn pixel_m_at(distance_m: f32) -> f32 {
    return frame.scale.x * frame.road_scale.w * distance_m;
}
