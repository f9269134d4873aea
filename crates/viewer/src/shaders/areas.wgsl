// Areas as stencil shadow volumes: a closed prism over each polygon, from below all ground in the
// polygon to above it.
//
// Source: Schneider & Klein 2007, Efficient and Accurate Rendering of Vector Data on Virtual
// Landscapes, Journal of WSCG 15.
//
//      eye                              A face between the eye and the ground counts +1 if it is seen from outside and −1 if from
//         ╲      ┌──top──┐              inside (z-pass). Ground outside all prisms then has the count 0. Alternatively, faces behind the
//          ╲+1   │       │              ground count, with opposite signs (z-fail): this is also correct with the eye inside, or where
//       ────╲────┼──→────┼──── ground   the near plane cuts a face off.
//            ╲   │   −1  │
//                └─bottom┘
//
// What we changed: depths are not compared. The interpolated depth between two far vertices has an
// error that is large compared with the smallest depths; on the ground it is some metres. Instead
// the position of the ground is computed from its depth, and a face is in front of the ground if
// the eye and that position are on different sides of the face. For walls this is the test in plan
// that roads use (coverage.wgsl), so an edge is as exact as the position of the ground. Faces only
// select pixels for the test.

struct Face {
    // Faces of a volume must meet without a gap, with any pipeline.
    @invariant @builtin(position) clip: vec4f,
    // Walls: both ends in plan, relative to the eye. Caps: xy is 0, z the height above the eye.
    @location(0) @interpolate(flat) ends: vec4f,
}

// 1 draws upper caps, 0 draws lower caps.
override IS_TOP: u32 = 0u;
// 1 counts faces behind the ground, 0 counts faces in front of it.
override IS_FAIL: u32 = 0u;

// `heights` are bottom and top above the tile's reference point, true metres.
fn height_of(heights: vec2f, is_top: bool) -> f32 {
    let height = tile.offset.z + select(heights.x, heights.y, is_top) * frame.scale.y;
    // Skirts are painted like the ground from which they hang.
    return height - select(tile.offset.w, 0.0, is_top);
}

// In a view from above, walls are edge-on and cover nothing.
@vertex
fn wall_vertex(@builtin(vertex_index) corner: u32, @location(0) start: vec2f, @location(1) end: vec2f,
    @location(2) heights: vec2f) -> Face {
    //  2 ── 3     seen from outside: the inside is on the left in the direction from start to end
    //  │  ╲ │
    //  0 ── 1
    let plan = tile.offset.xy + select(start, end, (corner & 1u) == 1u);
    let clip = clip_of(vec3(plan, height_of(heights, corner > 1u)));
    return Face(clip, vec4(tile.offset.xy + start, tile.offset.xy + end));
}

@vertex
fn cap_vertex(@location(0) place: vec2f, @location(1) heights: vec2f) -> Face {
    let plan = tile.offset.xy + place;
    let height = height_of(heights, IS_TOP == 1u);
    return Face(clip_of(vec3(plan, height)), vec4(0.0, 0.0, height, 0.0));
}

// The side of the line through a and b on which a position is. Both tiles and both areas at a
// common edge use the same line.
fn is_left(a: vec2f, b: vec2f, at: vec2f) -> bool {
    return (b.x - a.x) * (at.y - a.y) - (b.y - a.y) * (at.x - a.x) > 0.0;
}

// Whether a ray from the eye to a position on the ground passes the wall over a–b. The ray is known
// to meet the wall somewhere.
fn is_beyond_wall(a: vec2f, b: vec2f, at: vec2f, ray: vec2f) -> bool {
    // Along the ray, the wall is only between its ends. This decides if the wall is seen edge-on:
    // then its line is the ray.
    let along = vec2(dot(a, ray), dot(b, ray));
    let ground_along = dot(at, ray);
    if ground_along > max(along.x, along.y) {
        return true;
    }
    if ground_along < min(along.x, along.y) {
        return false;
    }
    let is_turned = a.x > b.x || (a.x == b.x && a.y > b.y);
    let first = select(a, b, is_turned);
    let last = select(b, a, is_turned);
    return is_left(first, last, vec2(0.0)) != is_left(first, last, at);
}

