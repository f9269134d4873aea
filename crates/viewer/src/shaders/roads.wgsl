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
// along and across are metres in plan, so a cap is round on the map. What we changed: the distance to the
// segment decides (one test for body and caps), and instead of a depth test with a bias the terrain's depth is
// read. A fragment is kept if it lies in front of the ground, or if the ground that hides it belongs to the
// road itself: its plan position is within the road's half width. Then the ground never shows through where
// the flat quad dips below it, and nothing shows from behind a ridge, at any slope and any distance.

struct Tile {
    // xyz: the tile's reference point minus the eye.
    offset: vec4<f32>,
    base: vec4<f32>,
}

@group(1) @binding(0) var<uniform> tile: Tile;
@group(2) @binding(0) var terrain_depth: texture_depth_2d;

// 0 draws the road, 1 its centre line.
override BAND: u32 = 0u;
// Depths that differ by less than this share are one surface.
const SAME_DEPTH = 1e-5;

struct SegmentIn {
    @builtin(vertex_index) corner: u32,
    @location(0) start_in_tile: vec3<f32>,
    @location(1) end_in_tile: vec3<f32>,
    @location(2) road_class: u32,
}

struct VertexOut {
    @builtin(position) clip: vec4<f32>,
    // Metres in plan: along the segment from its start, and across.
    @location(0) along_across: vec2<f32>,
    @location(1) @interpolate(flat) start: vec3<f32>,
    // xy: unit direction in plan; z: length in plan.
    @location(2) @interpolate(flat) direction_length: vec3<f32>,
    @location(3) @interpolate(flat) road_class: u32,
}

fn half_width_share(road_class: u32) -> f32 {
    return select(1.0, frame.road_widths[road_class].z, BAND == 1u);
}

fn half_width_m(road_class: u32, distance_m: f32, view_depth: f32) -> f32 {
    let whole = max(scaled_half_width_m(road_class, distance_m), least_half_width_m(road_class, view_depth));
    return whole * half_width_share(road_class);
}

@vertex
fn vertex(in: SegmentIn) -> VertexOut {
    let vertical_scale = frame.background.w;
    let stretch = vec3(1.0, 1.0, vertical_scale);
    let a = tile.offset.xyz + in.start_in_tile * stretch;
    let ab = (in.end_in_tile - in.start_in_tile) * stretch;
    let length_m = length(ab.xy);
    let direction = select(vec2(1.0, 0.0), ab.xy / length_m, length_m > 1e-6);

    // No fragment of the road is farther away than this, hence none is wider.
    let far_m = max(length(a), length(a + ab));
    let first = half_width_m(in.road_class, far_m, far_m);
    let reach_m = far_m + 2.0 * first;
    let radius_m = half_width_m(in.road_class, reach_m, reach_m);

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
    out.along_across = vec2(length_m * at_end + beyond, side * radius_m);
    out.start = a;
    out.direction_length = vec3(direction, length_m);
    out.road_class = in.road_class;
    return out;
}

// Distance in plan to the segment, from (along, across).
fn distance_to_segment(along_across: vec2<f32>, length_m: f32) -> f32 {
    let past_end = max(max(-along_across.x, along_across.x - length_m), 0.0);
    return length(vec2(past_end, along_across.y));
}

@fragment
fn fragment(in: VertexOut) -> @location(0) u32 {
    let ray = ray_at(in.clip.xy);
    let depth = view_depth_of(in.clip.z);
    let radius_m = half_width_m(in.road_class, depth * length(ray), depth);
    if distance_to_segment(in.along_across, in.direction_length.z) > radius_m {
        discard;
    }
    let ground = textureLoad(terrain_depth, vec2<i32>(in.clip.xy), 0);
    if ground == 0.0 {
        // No ground, no road: caps do not stick out over the silhouette.
        discard;
    }
    if in.clip.z < ground * (1.0 - SAME_DEPTH) {
        let ground_depth = view_depth_of(ground);
        let from_start = (ray * ground_depth - in.start).xy;
        let direction = in.direction_length.xy;
        let along = dot(from_start, direction);
        let across = dot(from_start, vec2(-direction.y, direction.x));
        let ground_radius_m = half_width_m(in.road_class, ground_depth * length(ray), ground_depth);
        if distance_to_segment(vec2(along, across), in.direction_length.z) > ground_radius_m {
            discard;
        }
    }
    // More important classes have larger labels; the centre line of a class lies above its fill.
    return (CLASSES - in.road_class) * 2u + BAND;
}
