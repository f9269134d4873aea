// Roads as geometry (GEO): one quad per piece of a road in one triangle of the ground.
//
// Source: Vaaraniemi, Treib & Westermann 2011, High-Quality Cartographic Roads on High-Resolution DEMs, section 4.
// The paper's quad lies level under a segment and the caps around its ends. Ground that bends within the road's width
// is then beside the quad as the eye sees it, most of all at a grazing angle, and the road is too narrow there or breaks
// into dashes (its Fig. 15). Here a quad stands for a *bed*: what lies beside the piece, as far as the road is wide,
// between the lowest and the highest ground there, measured from the plane that the piece lies in.
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
// Which of the pixels behind the quad are road is decided by the ground seen there (coverage.wgsl), with the whole
// segment of which this is a piece. That replaces the paper's depth test with its bias: what is not near the road on
// the ground is not painted, be it in front of the road, behind a ridge or beside the piece.

struct SegmentIn {
    @builtin(vertex_index) corner: u32,
    // The segment that this is a piece of, in plan: start and end.
    @location(0) segment_in_tile: vec4<f32>,
    // xy: which part of it, from 0 to 1; zw: how the plane rises along the piece and to its left.
    @location(1) shares_slopes: vec4<f32>,
    // Height of the piece's start.
    @location(2) height_in_tile: f32,
    // Lowest four bits: class. Then a bit each: cap at the start, at the end; whether ground of other tiles may be
    // within each of the three reaches.
    @location(3) class_and_flags: u32,
    // How far the ground leaves the plane, downwards and upwards. xy: for each metre away, within the first reach;
    // zw: at most within the first reach.
    @location(4) rises_near: vec4<f32>,
    // At most within the second and the third.
    @location(5) farther: vec4<f32>,
}

struct VertexOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) start: vec2<f32>,
    @location(1) @interpolate(flat) start_to_end: vec2<f32>,
    @location(2) @interpolate(flat) road_class: u32,
}

const AT_START = 0x10u;
const AT_END = 0x20u;
const LEAVES_TILE = 0x40u;
// So many times as far away the quad looks the same, and the near plane does not cut it.
const AWAY = 1024.0;

// How far the ground within a radius leaves the plane, downwards and upwards, world metres.
fn leaving_m(in: SegmentIn, radius_m: f32) -> vec2<f32> {
    let near_m = tile.base.w;
    var most = min(in.rises_near.xy * radius_m, in.rises_near.zw);
    var leaves_tile = in.class_and_flags & LEAVES_TILE;
    if radius_m > 4.0 * near_m {
        // Beyond the last reach, on as far as up to it.
        let reach_m = max(tile.base.y, 8.0 * near_m);
        most = in.farther.zw * max(1.0, radius_m / reach_m);
        leaves_tile = in.class_and_flags & (LEAVES_TILE << 2u);
    } else if radius_m > near_m {
        most = in.farther.xy;
        leaves_tile = in.class_and_flags & (LEAVES_TILE << 1u);
    }
    // A neighbour's ground lies higher or lower than this tile's by no more than skirts are deep.
    return most * frame.background.w + select(0.0, tile.offset.w, leaves_tile != 0u);
}

// Where the points of a bed are seen on a plane across the way from the eye, as a rectangle on it.
struct Shown {
    least: vec2<f32>,
    most: vec2<f32>,
    // How far the nearest of them is from the eye along the normal, over how far the plane is.
    nearest: f32,
}

