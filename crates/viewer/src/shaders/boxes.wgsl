// The corners of a box around a drawn feature, in the order of a triangle strip around it.

// The corners of a box as one strip of twelve triangles, all counter-clockwise seen from outside:
// bit 0: end or start (of areas east), bit 1: left or right (of areas north), bit 2: top or bottom.
const STRIP = array<u32, 14>(0u, 1u, 4u, 5u, 7u, 1u, 3u, 0u, 2u, 4u, 6u, 7u, 2u, 3u);

// A corner of the box around all positions within `radius_m` of a segment in plan, between a lower
// and an upper height.
fn box_corner(index: u32, start: vec2f, start_to_end: vec2f, direction: vec2f, radius_m: f32, heights: vec2f) -> vec4f {
    let corner = STRIP[index];
    let at_end = f32(corner & 1u);
    let side = f32((corner >> 1u) & 1u) * 2.0 - 1.0;
    let outward = direction * (at_end * 2.0 - 1.0);
    let across = vec2(-direction.y, direction.x) * side;
    let plan = start + start_to_end * at_end + (outward + across) * radius_m;
    return clip_of(vec3(plan, select(heights.x, heights.y, (corner & 4u) != 0u)));
}
