// The unit normal of the ground at a pixel: from the tile's relief, whatever its triangles, or from their vertices.
// Texel (column, row) of the slopes is node (column, row) of the tile, row 0 in the north. So both sides of a border read the
// same two nodes between the same texels, and shading goes on without a step.

struct TileTextures {
    // xy: 1 / the tile's sides east and north; z: 1 where there are slopes, else 0; w: the same for water.
    plan: vec4<f32>,
    // x: 1 where there is a photo, else 0; y: texels of its border on each side.
    photo: vec4<f32>,
}

@group(3) @binding(0) var<uniform> tile_textures: TileTextures;
@group(3) @binding(1) var tile_sampler: sampler;
// Rise in metres per metre east and north.
@group(3) @binding(2) var slopes: texture_2d<f32>;
// 1 where a node is water.
@group(3) @binding(5) var water: texture_2d<f32>;

// Where a place is in a texture of nodes: node 0 is in the middle of the first texel, the last node in the middle of the last.
fn place_among_nodes(plan_in_tile: vec2<f32>, nodes: vec2<f32>) -> vec2<f32> {
    let share = vec2(0.5, 0.5) + vec2(1.0, -1.0) * plan_in_tile * tile_textures.plan.xy;
    return (share * (nodes - 1.0) + 0.5) / nodes;
}

// Whether a pixel is water. Water ends where its last node is: the nodes at the shore have neighbours that lie higher, so they
// are none themselves.
fn is_water(plan_in_tile: vec2<f32>) -> bool {
    if tile_textures.plan.w == 0.0 {
        return false;
    }
    let at = place_among_nodes(plan_in_tile, vec2<f32>(textureDimensions(water)));
    return textureSampleLevel(water, tile_sampler, at, 0.0).x > 0.1;
}

// `vertex_normal` is that of the stretched ground, of any length; `plan_in_tile` is in metres from the tile's middle.
fn ground_normal(vertex_normal: vec3<f32>, plan_in_tile: vec2<f32>) -> vec3<f32> {
    if tile_textures.plan.z == 0.0 {
        return normalize(vertex_normal);
    }
    let at = place_among_nodes(plan_in_tile, vec2<f32>(textureDimensions(slopes)));
    let rise = textureSampleLevel(slopes, tile_sampler, at, 0.0).xy * frame.scale.y;
    return normalize(vec3(-rise, 1.0));
}
