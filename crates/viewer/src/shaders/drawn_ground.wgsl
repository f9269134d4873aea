// The ground from the terrain pass: the depth at each pixel, and its owner.

@group(2) @binding(0) var terrain_depth: texture_2d<f32>;
@group(2) @binding(1) var owners: texture_2d<u32>;

// These bits of an owner mark pixels of skirts, and of the wall along the edge of the data, which
// also has the bit of skirts.
const SKIRT = 0x80000000u;
const WALL = 0x40000000u;
