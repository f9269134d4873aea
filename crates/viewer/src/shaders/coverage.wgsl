// Decides whether the ground at a pixel is road. The rule is the same for both methods; quads (GEO)
// and boxes (SV) only select the pixels for which it is applied.
//
// The terrain's depth is read, and from it the position of the ground at the pixel's centre is
// computed. The ground is road if its distance in plan to the segment is at most half the road's
// width. For an upright volume this is the same as the test of Vaaraniemi, Treib & Westermann 2011,
// High-Quality Cartographic Roads on High-Resolution DEMs, section 5.1: whether the ground lies
// between the points where the ray from the eye enters and leaves the volume. But they compute
// these points as roots of a quadratic, which is imprecise for a narrow road far from the eye: at
// about 7 km a tenth of all pixels near caps are wrong. The distance in plan is precise there.
//
// At a grazing angle a road would be thinner than a pixel and break into dashes. So there is a
// second rule: ground is also road if on the picture the pixel's centre is closer to the segment
// than the minimum half width in pixels. The position of the segment on the picture is computed
// from the ground at this pixel and at its neighbours towards the segment. In plan this ground may
// be at most `stretch` times the minimum half width away. Otherwise a road on a crest would be
// painted on the valley behind it.

// The output of a road's vertex stage for its fragment stage, for both methods.
struct RoadFragment {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) start: vec2f,
    @location(1) @interpolate(flat) start_to_end: vec2f,
    // Lowest four bits: class; three bits: look; one bit each if the segment ends flat at its start
    // and at its end. Above, for a connector, the number of its other tile, otherwise 0.
    @location(2) @interpolate(flat) class_and_other: u32,
    // Half the road's width near the eye, world metres.
    @location(3) @interpolate(flat) half_width_m: f32,
    // Dash positions. x: the distance of the segment's start along the line, world metres; y: such
    // metres along the line per metre in plan, more than 1 uphill.
    @location(4) @interpolate(flat) dash: vec2f,
    // Length of the part of the network to which the road belongs, world metres.
    @location(5) @interpolate(flat) part_m: f32,
}

fn road_of(in: RoadFragment) -> Road {
    return Road(in.class_and_other & 15u, (in.class_and_other >> 4u) & 7u, in.half_width_m, in.part_m);
}

// A segment of a road in plan, relative to the eye, or on the picture.
struct Segment {
    start: vec2f,
    start_to_end: vec2f,
    // Whether it ends flat at its start and at its end, because the road continues there as another
    // one.
    flat_start: bool,
    flat_end: bool,
}

fn segment_of(in: RoadFragment) -> Segment {
    return Segment(in.start, in.start_to_end, (in.class_and_other & 128u) != 0u, (in.class_and_other & 256u) != 0u);
}

// The direction of a segment of some length; any direction if it has no length.
fn direction_of(start_to_end: vec2f, length_m: f32) -> vec2f {
    return select(vec2(1.0, 0.0), start_to_end / length_m, length_m > 1e-6);
}

const MAX_STRETCH = 8.0;
const NEVER = 1e30;
const NOTHING = 0u;

// How many times wider a level road must be in plan to look as wide as one seen from above.
fn stretch_of(distance_m: f32, height_m: f32) -> f32 {
    // The factor 1.5 is for slopes that face away from the eye.
    if is_from_above() {
        return 1.5;
    }
    return clamp(1.5 * distance_m / max(abs(height_m), 1e-3), 1.0, MAX_STRETCH);
}

// Number of bands of a road. Slip roads lack the narrow ones; tunnels and service roads have one
// colour.
fn band_count(road: Road) -> u32 {
    if is_under_ground(road.look) || road.look == SERVICE {
        return 1u;
    }
    return u32(select(frame.road_widths[road.class_number].z, frame.road_limits[road.class_number].w, road.look == LINK));
}

fn has_caps() -> bool {
    return frame.road_options.x > 0.5;
}

