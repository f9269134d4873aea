// The look of the ground: its colour by height, and the light on it.
//
// The rules are those of Imhof, Cartographic Relief Presentation (1965; English edition 1982),
// chapters 9, 10 and 13; the formulas are ours. Colours are mixed as they are stored, in sRGB: the
// picture is a map and not a photograph.

const TINT_STOPS = 12u;

// The same fields as in gpu/drawables/terrain.rs, in the same order.
struct GroundColors {
    // xyz: towards the light; w: strength of the hillshade.
    light: vec4f,
    // xyz: towards the second light; w: how much darker steep slopes are.
    second_light: vec4f,
    // x: lowest ground; y: 1 / height range; z: how many times steeper the gentlest slopes are
    // shaded; w: number of stops.
    heights: vec4f,
    // rgb; w: how strongly far valleys take the haze's colour.
    haze: vec4f,
    // rgb; w: 1 / distance at which a valley has two thirds of its haze.
    shadow: vec4f,
    // rgb; w: height of the wall along the edge of the data, world metres.
    sunlit: vec4f,
    // rgb; w: how strongly photos are visible.
    water: vec4f,
    // rgb; w: maximum size of a cell of the relief on the picture, pixels.
    wall: vec4f,
    // rgb; w: height, metres.
    tint: array<vec4f, TINT_STOPS>,
}

@group(2) @binding(0) var<uniform> colors: GroundColors;

// Slopes gentler than this are shaded as if they were steeper; tangent of the angle.
const GENTLE_SLOPE = 0.12;

// Colour of the ground at a true height: the mix of its two adjacent stops. Mixing all stops in
// turn gives the same colour, but took a tenth of the time of a picture on software Vulkan.
fn tint_at(height_m: f32) -> vec3f {
    let last = u32(colors.heights.w) - 1u;
    var k = min(1u, last);
    while k < last && height_m > colors.tint[k].w {
        k++;
    }
    let above = colors.tint[k];
    let below = colors.tint[max(k, 1u) - 1u];
    let t = clamp((height_m - below.w) / max(above.w - below.w, 1e-30), 0.0, 1.0);
    return mix(below.rgb, above.rgb, t);
}

// Light on a slope from one direction: 1 on level ground, less on slopes turned away, below 0
// beyond a right angle.
fn light_from(towards: vec3f, normal: vec3f) -> f32 {
    return dot(normal, towards) / max(towards.z, 0.17);
}

// The light on a slope: 1 on level ground.
//
// A slope that runs parallel to the light is neither lit nor in shadow, so its form would be lost.
// There the second light, from farther left, takes over. (Mark, Multidirectional, oblique-weighted,
// shaded-relief image of the Island of Hawaii, 1992, weights several lights by the aspect in the
// same way.)
fn light_on(normal: vec3f) -> f32 {
    let across = cross(vec3(colors.light.xy, 0.0), vec3(normal.xy, 0.0)).z;
    let along = length(colors.light.xy) * length(normal.xy);
    let turned = select(0.0, across * across / max(along * along, 1e-12), along > 0.0);
    let first = light_from(colors.light.xyz, normal);
    return mix(first, light_from(colors.second_light.xyz, normal), 0.6 * turned);
}

// Light on a slope from the direction of the first light, turned by 60° to the side from which the
// slope gets less.
fn light_from_the_side(normal: vec3f) -> f32 {
    let across = length(colors.light.xy);
    let level = colors.light.xy / max(across, 1e-6);
    let along = dot(level, normal.xy);
    let beside = abs(level.x * normal.y - level.y * normal.x);
    return normal.z + (0.5 * along - 0.866 * beside) * across / max(colors.light.z, 0.17);
}

// Darkening for slopes that face the light, so that they keep their form: without it all of them
// are nearly equally bright, whatever their steepness. A ridge that runs up to the light has two
// sides; the side light shades the side that is turned away from it, and the steep parts of both.
// The value is 0 on level ground and on slopes that the light misses, and has no step anywhere.
fn lacking_in_light(normal: vec3f) -> f32 {
    let lacking = max(1.0 - light_from_the_side(normal), 0.0);
    let faces = smoothstep(0.0, 0.3, light_from(colors.light.xyz, normal) - 1.0);
    return 1.2 * faces * lacking * lacking / (lacking + 0.2);
}

// Shades a colour with a strength. `normal` is the unit normal of the drawn ground, exaggeration
// included.
fn shaded(color: vec3f, normal: vec3f, strength: f32) -> vec3f {
    // Gentle ground is shaded as if it were steeper; steep ground is shaded as it is.
    let slope = length(normal.xy) / max(normal.z, 1e-3);
    let s2 = GENTLE_SLOPE * GENTLE_SLOPE;
    let steeper = 1.0 + (colors.heights.z - 1.0) * s2 / (s2 + slope * slope);
    let seen = normalize(vec3(normal.xy * steeper, normal.z));
    let light = light_on(seen);
    // Shadow grows more and more slowly and is never full, so that shadow sides keep their form.
    let lacking = max(1.0 - light, 0.0) + lacking_in_light(seen);
    let steep = strength * colors.second_light.w * (1.0 - seen.z);
    let dark = strength * colors.light.w * (1.0 - exp(-1.15 * lacking));
    let bright = strength * colors.light.w * 0.75 * (1.0 - exp(-1.6 * max(light - 1.0, 0.0)));
    let in_shadow = mix(color, color * colors.shadow.rgb, dark) * (1.0 - steep);
    return mix(in_shadow, colors.sunlit.rgb, bright * (1.0 - steep));
}

// Tints far valleys with the haze, so that the heights stand out.
fn hazy(color: vec3f, height_m: f32, distance_m: f32) -> vec3f {
    let share = clamp((height_m - colors.heights.x) * colors.heights.y, 0.0, 1.0);
    let near = exp(-distance_m * colors.shadow.w);
    return mix(color, colors.haze.rgb, colors.haze.w * exp(-4.0 * share) * (1.0 - near));
}
