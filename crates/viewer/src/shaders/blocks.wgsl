// Finds the blocks of the picture that have roads. The result for a block is the largest label in
// it and around it, as far as an outline may reach. The composite draws roads only in blocks with a
// label.

@group(1) @binding(0) var road_labels: texture_2d<f32>;

// Pixels on each side of a block.
override BLOCK: i32 = 16;

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) f32 {
    // The edges of bridges extend farthest.
    let radius = i32(ceil(1.5 * frame.road_scale.z));
    let last = last_pixel();
    let corner = vec2i(position.xy) * BLOCK;
    let first = max(corner - radius, vec2(0));
    let end = min(corner + (BLOCK - 1 + radius), last);
    var largest = 0.0;
    for (var y = first.y; y <= end.y; y++) {
        for (var x = first.x; x <= end.x; x++) {
            largest = max(largest, textureLoad(road_labels, vec2(x, y), 0).r);
        }
    }
    return largest;
}