// Vector from the nearest point of a segment. Beyond a flat end, and beyond any end of a road
// without caps, its length is `NEVER`.
fn from_segment(at: vec2f, segment: Segment) -> vec2f {
    let from_start = at - segment.start;
    let length_squared = dot(segment.start_to_end, segment.start_to_end);
    let along = dot(from_start, segment.start_to_end) / max(length_squared, 1e-12);
    let share = clamp(along, 0.0, 1.0);
    let is_beyond = (along < 0.0 && segment.flat_start) || (along > 1.0 && segment.flat_end);
    if is_beyond || (!has_caps() && (share != along || length_squared == 0.0)) {
        return vec2(NEVER, 0.0);
    }
    return from_start - share * segment.start_to_end;
}

// The pixel at an offset of `step` from another, and the ground that it shows.
struct Neighbour {
    depth_buffer: f32,
    // Position in plan, relative to the eye.
    position: vec2f,
    to_segment_m: f32,
}

fn neighbour(pixel: vec2i, step: vec2i, segment: Segment) -> Neighbour {
    let last = last_pixel();
    let at = pixel + step;
    var out: Neighbour;
    if any(at < vec2(0)) || any(at > last) {
        return out;
    }
    out.depth_buffer = textureLoad(terrain_depth, at, 0).r;
    if out.depth_buffer > 0.0 {
        out.position = position_at(vec2f(at) + 0.5, out.depth_buffer).xy;
        out.to_segment_m = length(from_segment(out.position, segment));
    }
    return out;
}

// The change of the ground's position in plan from this pixel to the next one, on the side where
// the segment is closer. If that side has no ground or a silhouette, the other side is used: within
// one triangle the depth buffer is linear, so both sides have the same change.
fn plan_step(pixel: vec2i, step: vec2i, depth_buffer: f32, position: vec2f, segment: Segment) -> vec2f {
    let ahead = neighbour(pixel, step, segment);
    let behind = neighbour(pixel, -step, segment);
    let change_ahead = abs(ahead.depth_buffer - depth_buffer);
    let change_behind = abs(behind.depth_buffer - depth_buffer);
    var is_ahead = ahead.to_segment_m <= behind.to_segment_m;
    if behind.depth_buffer == 0.0 || change_behind > 4.0 * change_ahead + 1e-4 * depth_buffer {
        is_ahead = true;
    } else if ahead.depth_buffer == 0.0 || change_ahead > 4.0 * change_behind + 1e-4 * depth_buffer {
        is_ahead = false;
    }
    if is_ahead {
        return select(ahead.position - position, vec2(0.0), ahead.depth_buffer == 0.0);
    }
    return position - behind.position;
}

// Maps plan to pixels, where `right` and `down` map pixels to plan and span this area.
fn px_from_plan(right: vec2f, down: vec2f, area: f32) -> mat2x2f {
    return mat2x2(vec2(down.y, -right.y) / area, vec2(-down.x, right.x) / area);
}

// Distance in pixels from the centre of this pixel to the image of a segment. `right` and `down`
// map pixels to plan; their inverse maps the segment to pixels. (Its nearest point on the picture
// is not its nearest in plan.)
fn seen_px(right: vec2f, down: vec2f, at: vec2f, segment: Segment) -> f32 {
    let area = right.x * down.y - right.y * down.x;
    if area == 0.0 {
        return NEVER;
    }
    let px_from_m = px_from_plan(right, down, area);
    let seen = Segment(px_from_m * (segment.start - at), px_from_m * segment.start_to_end, segment.flat_start, segment.flat_end);
    return length(from_segment(vec2(0.0), seen));
}

// A tick across the road at the portals of a tunnel: half its length as a share of half the width
// of the tunnel, and its thickness.
const TICK_REACH = 3.4;
const TICK_BREADTH = 0.4;
// On narrower roads the tick would be a blot.
const LEAST_TICK_PX = 1.2;

