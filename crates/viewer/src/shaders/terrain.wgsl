// Draws the terrain: from vertices relative to the tile to colour, depth and owner.
//
// The owner says which tile the pixel shows: 0 for none, else the number of the tile in this frame, with the highest bit
// set on skirts. Roads read it: skirts do not count as ground, and a volume paints its own tile only. Skirts are drawn by
// a pipeline of their own, so that not even their upper edge counts as ground.
// Alpha says the same in the colour target: 1 ground, 0.5 skirt, 0 nothing.

struct Tile {
    // xyz: the tile's reference point minus the eye; w: depth of the skirt, world metres.
    offset: vec4<f32>,
    // x: true height of the reference point; z: the tile's number in this frame, from 1.
    base: vec4<f32>,
    // xy: the tile's sides, metres.
    sides: vec4<f32>,
}

@group(1) @binding(0) var<uniform> tile: Tile;

const TINT_STOPS = 6u;

// The same fields as in gpu/drawables/terrain.rs, in the same order.
struct GroundColors {
    // xyz: towards the light; w: strength of the hillshade.
    light: vec4<f32>,
    // x: lowest ground; y: 1 / height range; z: strength of photos.
    heights: vec4<f32>,
    // rgb; w: share of the height range.
    tint: array<vec4<f32>, TINT_STOPS>,
}

@group(2) @binding(0) var<uniform> colors: GroundColors;

// 0 draws ground, 1 skirts.
override SKIRT: u32 = 0u;
// Lines of the wireframe are moved towards the eye by this many sides of a pixel. The edges of triangles lie in the
// ground, but a line is drawn at pixel centres beside the edge, where sloping ground may be nearer. With this move a line
// is hidden only where the ground slopes more steeply than that.
override PULL_PX: f32 = 0.0;

struct VertexIn {
    @location(0) position_in_tile: vec3<f32>,
    // xyz: unit normal of the ground; w: 1 at the lower edge of a skirt.
    @location(1) normal_skirt: vec4<f32>,
}

struct VertexOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(1) height_m: f32,
    // From the tile's middle.
    @location(2) in_tile: vec2<f32>,
}

struct Pixel {
    @location(0) color: vec4<f32>,
    @location(1) owner: u32,
}

@vertex
fn vertex(in: VertexIn) -> VertexOut {
    let vertical_scale = frame.scale.y;
    let down = in.normal_skirt.w * tile.offset.w;
    let in_tile = vec3(in.position_in_tile.xy, in.position_in_tile.z * vertical_scale - down);
    var out: VertexOut;
    out.clip = frame.clip_from_relative * vec4(tile.offset.xyz + in_tile, 1.0);
    // depth_buffer = z / w, greater is nearer.
    out.clip.z *= 1.0 + PULL_PX * frame.scale.x;
    // Stretching the ground upwards flattens its normals' vertical part.
    out.normal = vec3(in.normal_skirt.xy * vertical_scale, in.normal_skirt.z);
    out.height_m = tile.base.x + in.position_in_tile.z;
    out.in_tile = in.position_in_tile.xy;
    return out;
}

fn tint_at(height_m: f32) -> vec3<f32> {
    let share = clamp((height_m - colors.heights.x) * colors.heights.y, 0.0, 1.0);
    var color = colors.tint[0].rgb;
    for (var k = 1u; k < TINT_STOPS; k++) {
        let low = colors.tint[k - 1u].w;
        let t = clamp((share - low) / (colors.tint[k].w - low), 0.0, 1.0);
        color = mix(color, colors.tint[k].rgb, t);
    }
    return color;
}

@fragment
fn fragment(in: VertexOut) -> Pixel {
    // 1 on level ground, below on slopes turned away from the light, above on slopes turned towards it.
    let lit = max(dot(normalize(in.normal), colors.light.xyz), 0.0) / colors.light.z;
    let photo = photo_at(in.in_tile, tile.sides.xy);
    let photo_share = photo.a * colors.heights.z;
    let color = mix(tint_at(in.height_m), photo.rgb, photo_share);
    // A photo has shadows of its own.
    let hillshade = colors.light.w * (1.0 - 0.5 * photo_share);
    // As on printed maps, shadows are blue rather than black.
    let shaded = color * vec3(0.36, 0.40, 0.52);
    let dark = mix(color, shaded, hillshade * clamp(1.0 - lit, 0.0, 1.0));
    let bright = mix(dark, vec3(1.0), hillshade * clamp(lit - 1.0, 0.0, 1.0) * 0.9);
    let owner = u32(tile.base.z) | (SKIRT << 31u);
    return Pixel(vec4(bright, select(1.0, 0.5, SKIRT == 1u)), owner);
}

@fragment
fn wire_fragment(in: VertexOut) -> @location(0) vec4<f32> {
    let color = tint_at(in.height_m);
    let is_dark = dot(color, vec3(0.299, 0.587, 0.114)) < 0.4;
    return vec4(mix(color, vec3(select(0.0, 1.0, is_dark)), 0.6), 1.0);
}
