// Roads as shadow volumes (SV): one box per segment, from below the lowest ground in it to above
// the highest.
//
// Source: Vaaraniemi, Treib & Westermann 2011, High-Quality Cartographic Roads on High-Resolution
// DEMs, section 5.
//
//            ┌───────────────┐ ─ highest ground beneath
//           ╱│              ╱│     Only faces that look away from the eye are drawn: each pixel that sees the
//          ┌───────────────┐ │     box gets one fragment, also when the eye is inside. There is no depth test:
//          │ │  a──────b   │ │     the fragment shader reads the ground's depth and decides whether it is road.
//          │ └─────────────│─┘ ─ lowest
//          │╱              │╱
//          └───────────────┘
//
// What we changed: the box spans the heights of the ground within the road's width, not of the
// whole tile; and the distance of the ground to the segment decides (coverage.wgsl). With
// `road_options.y` the paper's own test is used.
//
// A volume paints only the ground of its own tile. Every tile has all lines within the width margin
// around it, so wide roads are not cut off at borders. Where tiles of two levels meet, the roads of
// one tile are not painted on the ground of the other. Skirts do not count as ground; only
// connectors (scene/level_connectors.rs) paint skirts.

struct VolumeIn {
    @builtin(vertex_index) corner: u32,
    @location(0) start_in_tile: vec2f,
    @location(1) end_in_tile: vec2f,
    @location(2) height_range_in_tile: vec2f,
    // Lowest and highest ground below the segment.
    @location(3) near_range_in_tile: vec2f,
    // x: how much lower or higher the ground may be per metre away from the segment, up to
    // `tile.base.w` away; y: world metres across the road per true metre.
    @location(4) near_rise_width_factor: vec2f,
    // Same as in RoadFragment.
    @location(5) class_and_other: u32,
    // The road's own width, as `road_with` takes it.
    @location(6) own_width: f32,
    // Same as in RoadFragment.
    @location(7) dash: vec2f,
    // Same as in RoadFragment.
    @location(8) part_m: f32,
}

struct Reach {
    radius_m: f32,
    // Heights relative to the eye.
    heights: vec2f,
}

// Half the width of a road whose ground is between these heights, and these heights.
fn reach_over(heights: vec2f, road: Road, plan_m: f32) -> Reach {
    let far_m = distance_to(vec3(plan_m, 0.0, max(abs(heights.x), abs(heights.y))));
    let near_height_m = select(0.0, min(abs(heights.x), abs(heights.y)), heights.x * heights.y > 0.0);
    // Heights are known only within the margin.
    return Reach(min(bounding_radius_m(road, far_m, near_height_m), tile.base.y), heights);
}

// Half the width of the box, and the lowest and highest ground within that distance of the segment.
fn reach_of(in: VolumeIn, road: Road, plan_m: f32) -> Reach {
    let vertical_scale = frame.scale.y;
    let all = tile.offset.z + in.height_range_in_tile * vertical_scale;
    let rise = vec2(-1.0, 1.0) * in.near_rise_width_factor.x;
    let near = tile.offset.z + (in.near_range_in_tile + rise * tile.base.w) * vertical_scale;
    var reach = reach_over(clamp(near, all.xx, all.yy), road, plan_m);
    if reach.radius_m > tile.base.w {
        return reach_over(all, road, plan_m);
    }
    let nearer = tile.offset.z + (in.near_range_in_tile + rise * reach.radius_m) * vertical_scale;
    reach.heights = clamp(nearer, all.xx, all.yy);
    return reach;
}

@vertex
fn vertex(in: VolumeIn) -> RoadFragment {
    let vertical_scale = frame.scale.y;
    let look = (in.class_and_other >> 4u) & 7u;
    let road = road_with(in.class_and_other & 15u, look, in.own_width, in.near_rise_width_factor.y);
    let is_connector = in.class_and_other > 511u;
    let a = tile.offset.xy + in.start_in_tile;
    let ab = in.end_in_tile - in.start_in_tile;
    let length_m = length(ab);
    let direction = direction_of(ab, length_m);

    let plan_m = max(length(a), length(a + ab));
    let reach = reach_of(in, road, plan_m);
    let radius_m = reach.radius_m;
    // The box is enlarged a little, so that rounding of positions does not cut off ground at the
    // edge. The fragment shader decides for each pixel. The ground next to connectors is unknown.
    // It rises or falls by more than the road's width only on cliffs.
    let pad_m = 1e-6 * length(vec3(plan_m, reach.heights)) + 0.01;
    let pad_height_m = pad_m + select(0.0, 2.0 * radius_m * vertical_scale, is_connector);
    let heights = reach.heights + vec2(-pad_height_m, pad_height_m);

    let clip = box_corner(in.corner, a, ab, direction, radius_m + pad_m, heights);
    return RoadFragment(clip, a, ab, in.class_and_other, road.half_width_m, in.dash, in.part_m);
}

