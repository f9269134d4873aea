// Draws ground, sky and roads into one picture. Ground and sky are drawn everywhere first. Then
// blocks that have roads in or near them are drawn again, with their roads. Most of a picture has
// no roads; there the labels of neighbouring pixels need not be read.
//
// Outlines are found as in Vaaraniemi, Treib & Westermann 2011, section 6.2, by a maximum filter
// over the importance of the roads around a pixel. If the pixel shows no road, or a tunnel of lower
// rank, it is on the outline of the most important road around it.

@group(1) @binding(4) var ground_color: texture_2d<f32>;

// The largest label around a pixel, of roads on ground of at least this depth in the buffer.
fn largest_around(pixel: vec2i, own: f32, least_depth: f32) -> f32 {
    let radius = i32(frame.road_scale.z);
    let last = last_pixel();
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

// Darkness of the lines on the plane of voids at a position, 0 to 1, with this spacing between
// them. `footprint` is the side of a pixel of the final picture there.
fn hatch(along: f32, spacing: f32, footprint: f32) -> f32 {
    let from_line = abs(fract(along / spacing) - 0.5) * spacing;
    return 1.0 - smoothstep(0.4, 1.4, from_line / footprint);
}

// The plane of voids: neutral, with oblique lines at fixed positions. From far away there are fewer
// lines.
fn void_at(ray: vec3f, position: vec2f) -> vec3f {
    let plane = colors.void_plane;
    let down = max(-ray.z, 1e-4);
    let distance = max(plane.z, 0.0) / down;
    let place = plane.xy + ray_start_at(position).xy + distance * ray.xy;
    // The length of a pixel on the plane in the direction of view.
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

// Between 0 and 1, different for each pixel, without a pattern (Jimenez, Next Generation Post
// Processing in Call of Duty: Advanced Warfare, SIGGRAPH 2014: interleaved gradient noise).
fn noise_at(position: vec2f) -> f32 {
    return fract(52.9829189 * fract(dot(position, vec2(0.06711056, 0.00583715))));
}

fn background_at(ray: vec3f, position: vec2f) -> vec3f {
    let elevation = ray.z / length(ray);
    let above = mix(colors.haze.rgb, colors.sky.rgb, smoothstep(0.0, 0.35, elevation));
    let color = mix(void_at(ray, position), above, smoothstep(-0.2, 0.0, elevation));
    // Steps between the 256 values of a channel would be visible as bands. Averaging samples makes
    // the noise weaker, so it is wider than one step.
    let grain = (noise_at(position) - 0.5) * 1.5 / 255.0;
    return color + grain;
}

fn sight_at(position: vec2f) -> Sight {
    // Derivatives also access positions beyond the last row and column.
    let pixel = min(vec2i(position), last_pixel());
    var sight = sight_of(position, textureLoad(terrain_depth, pixel, 0).r);
    if sight.depth_buffer == 0.0 {
        sight.color = background_at(ray_at(position), position);
    } else {
        sight.color = mix(textureLoad(ground_color, pixel, 0).rgb, colors.haze.rgb, sight.haze);
    }
    return sight;
}

// Share of the edge of a more important road that is drawn over this one. Streets of a few pixels
// would turn the edge of a road that many of them meet into dashes; wide streets join the road
// without an edge.
fn edge_over_share(label: u32, sight: Sight) -> f32 {
    return 1.0 - smoothstep(2.2, 3.4, width_px(class_of(label), look_of(label), sight.distance_m, sight.depth));
}

@fragment
fn ground_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4(sight_at(position.xy).color, 1.0);
}

@fragment
fn road_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position.xy);
    let sight = sight_at(position.xy);
    let facing = facing_of(position.xy, sight);
    if sight.depth_buffer == 0.0 {
        return vec4(sight.color, 1.0);
    }
    let own = textureLoad(road_labels, pixel, 0).r;
    let label = label_of(own);
    var color = sight.color;
    if label != 0u {
        let fill = fill_of(label, sight);
        color = mix(color, fill.rgb, fill.a);
    }
    // Roads that meet have no edge between them: labels do not tell which of them continues as the
    // other. The edge of a tunnel is dashed.
    let share = select(edge_over_share(label, sight), 1.0, label == 0u || is_tunnel(label));
    if share > 0.0 {
        let most = label_of(largest_around(pixel, own, select(sight.depth_buffer / FARTHER, 0.0, is_from_above())));
        if rank_of(most) > rank_of(label) && (!is_tunnel(most) || (most & 1u) == 1u) {
            let edge = edge_of(most, sight, facing);
            color = mix(color, edge.rgb, edge.a * share);
        }
    }
    return vec4(color, 1.0);
}
