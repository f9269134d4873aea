// Roads as geometry (GEO): one quad for each piece of a road in one triangle of the ground.
//
// Source: Vaaraniemi, Treib & Westermann 2011, High-Quality Cartographic Roads on High-Resolution
// DEMs, section 4. The paper's quad is level and covers a segment and the caps at its ends. If the
// ground is not flat across the road's width, then on the picture a part of that ground is outside
// the quad, especially at a grazing angle. There the road is drawn too narrow or breaks into dashes
// (Fig. 15 of the paper). Here a quad represents a *bed*: a box around the piece. The box is as
// wide as the road, and it extends from the lowest to the highest ground next to the piece,
// measured from the plane of the piece.
//
//       from the side               from above                            as the eye sees it
//                                    ┌───┬─────┬───────────┐                ┌──────────────┐
//     ─ ─ ─ ─ ─ ─ ─ above          ╭─┤   │     │           ├─╮              │  ╱‾‾‾‾‾‾‾╲   │   the quad turns about
//       ╱‾╲__ ground               │ a───x─────x───────────b │              │ ╱ the bed ╲  │   the piece towards the
//     ─ ─ ─ ─ ─ ─ ─ plane          ╰─┤   │     │           ├─╯              │ ╲_________╱  │   eye and hides the bed
//     ─ ─ ─ ─ ─ ─ ─ below            └───┴─────┴───────────┘                └──────────────┘
//                                  caps where the road does not
//                                  go straight on, at a and b
//
// The quad only selects pixels. Whether a pixel is road depends on the distance of its ground from
// the whole segment to which the piece belongs (coverage.wgsl). This replaces the paper's depth
// test with its bias: ground that is not near the road is not painted, whether it is in front of
// the road, behind a ridge or next to the piece.

struct SegmentIn {
    @builtin(vertex_index) corner: u32,
    // The segment to which the piece belongs, in plan: start and end.
    @location(0) segment_in_tile: vec4f,
    // xy: the range of the piece in the segment, from 0 to 1; zw: how the plane rises along the
    // piece and to its left.
    @location(1) shares_slopes: vec4f,
    // Height of the piece's start; world metres across the road per true metre.
    @location(2) height_width_factor: vec2f,
    // Lowest four bits: class. Then three bits for the look, and two if the segment ends flat at
    // its start and at its end. Then one bit for a cap at the start, one for a cap at the end, and
    // one for each of the three reaches, if ground of other tiles may be within it.
    @location(3) class_and_flags: u32,
    // Maximum distance of the ground below and above the plane. xy: per metre of distance, within
    // the first reach; zw: anywhere within the first reach.
    @location(4) rises_near: vec4f,
    // Maximum distance anywhere within the second reach (xy) and within the third (zw).
    @location(5) farther: vec4f,
    // The road's own width, as `road_with` takes it.
    @location(6) own_width: f32,
    // Same as in RoadFragment.
    @location(7) dash: vec2f,
    // Same as in RoadFragment.
    @location(8) part_m: f32,
}

const AT_START = 0x200u;
const AT_END = 0x400u;
const LEAVES_TILE = 0x800u;
// The quad is drawn this many times farther away and larger: it looks the same, and the near plane
// does not clip it.
const AWAY = 1024.0;
// A quad can represent a bed only if no point of the bed is nearer than this share of the distance
// to the quad's plane.
const LEAST_NEAREST = 0.05;

// Maximum distance of the ground within a radius below and above the plane, world metres.
fn leaving_m(in: SegmentIn, radius_m: f32) -> vec2f {
    let near_m = tile.base.w;
    var most = min(in.rises_near.xy * radius_m, in.rises_near.zw);
    var leaves_tile = in.class_and_flags & LEAVES_TILE;
    if radius_m > 4.0 * near_m {
        most = in.farther.zw;
        leaves_tile = in.class_and_flags & (LEAVES_TILE << 2u);
    } else if radius_m > near_m {
        most = in.farther.xy;
        leaves_tile = in.class_and_flags & (LEAVES_TILE << 1u);
    }
    // A neighbour's ground is higher or lower than this tile's by at most the depth of the skirts.
    return most * frame.scale.y + select(0.0, tile.offset.w, leaves_tile != 0u);
}

// A bed: its points are start + along · x + across · y + up · z, with x, y and z within these
// ranges.
struct RoadBed {
    start: vec3f,
    along: vec3f,
    across: vec3f,
    x: vec2f,
    y: vec2f,
    z: vec2f,
}

