// The photo of a tile: a square of texels from the north-west, with a border on every side, which are those of the
// neighbours. So neighbours show the same colour along their border, in each of the texture's sizes.

@group(3) @binding(3) var photo: texture_2d<f32>;
@group(3) @binding(4) var photo_sampler: sampler;

// rgb: the photo's colour; a: 1 where there is a photo, 0 where there is none. `plan_in_tile` is in metres from the tile's
// middle. For fragment stages, and not inside a branch.
fn photo_at(plan_in_tile: vec2<f32>) -> vec4<f32> {
    // The same for all pixels of a tile, so they may sample here. Without this, ground without photos took three times as long
    // on the CPU: one anisotropic sample may read sixteen places.
    if tile_textures.photo.x == 0.0 {
        return vec4(0.0);
    }
    let side = f32(textureDimensions(photo).x);
    let share = vec2(0.5, 0.5) + vec2(1.0, -1.0) * plan_in_tile * tile_textures.plan.xy;
    let border = tile_textures.photo.y;
    let texel = share * (side - 2.0 * border) + border;
    return textureSample(photo, photo_sampler, texel / side);
}
