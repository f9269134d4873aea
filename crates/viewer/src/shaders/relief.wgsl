// The unit normal of the ground at a pixel: from the tile's relief, independent of its triangles,
// or from their vertices. Texel (column, row) of the slopes is node (column, row) of the tile, row
// 0 in the north. So both sides of a border read the same two nodes between the same texels, and
// shading continues without a step.
//
// Levels are blended, so that there is no step where levels meet and nothing appears abruptly when
// a tile replaces its parent. The slopes that a pixel shows depend only on the size of the pixel,
// not on the tile that is drawn. Tiles are drawn where their cells look smaller than blend_px
// pixels, so there the slopes of a level may be fully shown; the next finer slopes have disappeared
// just before, and a tile of that level shows its parent's slopes there:
//
//   cells of level n look   4 ── 2.8 ── 2 ── 1.4 ── 1 px large, if blend_px is 2
//   shown                       n ─────────┐
//                                          └ fades ─ n − 1 ────────┐

struct TileTextures {
    // xy: 1 / the tile's sides east and north; z: 1 if the tile has slopes, otherwise 0; w: the
    // same for water.
    plan: vec4f,
    // x: 1 if the tile has a photo, otherwise 0; y: texels of its border on each side.
    photo: vec4f,
    // xy: column and row of the tile in its level, modulo a power of 2; z: number of ancestors with
    // slopes; w: log2 of the side of its cells in metres.
    levels: vec4f,
}

@group(3) @binding(0) var<uniform> tile_textures: TileTextures;
@group(3) @binding(1) var tile_sampler: sampler;
// Rise in metres per metre east and north.
@group(3) @binding(2) var slopes: texture_2d<f32>;
// 1 where a node is water.
@group(3) @binding(5) var water: texture_2d<f32>;
// The slopes of the tile's parent, grandparent, and so on.
@group(3) @binding(6) var slopes_1_above: texture_2d<f32>;
@group(3) @binding(7) var slopes_2_above: texture_2d<f32>;
@group(3) @binding(8) var slopes_3_above: texture_2d<f32>;

// Over this part of a level the finer slopes fade into the coarser ones; a level is a factor of 2
// in size.
const FADE = 0.5;

// A position in its tile: 0 at the western and northern border, 1 at the others.
fn share_of_tile(plan_in_tile: vec2f) -> vec2f {
    return vec2(0.5, 0.5) + vec2(1.0, -1.0) * plan_in_tile * tile_textures.plan.xy;
}

// A position in a texture of nodes: node 0 is in the middle of the first texel, the last node in
// the middle of the last.
fn place_among_nodes(share: vec2f, nodes: vec2f) -> vec2f {
    return (share * (nodes - 1.0) + 0.5) / nodes;
}

// Whether a pixel is water. Water ends at its last node: the nodes at the shore have higher
// neighbours, so they are not water themselves.
fn is_water(plan_in_tile: vec2f) -> bool {
    if tile_textures.plan.w == 0.0 {
        return false;
    }
    let at = place_among_nodes(share_of_tile(plan_in_tile), vec2f(textureDimensions(water)));
    return textureSampleLevel(water, tile_sampler, at, 0.0).x > 0.1;
}

// The slopes at a position, from the ancestor `levels` above the tile.
fn slopes_above(share: vec2f, levels: u32) -> vec2f {
    let tiles = 1u << levels;
    let corner = vec2f(vec2u(tile_textures.levels.xy) % tiles);
    let at = place_among_nodes((corner + share) / f32(tiles), vec2f(textureDimensions(slopes)));
    switch levels {
        case 0u: { return textureSampleLevel(slopes, tile_sampler, at, 0.0).xy; }
        case 1u: { return textureSampleLevel(slopes_1_above, tile_sampler, at, 0.0).xy; }
        case 2u: { return textureSampleLevel(slopes_2_above, tile_sampler, at, 0.0).xy; }
        default: { return textureSampleLevel(slopes_3_above, tile_sampler, at, 0.0).xy; }
    }
}

// The slopes for pixels of this size, in metres.
fn blended_slopes(plan_in_tile: vec2f, pixel_m: f32) -> vec2f {
    let share = share_of_tile(plan_in_tile);
    // 0 where the tile's own cells have their maximum size on the picture, 1 where its parent's
    // cells have it.
    let above = log2(colors.wall.w * pixel_m) - tile_textures.levels.w;
    let shown = clamp(above, 0.0, tile_textures.levels.z);
    let finer = floor(shown);
    let faded = (shown - finer - (1.0 - FADE)) / FADE;
    let rise = slopes_above(share, u32(finer));
    if faded <= 0.0 {
        return rise;
    }
    return mix(rise, slopes_above(share, u32(finer) + 1u), faded);
}

// `vertex_normal` is the normal of the exaggerated ground, of any length; `plan_in_tile` is in
// metres from the tile's middle; `distance_m` is the distance from the eye.
fn ground_normal(vertex_normal: vec3f, plan_in_tile: vec2f, distance_m: f32) -> vec3f {
    if tile_textures.plan.z == 0.0 {
        return normalize(vertex_normal);
    }
    let rise = blended_slopes(plan_in_tile, pixel_m_at(distance_m)) * frame.scale.y;
    return normalize(vec3(-rise, 1.0));
}
