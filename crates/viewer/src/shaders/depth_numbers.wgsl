// Writes depths as ordinary numbers, sample by sample.

@group(0) @binding(0) var depths: texture_2d<f32>;

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4(textureLoad(depths, vec2u(position.xy), 0).r, 0.0, 0.0, 1.0);
}
