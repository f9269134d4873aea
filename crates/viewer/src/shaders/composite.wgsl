// Draws ground, sky and roads into one picture. Ground and sky are drawn everywhere first. Then blocks that have roads in
// them or near them are drawn again, with their roads. Most of a picture has no roads; there the labels of neighbouring
// pixels need not be read.
//
// Outlines are found as in Vaaraniemi, Treib & Westermann 2011, section 6.2, by a maximum filter over the importance of the
// roads around a pixel. Where the maximum is more important than the pixel's own road, the pixel is on the outline of the
// more important road.

@group(1) @binding(4) var ground_color: texture_2d<f32>;

// The same fields as in gpu/drawables/composite.rs, in the same order.
struct PictureColors {
    // rgb; w: distance at which haze hides two thirds of a colour.
    haze: vec4<f32>,
    sky: vec4<f32>,
    background: vec4<f32>,
    // Where there is no ground, a plane beneath all ground is seen: xy: the eye's place on it, modulo w; z: the eye's height
    // above it; w: the widest spacing of its lines. World metres.
    void_plane: vec4<f32>,
    road_bands: array<vec4<f32>, BANDS * CLASSES>,
    road_outlines: array<vec4<f32>, CLASSES>,
    // Tunnels and service roads.
    road_mains: array<vec4<f32>, CLASSES>,
    // Roads that are too thin for an edge.
    road_thins: array<vec4<f32>, CLASSES>,
}

@group(1) @binding(3) var<uniform> colors: PictureColors;

// Ground that is this many times farther away than its neighbour in the picture lies behind it. From above none does.
const FARTHER = 1.1;

// The largest label around a pixel, of roads on ground of at least this depth in the buffer.
fn largest_around(pixel: vec2<i32>, own: f32, least_depth: f32) -> f32 {
    let radius = i32(frame.road_scale.z);
    let last = vec2<i32>(i32(frame.right.w), i32(frame.up.w)) - 1;
    var largest = own;
    for (var y = -radius; y <= radius; y++) {
        for (var x = -radius; x <= radius; x++) {
            let near = clamp(pixel + vec2(x, y), vec2(0), last);
            let stored = textureLoad(road_labels, near, 0).r;
            if stored > largest {
                // A road behind a crest has no edge on the crest.
                if textureLoad(terrain_depth, near, 0).r >= least_depth {
                    largest = stored;
                }
            }
        }
    }
    return largest;
}

// Distance between the lines on the plane of voids, pixels of the final picture.
const HATCH_PX = 9.0;

// How dark the lines at a place of the plane of voids are, 0 to 1, with this spacing between them. `footprint` is the side of
// a pixel of the final picture there.
fn hatch(along: f32, spacing: f32, footprint: f32) -> f32 {
    let from_line = abs(fract(along / spacing) - 0.5) * spacing;
    return 1.0 - smoothstep(0.4, 1.4, from_line / footprint);
}

// The plane of voids: neutral, with oblique lines that keep their place on the ground. From far away there are fewer lines.
fn void_at(ray: vec3<f32>, position: vec2<f32>) -> vec3<f32> {
    let plane = colors.void_plane;
    let down = max(-ray.z, 1e-4);
    let distance = max(plane.z, 0.0) / down;
    let place = plane.xy + ray_start_at(position).xy + distance * ray.xy;
    // As long as it is on the plane in the direction of view.
    let footprint = pixel_m_at(select(distance, frame.network.w, is_from_above())) * inverseSqrt(down) + 1e-9;
    let octave = log2(HATCH_PX * footprint);
    let spacing = exp2(ceil(octave));
    let along = place.x + place.y;
    // Every second line fades away before the spacing doubles.
    let every = hatch(along, spacing, footprint);
    let second = hatch(along + 0.5 * spacing, 2.0 * spacing, footprint);
    let shown = select(mix(every, second, fract(octave)), 0.0, plane.z <= 0.0);
    return colors.background.rgb * (1.0 - 0.045 * shown);
}

// Between 0 and 1, different for each pixel, without a pattern (Jimenez, Next Generation Post Processing in Call of Duty:
// Advanced Warfare, SIGGRAPH 2014: interleaved gradient noise).
fn noise_at(position: vec2<f32>) -> f32 {
    return fract(52.9829189 * fract(dot(position, vec2(0.06711056, 0.00583715))));
}

fn background_at(ray: vec3<f32>, position: vec2<f32>) -> vec3<f32> {
    let elevation = ray.z / length(ray);
    let above = mix(colors.haze.rgb, colors.sky.rgb, smoothstep(0.0, 0.35, elevation));
    let color = mix(void_at(ray, position), above, smoothstep(-0.2, 0.0, elevation));
    // Steps between the 256 values of a channel would be seen as bands. Averaging samples makes the noise weaker, so it is
    // wider than one step.
    let grain = (noise_at(position) - 0.5) * 1.5 / 255.0;
    return color + grain;
}