// A plane in front of the eye, at the distance `plane_m` along `normal`, and the rectangle on it,
// along `u` and `v`, that covers a bed on the picture.
struct Shown {
    u: vec3f,
    v: vec3f,
    normal: vec3f,
    plane_m: f32,
    least: vec2f,
    most: vec2f,
    // Distance of the bed's nearest point along the normal, divided by the distance of the plane.
    nearest: f32,
}

// Uses the plane through the bed's axis that faces the eye. On this plane the quad that hides the
// bed is smallest.
fn shown_about_axis(bed: RoadBed) -> Shown {
    var out: Shown;
    let along_m = length(bed.along);
    out.u = bed.along / along_m;
    let to_axis = bed.start - out.u * dot(bed.start, out.u);
    out.plane_m = length(to_axis);
    out.normal = to_axis / max(out.plane_m, 1e-9);
    out.v = cross(out.normal, out.u);
    // Neither the normal nor v has a part along the axis.
    let start_u = dot(bed.start, out.u);
    let across = vec3(dot(bed.across, out.u), dot(bed.across, out.v), dot(bed.across, out.normal));
    let up = vec3(out.u.z, out.v.z, out.normal.z);
    let ends = start_u + bed.x * along_m;
    // The four edges along the axis.
    let y = vec4(bed.y.x, bed.y.y, bed.y.x, bed.y.y);
    let z = vec4(bed.z.xx, bed.z.yy);
    let away = (out.plane_m + across.z * y + up.z * z) / max(out.plane_m, 1e-9);
    let seen_v = (across.y * y + up.y * z) / away;
    let aside = across.x * y + up.x * z;
    let first = (ends.x + aside) / away;
    let last = (ends.y + aside) / away;
    out.least = vec2(least_of(min(first, last)), least_of(seen_v));
    out.most = vec2(-least_of(-max(first, last)), -least_of(-seen_v));
    out.nearest = least_of(away);
    return out;
}

// Uses the plane through the middle of the bed, for an eye on or near the bed's axis.
fn shown_from_its_end(bed: RoadBed) -> Shown {
    var out: Shown;
    let middle = bed.start + bed.along * (0.5 * (bed.x.x + bed.x.y));
    out.plane_m = length(middle);
    out.normal = middle / max(out.plane_m, 1e-9);
    let aside = select(vec3(0.0, 0.0, 1.0), vec3(1.0, 0.0, 0.0), abs(out.normal.z) > 0.9);
    out.u = normalize(cross(out.normal, aside));
    out.v = cross(out.normal, out.u);
    out.least = vec2(NEVER);
    out.most = vec2(-NEVER);
    out.nearest = NEVER;
    for (var k = 0u; k < 8u; k++) {
        let x = select(bed.x.x, bed.x.y, (k & 1u) != 0u);
        let y = select(bed.y.x, bed.y.y, (k & 2u) != 0u);
        let z = select(bed.z.x, bed.z.y, (k & 4u) != 0u);
        let corner = bed.start + bed.along * x + bed.across * y + vec3(0.0, 0.0, z);
        let away = dot(corner, out.normal) / max(out.plane_m, 1e-9);
        let seen = vec2(dot(corner, out.u), dot(corner, out.v)) / away;
        out.least = min(out.least, seen);
        out.most = max(out.most, seen);
        out.nearest = min(out.nearest, away);
    }
    return out;
}

// In a view from above the quad that covers a bed is the bed's plan.
fn shown_from_above(bed: RoadBed) -> Shown {
    var out: Shown;
    out.u = vec3(bed.along.xy, 0.0);
    // Equal to the cross product of the normal and u.
    out.v = vec3(-bed.across.xy, 0.0);
    out.normal = frame.forward.xyz;
    let start = vec2(dot(bed.start.xy, out.u.xy), dot(bed.start.xy, out.v.xy));
    out.least = start + vec2(bed.x.x, -bed.y.y);
    out.most = start + vec2(bed.x.y, -bed.y.x);
    out.nearest = 1.0;
    return out;
}

fn least_of(values: vec4f) -> f32 {
    return min(min(values.x, values.y), min(values.z, values.w));
}

