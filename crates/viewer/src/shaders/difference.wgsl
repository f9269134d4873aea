// Shows where the roads of two drawings differ, over the picture of the first drawing in pale grey.

@group(0) @binding(0) var first_labels: texture_2d<f32>;
@group(0) @binding(1) var second_labels: texture_2d<f32>;
@group(0) @binding(2) var picture: texture_2d<f32>;

// The same numbers as DIFFERENCE_COLORS in gpu/drawables/difference.rs.
const FIRST_ONLY = vec3(213.0, 94.0, 0.0) / 255.0;
const SECOND_ONLY = vec3(0.0, 114.0, 178.0) / 255.0;
const OTHER_LABEL = vec3(204.0, 121.0, 167.0) / 255.0;

// Remaining share of the picture's contrast.
const CONTRAST = 0.35;

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position.xy);
    let first = textureLoad(first_labels, pixel, 0).r;
    let second = textureLoad(second_labels, pixel, 0).r;
    if first == second {
        // Luma as in ITU-R BT.601.
        let luma = dot(textureLoad(picture, pixel, 0).rgb, vec3(0.299, 0.587, 0.114));
        return vec4(vec3(mix(1.0, luma, CONTRAST)), 1.0);
    }
    if second == 0.0 {
        return vec4(FIRST_ONLY, 1.0);
    }
    return vec4(select(OTHER_LABEL, SECOND_ONLY, first == 0.0), 1.0);
}
