// The ground of a tile as the terrain pass drew it: what was seen at each pixel, and whose it is.

@group(2) @binding(0) var terrain_depth: texture_2d<f32>;
@group(2) @binding(1) var owners: texture_2d<u32>;

// These bits of an owner say that the pixel shows a skirt, and the wall along the edge of the data, which has the bit of skirts too.
const SKIRT = 0x80000000u;
const WALL = 0x40000000u;