@vertex
fn vertex(in: SegmentIn) -> RoadFragment {
    let vertical_scale = frame.scale.y;
    let look = (in.class_and_flags >> 4u) & 7u;
    let road = road_with(in.class_and_flags & 15u, look, in.own_width, in.height_width_factor.y);
    let start = tile.offset.xy + in.segment_in_tile.xy;
    let start_to_end = in.segment_in_tile.zw - in.segment_in_tile.xy;
    let segment_m = length(start_to_end);
    let direction = direction_of(start_to_end, segment_m);
    let left = vec2(-direction.y, direction.x);
    let slopes = in.shares_slopes.zw * vertical_scale;
    let a = vec3(start + start_to_end * in.shares_slopes.x, tile.offset.z + in.height_width_factor.x * vertical_scale);
    let length_m = segment_m * (in.shares_slopes.y - in.shares_slopes.x);
    let along = vec3(direction, slopes.x);
    let b = a + along * length_m;

    let far_m = max(distance_to(a), distance_to(b));
    // The quad is enlarged a little, so that rounding of positions does not cut off ground at the
    // edge. The fragment shader decides for each pixel.
    let pad_m = 1e-6 * max(length(a), length(b)) + 0.01;
    // At most as wide as the tile's margin, as for volumes: neighbouring tiles have no roads from
    // farther away.
    let widest_m = min(bounding_radius_m(road, far_m, 0.0), tile.base.y) + pad_m;
    // The fragment shader uses the ground at its pixel, which may be closer to the eye's height
    // than the piece, or farther.
    let tilted_m = widest_m * length(slopes);
    let beside_m = leaving_m(in, widest_m) + tilted_m;
    let heights = vec2(min(a.z, b.z) - beside_m.x, max(a.z, b.z) + beside_m.y);
    let near_height_m = select(0.0, min(abs(heights.x), abs(heights.y)), heights.x * heights.y > 0.0);
    let ground_far_m = far_m + max(beside_m.x, beside_m.y);
    let radius_m = min(bounding_radius_m(road, ground_far_m, near_height_m), tile.base.y) + pad_m;
    let leaving = leaving_m(in, radius_m) + pad_m * (1.0 + abs(slopes.x) + abs(slopes.y));
    let ends = vec2(
        -select(pad_m, radius_m, (in.class_and_flags & AT_START) != 0u),
        length_m + select(pad_m, radius_m, (in.class_and_flags & AT_END) != 0u),
    );

    let bed = RoadBed(a, along, vec3(left, slopes.y), ends, vec2(-radius_m, radius_m), vec2(-leaving.x, leaving.y));
    var shown: Shown;
    if is_from_above() {
        shown = shown_from_above(bed);
    } else {
        shown = shown_about_axis(bed);
        if shown.nearest < LEAST_NEAREST {
            shown = shown_from_its_end(bed);
        }
    }
    let side = vec2(f32(in.corner & 1u), f32(in.corner >> 1u));
    let at = mix(shown.least, shown.most, side);
    var position = shown.u * at.x + shown.v * at.y + shown.normal * shown.plane_m;
    // The eye is within the bed or very close to it, so the bed may be anywhere on the picture. The
    // quad covers all of it.
    if shown.nearest < LEAST_NEAREST {
        let everywhere = 1.01 * (2.0 * side - 1.0);
        position = frame.forward.xyz + everywhere.x * frame.right.xyz + everywhere.y * frame.up.xyz;
    }
    // The paper's quad: as high as the piece, all across the road.
    if frame.network.y > 0.5 {
        let across = mix(bed.y.x, bed.y.y, side.y);
        position = bed.start + bed.along * mix(bed.x.x, bed.x.y, side.x) + vec3(left * across, 0.0);
    }

    let clip = clip_of(select(position * AWAY, position, is_from_above()));
    // Class, look and flat ends.
    let class_and_ends = in.class_and_flags & 511u;
    return RoadFragment(clip, start, start_to_end, class_and_ends, road.half_width_m, in.dash, in.part_m);
}

@fragment
fn fragment(in: RoadFragment) -> @location(0) f32 {
    let pixel = vec2i(in.clip.xy);
    let owner = textureLoad(owners, pixel, 0).r;
    // Sky and skirts are not painted. The ground of any tile is painted: near a border each of the
    // two tiles paints on both sides.
    if owner == 0u || (owner & SKIRT) != 0u {
        discard;
    }
    let depth_buffer = textureLoad(terrain_depth, pixel, 0).r;
    return painted(label_at(in, depth_buffer), in, depth_buffer);
}
