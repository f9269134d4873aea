// The photo of a tile: a square of texels starting in the north-west, with a border on every side
// that contains the texels of the neighbours. So neighbours show the same colour along their
// border, in each mip level.

@group(3) @binding(3) var photo: texture_2d<f32>;
@group(3) @binding(4) var photo_sampler: sampler;

// rgb: the photo's colour; a: 1 with a photo, 0 without. `plan_in_tile` is in metres from the
// tile's middle. For fragment stages only, and not inside a branch.
fn photo_at(plan_in_tile: vec2f) -> vec4f {
    // The condition is the same for all pixels of a tile, so they may sample here. Without it,
    // ground without photos took three times as long on the CPU: one anisotropic sample may read
    // sixteen texels.
    if tile_textures.photo.x == 0.0 {
        return vec4(0.0);
    }
    let side = f32(textureDimensions(photo).x);
    let border = tile_textures.photo.y;
    let texel = share_of_tile(plan_in_tile) * (side - 2.0 * border) + border;
    return textureSample(photo, photo_sampler, texel / side);
}
