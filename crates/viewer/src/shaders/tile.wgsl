// The block of a tile that is drawn, as gpu/uniforms.rs fills it.

struct Tile {
    // xyz: the tile's reference point minus the eye; w: depth of the skirt, world metres.
    offset: vec4<f32>,
    // x: true height of the reference point; y: widest half width that may be drawn, world metres; z: the tile's
    // number in this frame, from 1; w: within how many world metres near heights hold.
    base: vec4<f32>,
}

@group(1) @binding(0) var<uniform> tile: Tile;
