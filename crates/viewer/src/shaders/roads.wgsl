// Roads as geometry (GEO): one quad per segment around both caps, caps cut in the fragment shader.
//
// Source: Vaaraniemi, Treib & Westermann 2011, High-Quality Cartographic Roads on High-Resolution DEMs,
// section 4. The quad lies in the plane that holds the segment and the horizontal direction across it:
//
//      ┌──────────────────────────────────┐  ─ across = +radius
//      │  ╭─ a ────────────────────── b ─╮│
//      │  ╰──────────────────────────────╯│
//      └──────────────────────────────────┘  ─ across = −radius
//   −radius  0                    length  length + radius     = along
//
// What we changed: the paper cuts the caps by the fragment's own place in the quad and tests its depth against
// the terrain's. Here the terrain's depth is read, the ground seen at the pixel is reconstructed, and its
// distance in plan to the segment decides. One test cuts body and caps, and replaces the depth test with its
// bias: ground within the road's half width is painted though the flat quad dips below it, and nothing is
// painted that hangs over a crest or lies behind a ridge. Where a quad on a cross slope does not cover
// the ground it should, the road is still too narrow, as in the paper's Fig. 15.
//
// A road seen at a grazing angle would break into dashes thinner than a pixel. So ground is also painted whose
// distance to the segment looks smaller than the least half width, measured across the ray of view. That ground
// may be up to MAX_STRETCH least half widths away in plan, not more, so that a crest does not paint the valley.

struct Tile {
    // xyz: the tile's reference point minus the eye.
    offset: vec4<f32>,
    base: vec4<f32>,
}

@group(1) @binding(0) var<uniform> tile: Tile;
@group(2) @binding(0) var terrain_depth: texture_depth_2d;

// 0 draws the road, 1 its centre line.
override BAND: u32 = 0u;
const MAX_STRETCH = 8.0;

struct SegmentIn {
    @builtin(vertex_index) corner: u32,
    @location(0) start_in_tile: vec3<f32>,
    @location(1) end_in_tile: vec3<f32>,
    @location(2) road_class: u32,
}

struct VertexOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) start: vec3<f32>,
    @location(1) @interpolate(flat) start_to_end: vec3<f32>,
    @location(2) @interpolate(flat) road_class: u32,
}

fn half_width_share(road_class: u32) -> f32 {
    return select(1.0, frame.road_widths[road_class].z, BAND == 1u);
}

// How many times wider a level road must be in plan to look as wide as one seen from above.
fn foreshortening(position: vec3<f32>) -> f32 {
    // Slopes that face away from the eye need some more.
    return clamp(1.5 * length(position) / max(abs(position.z), 1e-3), 1.0, MAX_STRETCH);
}

@vertex
fn vertex(in: SegmentIn) -> VertexOut {
    let vertical_scale = frame.background.w;
    let exaggerated = vec3(1.0, 1.0, vertical_scale);
    let a = tile.offset.xyz + in.start_in_tile * exaggerated;
    let ab = (in.end_in_tile - in.start_in_tile) * exaggerated;
    let length_m = length(ab.xy);
    let direction = select(vec2(1.0, 0.0), ab.xy / length_m, length_m > 1e-6);

    // No fragment of the road is farther away than this, hence none is wider.
    let far_m = max(length(a), length(a + ab));
    let stretch = max(foreshortening(a), foreshortening(a + ab));
    let first = max(scaled_half_width_m(in.road_class, far_m), stretch * least_half_width_m(in.road_class, far_m));
    let reach_m = far_m + 2.0 * first;
    let radius_m = half_width_share(in.road_class) * max(
        scaled_half_width_m(in.road_class, reach_m),
        stretch * least_half_width_m(in.road_class, reach_m),
    );

    // Beyond its ends the quad goes on with the segment's slope. The slope of a segment much shorter than the
    // road is wide says nothing about the ground under its caps.
    let slope = ab.z / max(length_m, 0.5 * radius_m);
    let side = f32(in.corner & 1u) * 2.0 - 1.0;
    let at_end = f32(in.corner >> 1u);
    let beyond = (at_end * 2.0 - 1.0) * radius_m;
    let plan = direction * beyond + vec2(-direction.y, direction.x) * side * radius_m;
    let position = a + ab * at_end + vec3(plan, slope * beyond);

    var out: VertexOut;
    out.clip = frame.clip_from_relative * vec4(position, 1.0);
    out.start = a;
    out.start_to_end = ab;
    out.road_class = in.road_class;
    return out;
}

// From the segment's nearest point to a point, both as seen along a unit direction: without their parts along it.
fn from_segment(from_start: vec3<f32>, start_to_end: vec3<f32>, direction: vec3<f32>) -> vec3<f32> {
    let point = from_start - direction * dot(direction, from_start);
    let end = start_to_end - direction * dot(direction, start_to_end);
    let share = clamp(dot(point, end) / max(dot(end, end), 1e-12), 0.0, 1.0);
    return point - share * end;
}

@fragment
fn fragment(in: VertexOut) -> @location(0) u32 {
    let ground = textureLoad(terrain_depth, vec2<i32>(in.clip.xy), 0);
    if ground == 0.0 {
        discard;
    }
    let depth = view_depth_of(ground);
    let position = ray_at(in.clip.xy) * depth;
    let distance_m = length(position);

    let from_start = position - in.start;
    let plan_m = length(from_segment(from_start, in.start_to_end, vec3(0.0, 0.0, 1.0)));

    let band = half_width_share(in.road_class);
    let least_m = band * least_half_width_m(in.road_class, depth);
    let is_wide_enough = plan_m <= band * scaled_half_width_m(in.road_class, distance_m);
    if !is_wide_enough {
        if plan_m > MAX_STRETCH * least_m {
            discard;
        }
        let seen_m = length(from_segment(from_start, in.start_to_end, position / distance_m));
        if seen_m > least_m {
            discard;
        }
    }
    // More important classes have larger labels; the centre line of a class lies above its fill.
    return (CLASSES - in.road_class) * 2u + BAND;
}
