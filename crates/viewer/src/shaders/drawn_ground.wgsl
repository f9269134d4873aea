// The ground of a tile as the terrain pass drew it: what was seen at each pixel, and whose it is.

struct Tile {
    // xyz: the tile's reference point minus the eye; w: depth of the skirt, world metres.
    offset: vec4<f32>,
    // x: true height of the reference point; y: widest half width that may be drawn, world metres; z: the tile's
    // number in this frame, from 1; w: within how many world metres near heights hold.
    base: vec4<f32>,
}

@group(1) @binding(0) var<uniform> tile: Tile;
@group(2) @binding(0) var terrain_depth: texture_2d<f32>;
@group(2) @binding(1) var owners: texture_2d<u32>;

// These bits of an owner say that the pixel shows a skirt, and the wall along the edge of the data, which has the bit of skirts too.
const SKIRT = 0x80000000u;
const WALL = 0x40000000u;
