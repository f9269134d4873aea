// Computes the mean of the samples of a pixel, rounded to the nearest of the 256 steps of a colour.
// The computation uses whole numbers, so that the result is the same on every adapter.

@group(0) @binding(0) var samples: texture_2d<f32>;

// Samples on each side of a pixel.
override PER_SIDE: u32 = 2u;

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let first = vec2u(position.xy) * PER_SIDE;
    let count = PER_SIDE * PER_SIDE;
    var sum = vec4(count / 2u);
    for (var y = 0u; y < PER_SIDE; y++) {
        for (var x = 0u; x < PER_SIDE; x++) {
            sum += vec4u(round(textureLoad(samples, first + vec2(x, y), 0) * 255.0));
        }
    }
    return vec4f(sum / count) / 255.0;
}