// The distances at which a ray from the eye along the unit vector `ray` enters and leaves the cap
// at an end, as the paper computes them. If the ray misses the cap, the entry is behind the exit.
// `cap` is relative to the ray's start.
fn through_cap(ray: vec3f, cap: vec2f, radius_m: f32) -> vec2f {
    let c = -cap;
    if is_from_above() {
        return select(vec2(NEVER, -NEVER), vec2(-NEVER, NEVER), dot(c, c) <= radius_m * radius_m);
    }
    let vv = dot(ray.xy, ray.xy);
    let vc = dot(ray.xy, c);
    let d = 4.0 * vc * vc - 4.0 * vv * (dot(c, c) - radius_m * radius_m);
    if d <= 0.0 || vv < 1e-12 {
        return vec2(NEVER, -NEVER);
    }
    return (vec2(-2.0 * vc) + vec2(-1.0, 1.0) * sqrt(d)) / (2.0 * vv);
}

// The distances at which `origin + distance · speed` comes between `low` and `high` and leaves that
// range.
fn through_slab(origin: f32, speed: f32, low: f32, high: f32) -> vec2f {
    if abs(speed) < 1e-9 {
        return select(vec2(NEVER, -NEVER), vec2(-NEVER, NEVER), origin >= low && origin <= high);
    }
    let t = vec2(low - origin, high - origin) / speed;
    return vec2(min(t.x, t.y), max(t.x, t.y));
}

// The paper's test, section 5.2: z0 < zt < z1. `share` is the share of the road's width.
fn is_road_by_the_paper(in: RoadFragment, depth_buffer: f32, share: f32) -> bool {
    let center = in.clip.xy;
    let road = road_of(in);
    let position = position_at(center, depth_buffer);
    let ray_start = ray_start_at(center);
    let start = in.start - ray_start.xy;
    let ground = length(position - ray_start);
    let distance_m = distance_to(position);
    let ray = normalize(ray_at(center));
    let radius_m = min(tile.base.y, share
        * max(scaled_half_width_m(road, distance_m), least_half_width_m(road, scale_depth_of(depth_buffer))));

    let length_m = length(in.start_to_end);
    let direction = direction_of(in.start_to_end, length_m);
    let normal = vec2(-direction.y, direction.x);
    let along = through_slab(-dot(start, direction), dot(ray.xy, direction), 0.0, length_m);
    let across = through_slab(-dot(start, normal), dot(ray.xy, normal), -radius_m, radius_m);
    var between = vec2(max(along.x, across.x), min(along.y, across.y));
    if between.x > between.y {
        between = vec2(NEVER, -NEVER);
    }
    if has_caps() {
        let first = through_cap(ray, start, radius_m);
        let last = through_cap(ray, start + in.start_to_end, radius_m);
        between = vec2(min(between.x, min(first.x, last.x)), max(between.y, max(first.y, last.y)));
    }
    return between.x < ground && ground < between.y;
}

fn label_by_the_paper(in: RoadFragment, depth_buffer: f32) -> u32 {
    let road = road_of(in);
    let distance_m = distance_to(position_at(in.clip.xy, depth_buffer));
    if !is_shown(road, distance_m) {
        return NOTHING;
    }
    let part = part_share(road, distance_m);
    let bands = band_count(road);
    var within = 0u;
    while within < bands && is_road_by_the_paper(in, depth_buffer, part * band_share(road.class_number, within)) {
        within++;
    }
    return band_label(road, within);
}

@fragment
fn fragment(in: RoadFragment) -> @location(0) f32 {
    let pixel = vec2i(in.clip.xy);
    let owner = textureLoad(owners, pixel, 0).r;
    let own = u32(tile.base.z);
    let other = in.class_and_other >> 9u;
    let is_mine = owner == own;
    let number = owner & ~(SKIRT | WALL);
    let is_connected = other != 0u && (number == own || number == other);
    if !is_mine && !is_connected {
        discard;
    }
    let depth_buffer = textureLoad(terrain_depth, pixel, 0).r;
    if frame.road_options.y > 0.5 {
        return painted(label_by_the_paper(in, depth_buffer), in, depth_buffer);
    }
    return painted(label_at(in, depth_buffer), in, depth_buffer);
}