// Whether the ground at a position is on the tick of a tunnel. The segments of a tunnel end flat
// only at portals.
fn is_tick(segment: Segment, road: Road, position: vec3f, distance_m: f32) -> bool {
    let half_m = scaled_half_width_m(road, distance_m);
    let length_m = length(segment.start_to_end);
    let pixel_m = pixel_m_at(distance_m);
    if half_m < LEAST_TICK_PX * pixel_m || length_m < 1e-6 {
        return false;
    }
    let direction = segment.start_to_end / length_m;
    let from_start = position.xy - segment.start;
    let along = dot(from_start, direction);
    let across = abs(dot(from_start, vec2(-direction.y, direction.x)));
    let breadth_m = max(TICK_BREADTH * half_m, pixel_m);
    let at_start = segment.flat_start && along >= 0.0 && along <= breadth_m;
    let at_end = segment.flat_end && along <= length_m && along >= length_m - breadth_m;
    return (at_start || at_end) && across <= TICK_REACH * half_m;
}

// The label that a segment gives the ground at a pixel: 0 if that ground is not on the road.
fn label_at(in: RoadFragment, depth_buffer: f32) -> u32 {
    let pixel = vec2i(in.clip.xy);
    let segment = segment_of(in);
    let road = road_of(in);
    let position = position_at(in.clip.xy, depth_buffer);
    let distance_m = distance_to(position);
    let narrowed = width_share(in, pixel, depth_buffer, position);
    if !is_shown(road, distance_m) || narrowed == 0.0 {
        return NOTHING;
    }
    let plan_m = length(from_segment(position.xy, segment));
    if plan_m > tile.base.y {
        return NOTHING;
    }
    if is_bore(road.look) && is_tick(segment, road, position, distance_m) {
        return band_label(road, 1u);
    }
    // Each band is treated as a road of its own whose widths are all smaller. So a pixel in one
    // band is also in all previous bands.
    let bands = band_count(road);
    let part = narrowed * part_share(road, distance_m);
    let half_m = part * scaled_half_width_m(road, distance_m);
    let looks_m = part * stretch_of(distance_m, position.z)
        * least_half_width_m(road, scale_depth_of(depth_buffer));
    // The number of bands that are known to cover the pixel.
    var within = 0u;
    while within < bands && plan_m <= band_share(road.class_number, within) * half_m {
        within++;
    }
    if within == bands || plan_m > band_share(road.class_number, within) * looks_m {
        return band_label(road, within);
    }
    let right = plan_step(pixel, vec2(1, 0), depth_buffer, position.xy, segment);
    let down = plan_step(pixel, vec2(0, 1), depth_buffer, position.xy, segment);
    let seen = seen_px(right, down, position.xy, segment);
    let least_px = part * frame.road_widths[road.class_number].y * px_share(road.class_number, road.look);
    while within < bands {
        let share = band_share(road.class_number, within);
        if plan_m > share * looks_m || seen > share * least_px {
            break;
        }
        within++;
    }
    return band_label(road, within);
}

// An upper bound of the half width of a road whose points are at most `far_m` away, and not closer
// to the eye's height than `near_height_m`.
fn bounding_radius_m(road: Road, far_m: f32, near_height_m: f32) -> f32 {
    let first = max(scaled_half_width_m(road, far_m), MAX_STRETCH * least_half_width_m(road, far_m));
    let reach_m = far_m + 2.0 * first;
    let stretch = stretch_of(reach_m, near_height_m);
    let half_m = max(scaled_half_width_m(road, reach_m), stretch * least_half_width_m(road, reach_m));
    return half_m * select(1.0, TICK_REACH, is_bore(road.look));
}

// The label of the innermost of `within` bands of a road. More important classes have larger
// labels, and each band of a class has a larger label than the band below it.
fn band_label(road: Road, within: u32) -> u32 {
    if within == 0u {
        return NOTHING;
    }
    if road.look == SERVICE {
        return SERVICE_LABELS + CLASSES - road.class_number;
    }
    return (CLASSES + 1u - road.class_number) * BANDS + within - 1u;
}

// Minimum number of pixels of a tunnel's dash and the gap after it together. The actual number is
// less than twice as large.
const TUNNEL_DASH_PX = 12.0;

// A position on a line relative to its pattern.
struct InPattern {
    // Position within the pattern, 0 to 1.
    share: f32,
    // Length of the pattern on the picture relative to its minimum length: 1 to 2.
    stretch: f32,
}

