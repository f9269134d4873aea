// The colours of roads at a pixel: on the ground and on decks of bridges.

// The same fields as in gpu/drawables/composite.rs, in the same order.
struct PictureColors {
    // rgb; w: distance at which haze hides two thirds of a colour.
    haze: vec4f,
    sky: vec4f,
    background: vec4f,
    // The plane that is visible where there is no ground, below all ground: xy: the eye's position
    // on it, modulo w; z: the eye's height above it; w: the widest spacing of its lines. World
    // metres.
    void_plane: vec4f,
    road_bands: array<vec4f, BANDS * CLASSES>,
    road_outlines: array<vec4f, CLASSES>,
    // Colours of tunnels and service roads.
    road_mains: array<vec4f, CLASSES>,
    // Colours of roads that are too thin for an edge.
    road_thins: array<vec4f, CLASSES>,
    // rgb: colour of the sides of bridges. w: 1 if the roads are other lines, such as railways,
    // whose widths are in pixels only.
    slab: vec4f,
}

@group(1) @binding(3) var<uniform> colors: PictureColors;

// Ground that is this many times farther away than its neighbour on the picture is behind it. Not
// used in a view from above.
const FARTHER = 1.1;

// Width of a road at a position in pixels of the final picture, before the minimum width is
// applied.
fn width_px(road_class: u32, look: u32, distance_m: f32, depth: f32) -> f32 {
    // The tile, the direction of the road and its own width are unknown here. So its width factor
    // is that of the whole package, and its width that of its class.
    let road = road_with(road_class, look, 0.0, frame.road_options.z);
    return 2.0 * scaled_half_width_m(road, distance_m) / pixel_m_at(depth);
}

// The ground or the sky at a pixel.
struct Sight {
    color: vec3f,
    // Share of the ground's colour that haze hides.
    haze: f32,
    // 0 in the sky, where the following fields have no meaning.
    depth_buffer: f32,
    depth: f32,
    distance_m: f32,
}

// The view of a position on the picture, without its colour.
fn sight_of(position: vec2f, depth_buffer: f32) -> Sight {
    var sight: Sight;
    sight.depth_buffer = depth_buffer;
    if depth_buffer != 0.0 {
        sight.depth = scale_depth_of(depth_buffer);
        sight.distance_m = sight.depth * length(ray_at(position));
        sight.haze = haze_at(sight.distance_m);
    }
    return sight;
}

// How much of the ground roads of a class hide at a distance from the eye.
fn opacity_at(road_class: u32, look: u32, distance_m: f32) -> f32 {
    return frame.road_limits[road_class].z * shown_share(road_class, look, distance_m);
}

// Remaining share of the colours of a tunnel's surface and of its edge.
const TUNNEL_FILL = 0.35;
const TUNNEL_EDGE = 0.75;

const LEAST_FACING = 0.3;

// The colour of a road at a pixel with this label, and how much it hides of the ground.
fn fill_of(label: u32, sight: Sight) -> vec4f {
    let road_class = class_of(label);
    let look = look_of(label);
    let seen_px = width_px(road_class, look, sight.distance_m, sight.depth);
    let wide = select(colors.road_mains[road_class].rgb, colors.road_bands[road_class * BANDS + label % BANDS].rgb,
        look == PLAIN);
    let are_lines = colors.slab.w > 0.0;
    let has_edge = smoothstep(1.0, 2.2, seen_px) * edge_share(road_class, sight.distance_m);
    let fill = mix(colors.road_thins[road_class].rgb, wide, select(has_edge, 1.0, are_lines));
    // A road that is drawn too wide, because of its minimum width, is made paler.
    let least_px = 2.0 * frame.road_widths[road_class].y / frame.road_scale.w;
    let presence = select(clamp(seen_px / least_px, 0.5, 1.0), 1.0, are_lines) * opacity_at(road_class, look, sight.distance_m)
        * select(1.0, TUNNEL_FILL, is_tunnel(label));
    return vec4(mix(fill, colors.haze.rgb, 0.5 * sight.haze), presence);
}

// The colour of the edge around a road with this label. Of a tunnel only the dashes of its edge are
// visible: if the edge is as dark as the ground, they have the colour of the road.
fn edge_color(label: u32, sight: Sight) -> vec3f {
    let road_class = class_of(label);
    let outline = colors.road_outlines[road_class].rgb;
    let main_color = colors.road_mains[road_class].rgb;
    let luma = vec3(0.2126, 0.7152, 0.0722);
    let is_lost = abs(dot(main_color - sight.color, luma)) > abs(dot(outline - sight.color, luma));
    return select(outline, main_color, is_tunnel(label) && is_lost);
}

// The colour of the edge around a road with this label, and how much it hides.
fn edge_of(label: u32, sight: Sight, facing: f32) -> vec4f {
    let road_class = class_of(label);
    // A very thin road has no edge, because the edge would hide the road; nor has a road that is
    // seen at such a grazing angle that the edge would break into dashes.
    let look = look_of(label);
    let seen_px = width_px(road_class, look, sight.distance_m, sight.depth) * facing;
    let presence = smoothstep(1.2, 4.0, seen_px) * edge_share(road_class, sight.distance_m) * opacity_at(road_class, look, sight.distance_m)
        * select(1.0, TUNNEL_EDGE, is_tunnel(label));
    return vec4(mix(edge_color(label, sight), colors.haze.rgb, 0.5 * sight.haze), presence);
}

// Visible share of a road's width, if the road runs across the view: 1, and less where the view
// meets the ground at less than 19 degrees. At a silhouette, where the angle is unknown, it is at
// least LEAST_FACING, so that a wide road keeps its edge there. It must be computed for every
// pixel, including the sky.
fn facing_of(position: vec2f, sight: Sight) -> f32 {
    let ray = ray_at(position);
    let depth = select(sight.depth, view_depth_of(sight.depth_buffer), is_from_above());
    let ground = ray_start_at(position) + ray * depth;
    let normal = cross(dpdx(ground), dpdy(ground));
    let sine = abs(dot(normal, ray)) / max(length(normal) * length(ray), 1e-30);
    return clamp(3.0 * sine, LEAST_FACING, 1.0);
}
