// Roads as geometry (GEO): one quad per segment around both caps, caps cut in the fragment shader.
//
// Source: Vaaraniemi, Treib & Westermann 2011, High-Quality Cartographic Roads on High-Resolution DEMs,
// section 4. The quad lies in the plane of the triangle beneath the segment:
//
//      ┌──────────────────────────────────┐  ─ across = +radius
//      │  ╭─ a ────────────────────── b ─╮│
//      │  ╰──────────────────────────────╯│
//      └──────────────────────────────────┘  ─ across = −radius
//   −radius  0                    length  length + radius     = along
//
// What we changed: the paper's quad is level across the road, so that on a cross slope the road is too narrow (its
// Fig. 15). Ours has the slope of the ground and is wrong only where that changes within the road's width: there it
// is still too narrow. The paper cuts the caps by the fragment's own place in the quad and tests its depth against
// the terrain's. Here the ground seen at the pixel decides (coverage.wgsl). One test cuts body and caps, and
// replaces the depth test with its bias: ground within the road's half width is painted though the quad dips below
// it, and nothing is painted that hangs over a crest or lies behind a ridge.

struct SegmentIn {
    @builtin(vertex_index) corner: u32,
    @location(0) start_in_tile: vec3<f32>,
    @location(1) end_in_tile: vec3<f32>,
    // Metres that the ground rises per metre to the left.
    @location(2) cross_slope: f32,
    @location(3) road_class: u32,
}

struct VertexOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) start: vec2<f32>,
    @location(1) @interpolate(flat) start_to_end: vec2<f32>,
    @location(2) @interpolate(flat) road_class: u32,
}

@vertex
fn vertex(in: SegmentIn) -> VertexOut {
    let exaggerated = vec3(1.0, 1.0, frame.background.w);
    let a = tile.offset.xyz + in.start_in_tile * exaggerated;
    let ab = (in.end_in_tile - in.start_in_tile) * exaggerated;
    let length_m = length(ab.xy);
    let direction = select(vec2(1.0, 0.0), ab.xy / length_m, length_m > 1e-6);
    let far_m = max(length(a), length(a + ab));
    let radius_m = bounding_radius_m(in.road_class, far_m, min(abs(a.z), abs(a.z + ab.z)));

    // Beyond its ends the quad goes on with the segment's slope. The slope of a segment much shorter than the
    // road is wide says nothing about the ground under its caps.
    let slope = ab.z / max(length_m, 0.5 * radius_m);
    let side = f32(in.corner & 1u) * 2.0 - 1.0;
    let at_end = f32(in.corner >> 1u);
    let beyond = (at_end * 2.0 - 1.0) * radius_m;
    let plan = direction * beyond + vec2(-direction.y, direction.x) * side * radius_m;
    // A quad that is wider than the road, so that it is a pixel wide, reaches over ground that this triangle tells
    // nothing about; and level it hides least behind itself.
    let road_share = min(1.0, scaled_half_width_m(in.road_class, far_m) / radius_m);
    let cross_slope = in.cross_slope * frame.background.w * road_share;
    let position = a + ab * at_end + vec3(plan, slope * beyond + cross_slope * side * radius_m);

    var out: VertexOut;
    out.clip = frame.clip_from_relative * vec4(position, 1.0);
    out.start = a.xy;
    out.start_to_end = ab.xy;
    out.road_class = in.road_class;
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