// Position of the tile's own ground or skirt at a pixel; w is 0 if the pixel shows something else
// or is outside the picture.
fn own_ground(center: vec2f) -> vec4f {
    let pixel = vec2i(floor(center));
    let is_outside = any(pixel < vec2(0)) || any(pixel >= vec2i(textureDimensions(owners)));
    if is_outside || (textureLoad(owners, pixel, 0).r & ~SKIRT) != u32(tile.base.z) {
        return vec4(0.0);
    }
    return vec4(position_at(center, textureLoad(terrain_depth, pixel, 0).r), 1.0);
}

// The stencil operation counts fragments that are not discarded.
@fragment
fn wall_fragment(in: Face) {
    let ground = own_ground(in.clip.xy);
    let is_beyond = is_beyond_wall(in.ends.xy, in.ends.zw, ground.xy, ray_at(in.clip.xy).xy);
    if ground.w == 0.0 || is_beyond == (IS_FAIL == 1u) {
        discard;
    }
}

@fragment
fn cap_fragment(in: Face) {
    let ground = own_ground(in.clip.xy);
    let height = in.ends.z;
    let is_beyond = (is_from_above() || height < 0.0) != (height < ground.z);
    if ground.w == 0.0 || is_beyond == (IS_FAIL == 1u) {
        discard;
    }
}

// How areas of a class look.
struct AreaLook {
    // rgb; w: opacity.
    color: vec4f,
    // x: the slope from which on nothing is painted, tangent of the angle; y: the slope up to which
    // everything is painted.
    steepest: vec4f,
}

@group(3) @binding(0) var<uniform> look: AreaLook;

// The box around the volumes of a class. Only its far faces are drawn: one fragment for each pixel
// that sees the box, also with the eye inside. The stencil decides which of these pixels are
// painted.
@vertex
fn box_vertex(@builtin(vertex_index) index: u32, @location(0) low: vec3f, @location(1) high: vec3f)
    -> @builtin(position) vec4f {
    let corner = STRIP[index];
    let plan = tile.offset.xy
        + vec2(select(low.x, high.x, (corner & 1u) != 0u), select(low.y, high.y, (corner & 2u) != 0u));
    let height = height_of(vec2(low.z, high.z), (corner & 4u) != 0u);
    return clip_of(vec3(plan, height));
}

// The step from the position of a tile's own ground at a pixel to the position at the adjacent
// pixel, on the side where that is nearer. 0 if neither pixel shows the tile's ground.
fn step_on_ground(center: vec2f, here: vec3f, aside: vec2f) -> vec3f {
    let after = own_ground(center + aside);
    let before = own_ground(center - aside);
    let forth = after.xyz - here;
    let back = here - before.xyz;
    let is_forth = after.w != 0.0 && (before.w == 0.0 || dot(forth, forth) <= dot(back, back));
    return select(select(vec3(0.0), back, before.w != 0.0), forth, is_forth);
}

// The slope of a tile's own ground at a pixel: tangent of the angle.
fn slope_at(center: vec2f) -> f32 {
    let here = own_ground(center).xyz;
    let normal = cross(step_on_ground(center, here, vec2(1.0, 0.0)), step_on_ground(center, here, vec2(0.0, 1.0)));
    // If the ground is only one pixel wide, its slope is unknown.
    return select(length(normal.xy) / max(abs(normal.z), 1e-9) / frame.scale.y, 0.0, dot(normal, normal) == 0.0);
}

@fragment
fn box_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let painted = (look.steepest.x - slope_at(position.xy)) / (look.steepest.x - look.steepest.y);
    return vec4(look.color.rgb, look.color.a * clamp(painted, 0.0, 1.0));
}