@vertex
fn vertex(in: SegmentIn) -> VertexOut {
    let vertical_scale = frame.background.w;
    let road_class = in.class_and_flags & 15u;
    let start = tile.offset.xy + in.segment_in_tile.xy;
    let start_to_end = in.segment_in_tile.zw - in.segment_in_tile.xy;
    let segment_m = length(start_to_end);
    let direction = select(vec2(1.0, 0.0), start_to_end / segment_m, segment_m > 1e-6);
    let left = vec2(-direction.y, direction.x);
    let slopes = in.shares_slopes.zw * vertical_scale;
    let a = vec3(start + start_to_end * in.shares_slopes.x, tile.offset.z + in.height_in_tile * vertical_scale);
    let length_m = segment_m * (in.shares_slopes.y - in.shares_slopes.x);
    let along = vec3(direction, slopes.x);
    let b = a + along * length_m;

    let far_m = max(length(a), length(b));
    let near_height_m = select(0.0, min(abs(a.z), abs(b.z)), a.z * b.z > 0.0);
    // Rounding of positions must not cut off ground at the rim; the fragment decides anyway.
    let pad_m = 1e-6 * far_m + 0.01;
    let radius_m = bounding_radius_m(road_class, far_m, near_height_m) + pad_m;
    let leaving = leaving_m(in, radius_m) + pad_m * (1.0 + abs(slopes.x) + abs(slopes.y));
    let ends = vec2(
        -select(pad_m, radius_m, (in.class_and_flags & AT_START) != 0u),
        length_m + select(pad_m, radius_m, (in.class_and_flags & AT_END) != 0u),
    );

    // The quad turns about the piece towards the eye; where the eye is in the bed's own direction it stands across the
    // way to its middle instead.
    let middle = a + along * (0.5 * (ends.x + ends.y));
    var u = normalize(along);
    var to_eye = u * dot(middle, u) - middle;
    if dot(to_eye, to_eye) < 1e-6 * dot(middle, middle) {
        to_eye = -middle;
        let aside = select(vec3(0.0, 0.0, 1.0), vec3(1.0, 0.0, 0.0), abs(middle.z) > 0.9 * length(middle));
        u = normalize(cross(to_eye, aside));
    }
    let plane_m = length(to_eye);
    let normal = to_eye / plane_m;
    let v = cross(normal, u);
    var least = vec2(NEVER);
    var most = vec2(-NEVER);
    var nearest = NEVER;
    for (var k = 0u; k < 8u; k++) {
        let along_m = select(ends.x, ends.y, (k & 1u) != 0u);
        let left_m = select(-radius_m, radius_m, (k & 2u) != 0u);
        let up_m = select(-leaving.x, leaving.y, (k & 4u) != 0u);
        let corner = a + along * along_m + vec3(left * left_m, slopes.y * left_m + up_m);
        let away = -dot(corner, normal) / plane_m;
        let seen = vec2(dot(corner, u), dot(corner, v)) / away;
        least = min(least, seen);
        most = max(most, seen);
        nearest = min(nearest, away);
    }
    let side = vec2(f32(in.corner & 1u), f32(in.corner >> 1u));
    let at = mix(least, most, side);
    var position = u * at.x + v * at.y - normal * plane_m;
    // The eye is in the bed, or as good as: it may be anywhere in the picture.
    if nearest < 0.01 {
        let everywhere = 2.0 * side - 1.0;
        position = frame.forward.xyz + 1.01 * (everywhere.x * frame.right.xyz + everywhere.y * frame.up.xyz);
    }

    var out: VertexOut;
    out.clip = frame.clip_from_relative * vec4(position * AWAY, 1.0);
    out.start = start;
    out.start_to_end = start_to_end;
    out.road_class = road_class;
    return out;
}

@fragment
fn fragment(in: VertexOut) -> @location(0) f32 {
    let pixel = vec2<i32>(in.clip.xy);
    let owner = textureLoad(owners, pixel, 0).r;
    // Not the sky and no skirt. Any tile's ground: what lies beside the border is painted from both sides.
    if owner == 0u || (owner & SKIRT) != 0u {
        discard;
    }
    let depth_buffer = textureLoad(terrain_depth, pixel, 0).r;
    let label = label_at(pixel, in.clip.xy, depth_buffer, in.start, in.start_to_end, in.road_class, NEVER);
    if label == NOTHING {
        discard;
    }
    return stored(label);
}
