// Draws the terrain: from vertices relative to the tile to colour, depth and owner.
//
// The owner is the tile that the pixel shows: 0 for none, otherwise the number of the tile in this
// frame, with the highest bit set on skirts, and the highest two on walls. Roads read it: skirts do
// not count as ground, and a volume paints only its own tile. Skirts have a pipeline of their own,
// so that not even their upper edge counts as ground. The alpha of the colour target has the same
// information: 1 ground, 0.5 skirt, 0 nothing.

// 0 draws ground, 1 skirts, 2 the walls along the edge of the data, which hang below the skirts.
override SKIRT: u32 = 0u;
// Lines of the wireframe are moved towards the eye by this many pixel sides. The edges of triangles
// are in the ground, but a line is drawn at pixel centres next to the edge, where sloping ground
// may be nearer. With this offset a line is hidden only where the ground slopes more steeply than
// that.
override PULL_PX: f32 = 0.0;

struct VertexIn {
    @location(0) position_in_tile: vec3f,
    // xyz: unit normal of the ground; w: 1 at the lower edge of a skirt.
    @location(1) normal_skirt: vec4f,
}

struct VertexOut {
    @builtin(position) clip: vec4f,
    @location(0) normal: vec3f,
    @location(1) height_m: f32,
    // Position relative to the eye, world metres.
    @location(2) position: vec3f,
    // Metres from the tile's middle, east and north.
    @location(3) plan_in_tile: vec2f,
}

struct Pixel {
    @location(0) color: vec4f,
    @location(1) owner: u32,
}

@vertex
fn vertex(in: VertexIn) -> VertexOut {
    let vertical_scale = frame.scale.y;
    let lower = in.normal_skirt.w;
    // Walls begin where skirts end.
    let down = select(lower * tile.offset.w, tile.offset.w + lower * colors.sunlit.w, SKIRT == 2u);
    let in_tile = vec3(in.position_in_tile.xy, in.position_in_tile.z * vertical_scale - down);
    var out: VertexOut;
    out.position = tile.offset.xyz + in_tile;
    out.clip = frame.clip_from_relative * vec4(out.position, 1.0);
    // depth_buffer = z / w, greater is nearer.
    if is_from_above() {
        out.clip.z += PULL_PX * frame.scale.x * frame.network.w / (frame.network.z - frame.forward.w);
    } else {
        out.clip.z *= 1.0 + PULL_PX * frame.scale.x;
    }
    // Exaggeration reduces the vertical part of normals.
    out.normal = vec3(in.normal_skirt.xy * vertical_scale, in.normal_skirt.z);
    out.height_m = tile.base.x + in.position_in_tile.z;
    out.plan_in_tile = in.position_in_tile.xy;
    return out;
}

fn owner_of_pixel() -> u32 {
    // The bits as defined in shaders/drawn_ground.wgsl.
    return u32(tile.base.z) | (min(SKIRT, 1u) << 31u) | (select(0u, 1u, SKIRT == 2u) << 30u);
}

@fragment
fn fragment(in: VertexOut) -> Pixel {
    let distance_m = distance_to(in.position);
    let normal = ground_normal(in.normal, in.plan_in_tile, distance_m);
    let photo = photo_at(in.plan_in_tile);
    let photo_share = photo.a * colors.water.w;
    var color = mix(colors.water.rgb, photo.rgb, photo_share);
    if !is_water(in.plan_in_tile) {
        // A photo contains shadows itself.
        color = shaded(mix(tint_at(in.height_m), photo.rgb, photo_share), normal, 1.0 - 0.5 * photo_share);
    }
    color = hazy(color, in.height_m, distance_m);
    return Pixel(vec4(color, select(1.0, 0.5, SKIRT == 1u)), owner_of_pixel());
}

@fragment
fn wall_fragment(in: VertexOut) -> Pixel {
    // The direction of the wall, derived from the change of its position on the picture.
    let across = cross(dpdx(in.position), dpdy(in.position));
    let facing = abs(dot(normalize(across.xy + vec2(1e-20, 0.0)), normalize(colors.light.xy + vec2(0.0, 1e-20))));
    let color = colors.wall.rgb * (0.85 + 0.2 * facing);
    return Pixel(vec4(hazy(color, in.height_m, distance_to(in.position)), 0.5), owner_of_pixel());
}

@fragment
fn wire_fragment(in: VertexOut) -> @location(0) vec4f {
    let color = tint_at(in.height_m);
    let is_dark = dot(color, vec3(0.299, 0.587, 0.114)) < 0.4;
    return vec4(mix(color, vec3(select(0.0, 1.0, is_dark)), 0.6), 1.0);
}