// `from_start_m` is the distance of the position from the segment's start, in plan along the
// segment.
fn in_pattern(in: RoadFragment, position: vec3f, from_start_m: f32, least_px: f32) -> InPattern {
    let along_m = in.dash.x + in.dash.y * from_start_m;
    let least_m = least_px * pixel_m_at(distance_to(position));
    // Lengths are counted modulo 2^16 metres (tiles/roads/dashes.rs).
    let pattern_m = min(exp2(ceil(log2(least_m))), 65536.0);
    return InPattern(fract(along_m / pattern_m), pattern_m / least_m);
}

fn dash_share(in: RoadFragment, position: vec3f, least_px: f32) -> f32 {
    let segment_m = max(length(in.start_to_end), 1e-6);
    let from_start_m = dot(position.xy - in.start, in.start_to_end) / segment_m;
    return in_pattern(in, position, from_start_m, least_px).share;
}

fn pattern_width(class_number: u32, place: u32) -> f32 {
    return frame.pattern_widths[class_number * (PATTERN_WIDTHS / 4u) + place / 4u][place % 4u];
}

// The distance along a segment in plan from its start to the point that is closest to the centre of
// a pixel on the picture. The closest point in plan is another one: with it, shapes across the line
// would be sheared on the picture.
fn seen_from_start_m(pixel: vec2i, depth_buffer: f32, position: vec2f, segment: Segment) -> f32 {
    let right = plan_step(pixel, vec2(1, 0), depth_buffer, position, segment);
    let down = plan_step(pixel, vec2(0, 1), depth_buffer, position, segment);
    let area = right.x * down.y - right.y * down.x;
    let segment_m = length(segment.start_to_end);
    if area == 0.0 || segment_m < 1e-6 {
        return dot(position - segment.start, segment.start_to_end) / max(segment_m, 1e-6);
    }
    let px_from_m = px_from_plan(right, down, area);
    let from_start = px_from_m * (position - segment.start);
    let along = px_from_m * segment.start_to_end;
    return segment_m * dot(from_start, along) / max(dot(along, along), 1e-12);
}

// The width of a line at a position, as a share of its full width. The shapes of a pattern keep
// their length where the pattern gets longer.
fn width_share(in: RoadFragment, pixel: vec2i, depth_buffer: f32, position: vec3f) -> f32 {
    let class_number = in.class_and_other & 15u;
    if pattern_width(class_number, 0u) < 0.0 {
        return 1.0;
    }
    let from_start_m = seen_from_start_m(pixel, depth_buffer, position.xy, segment_of(in));
    let found = in_pattern(in, position, from_start_m, frame.dashes[class_number].w);
    let last = f32(PATTERN_WIDTHS - 1u);
    let at = clamp(found.share * found.stretch * f32(PATTERN_WIDTHS) - 0.5, 0.0, last);
    let before = u32(at);
    let after = min(before + 1u, PATTERN_WIDTHS - 1u);
    return mix(pattern_width(class_number, before), pattern_width(class_number, after), fract(at));
}

// The label of a line at a position: none in a gap. The label of a tunnel is odd on a dash.
fn label_on(label: u32, in: RoadFragment, position: vec3f) -> u32 {
    let road = road_of(in);
    if label == NOTHING {
        return NOTHING;
    }
    if is_under_ground(road.look) {
        let is_dash = dash_share(in, position, TUNNEL_DASH_PX) < 0.5
            || (is_bore(road.look) && is_tick(segment_of(in), road, position, distance_to(position)));
        return (CLASSES - road.class_number) * 2u + select(0u, 1u, is_dash);
    }
    let dashes = frame.dashes[road.class_number];
    if dashes.w == 0.0 {
        return label;
    }
    let share = dash_share(in, position, dashes.w);
    let is_dash = share < dashes.x || (share >= dashes.y && share < dashes.z);
    return select(NOTHING, label, is_dash);
}

// What is stored for a label of a road at a pixel, with its dashes; nothing without a label.
fn painted(label: u32, in: RoadFragment, depth_buffer: f32) -> f32 {
    if label == NOTHING {
        discard;
    }
    return stored(label_on(label, in, position_at(in.clip.xy, depth_buffer)));
}

// A label as it is stored in the target; blending keeps the largest.
fn stored(label: u32) -> f32 {
    return f32(label) / 255.0;
}
