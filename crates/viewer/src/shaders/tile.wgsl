// The uniforms of a drawn tile, filled in by gpu/uniforms.rs.

struct Tile {
    // xyz: the tile's reference point minus the eye; w: depth of the skirt, world metres.
    offset: vec4f,
    // x: true height of the reference point; y: maximum half width of drawn roads, world metres; z:
    // the tile's number in this frame, from 1; w: distance within which near heights apply, world
    // metres.
    base: vec4f,
}

@group(1) @binding(0) var<uniform> tile: Tile;
