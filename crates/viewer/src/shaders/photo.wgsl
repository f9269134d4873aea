// The photo of a tile: a square of texels from the north-west, with PHOTO_BORDER more on every side, which are those of the
// neighbours. So neighbours show the same colour along their border, in each of the texture's sizes.

@group(3) @binding(0) var photo: texture_2d<f32>;
@group(3) @binding(1) var photo_sampler: sampler;

const PHOTO_BORDER = 8.0;

// rgb: the photo's colour; a: 1 where there is a photo, 0 where there is none. `in_tile` is relative to the tile's middle, `sides`
// are the tile's, both in metres. For fragment stages, and not inside a branch.
fn photo_at(in_tile: vec2<f32>, sides: vec2<f32>) -> vec4<f32> {
    let side = f32(textureDimensions(photo).x);
    let share = vec2(0.5 + in_tile.x / sides.x, 0.5 - in_tile.y / sides.y);
    let texel = share * (side - 2.0 * PHOTO_BORDER) + PHOTO_BORDER;
    return textureSample(photo, photo_sampler, texel / side);
}