// Width of a road at a place in pixels of the final picture, before the least width is applied.
fn width_px(road_class: u32, look: u32, distance_m: f32, depth: f32) -> f32 {
    // The tile, the direction of the road and its own width are not known here. So its width factor is that of the whole
    // package, and its width that of its class.
    let road = road_with(road_class, look, 0.0, frame.road_options.z);
    return 2.0 * scaled_half_width_m(road, distance_m) / pixel_m_at(depth);
}

// The ground or the sky at a pixel.
struct Sight {
    color: vec3<f32>,
    // Share of the ground's colour that is lost on the way.
    haze: f32,
    // 0 in the sky, where the fields that follow have no meaning.
    depth_buffer: f32,
    depth: f32,
    distance_m: f32,
}

fn sight_at(position: vec2<f32>) -> Sight {
    // Derivatives also ask for places beyond the last row and column.
    let pixel = min(vec2<i32>(position), vec2<i32>(i32(frame.right.w), i32(frame.up.w)) - 1);
    let ray = ray_at(position);
    var sight: Sight;
    sight.depth_buffer = textureLoad(terrain_depth, pixel, 0).r;
    if sight.depth_buffer == 0.0 {
        sight.color = background_at(ray, position);
        return sight;
    }
    sight.depth = scale_depth_of(sight.depth_buffer);
    sight.distance_m = sight.depth * length(ray);
    let reach = sight.distance_m / colors.haze.w;
    sight.haze = 1.0 - exp(-reach * reach);
    sight.color = mix(textureLoad(ground_color, pixel, 0).rgb, colors.haze.rgb, sight.haze);
    return sight;
}

// How much of the ground roads of a class hide at a distance from the eye.
fn opacity_at(road_class: u32, look: u32, distance_m: f32) -> f32 {
    return frame.road_limits[road_class].z * shown_share(road_class, look, distance_m);
}

// What is left of the colours of a tunnel's surface and of its edge.
const TUNNEL_FILL = 0.35;
const TUNNEL_EDGE = 0.75;

const LEAST_FACING = 0.3;

// How much of the width of a road is seen, if the road runs across the view: 1, and less where the ground at a pixel is
// seen at less than 19 degrees. At a silhouette, where this cannot be told, it is at least LEAST_FACING, so that a wide road
// keeps its edge there. It must be asked for every pixel, in the sky too.
fn facing_of(position: vec2<f32>, sight: Sight) -> f32 {
    let ray = ray_at(position);
    let depth = select(sight.depth, view_depth_of(sight.depth_buffer), is_from_above());
    let ground = ray_start_at(position) + ray * depth;
    let normal = cross(dpdx(ground), dpdy(ground));
    let sine = abs(dot(normal, ray)) / max(length(normal) * length(ray), 1e-30);
    return clamp(3.0 * sine, LEAST_FACING, 1.0);
}

@fragment
fn ground_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return vec4(sight_at(position.xy).color, 1.0);
}

@fragment
fn road_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(position.xy);
    let sight = sight_at(position.xy);
    let facing = facing_of(position.xy, sight);
    if sight.depth_buffer == 0.0 {
        return vec4(sight.color, 1.0);
    }
    var color = sight.color;

    let own = textureLoad(road_labels, pixel, 0).r;
    let label = label_of(own);
    if label != 0u {
        let road_class = class_of(label);
        let look = look_of(label);
        let seen_px = width_px(road_class, look, sight.distance_m, sight.depth);
        let wide = select(colors.road_mains[road_class].rgb, colors.road_bands[road_class * BANDS + label % BANDS].rgb,
            look == PLAIN);
        let fill = mix(colors.road_thins[road_class].rgb, wide, smoothstep(1.0, 2.2, seen_px));
        // A road that is drawn wider than it is, because of its least width, is made paler.
        let least_px = 2.0 * frame.road_widths[road_class].y / frame.road_scale.w;
        let presence = clamp(seen_px / least_px, 0.5, 1.0) * opacity_at(road_class, look, sight.distance_m)
            * select(1.0, TUNNEL_FILL, is_tunnel(label));
        color = mix(color, mix(fill, colors.haze.rgb, 0.5 * sight.haze), presence);
    }

    let most = label_of(largest_around(pixel, own, select(sight.depth_buffer / FARTHER, 0.0, is_from_above())));
    // The edge of a tunnel is dashed.
    if rank_of(most) > rank_of(label) && (!is_tunnel(most) || (most & 1u) == 1u) {
        let road_class = class_of(most);
        // Around a very thin road there is no edge, because it would hide the road; nor around one that is seen so flat that
        // the edge would break into dashes.
        let look = look_of(most);
        let seen_px = width_px(road_class, look, sight.distance_m, sight.depth) * facing;
        let presence = smoothstep(1.2, 4.0, seen_px) * opacity_at(road_class, look, sight.distance_m)
            * select(1.0, TUNNEL_EDGE, is_tunnel(most));
        color = mix(color, mix(colors.road_outlines[road_class].rgb, colors.haze.rgb, 0.5 * sight.haze), presence);
    }
    return vec4(color, 1.0);
}
