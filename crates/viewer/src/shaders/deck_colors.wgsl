// Draws the labels of bridge decks as colours over the picture of ground and roads, block by block.
// An edge around the upper of two decks, or around a deck over the ground, shows which one is
// above, even if the height difference between them is less than a pixel.

@group(1) @binding(4) var deck_depth: texture_2d<f32>;
// The labels of roads on the ground.
@group(1) @binding(5) var ground_labels: texture_2d<f32>;

// Within a pixel, a road rises or falls by at most this share of the pixel's side; ground that is
// painted as a part of a deck may be steeper (`STEEPEST_GROUND`).
const STEEPEST = 0.08;
// A road of the same class may be the same deck, which rises along its way by at most this slope.
const STEEPEST_ALONG = 0.15;
const STEEPEST_GROUND = 1.5;
// A deck over a road of its own class must be this many times higher than elsewhere to have an
// edge.
const BESIDE_A_BEGINNING = 4.0;
// Bridges have wider edges than roads on the ground.
const WIDER_EDGE = 1.5;
// Brightness of the underside relative to the slab's colour.
const IN_SHADE = 0.7;

// The visible depth at a pixel: of a deck, otherwise of the ground.
fn depth_at(pixel: vec2i) -> f32 {
    return max(textureLoad(terrain_depth, pixel, 0).r, textureLoad(deck_depth, pixel, 0).r);
}

// Whether the visible deck at a pixel is painted on the ground.
fn is_painted(pixel: vec2i) -> bool {
    return textureLoad(deck_depth, pixel, 0).r <= textureLoad(terrain_depth, pixel, 0).r * (1.0 + 4e-6);
}

fn is_slab(label: u32) -> bool {
    return label <= UNDERSIDE_LABEL;
}

// The label of a road that has its edge at a pixel, and the share of that edge that is drawn.
struct Edge {
    label: u32,
    share: f32,
}

// The edge of the most important road around a pixel: of a deck that is higher than the visible
// surface at the pixel, or as high if that surface is not a road. Where one deck rises above
// another, its edge fades in.
fn edge_at(pixel: vec2i, own: u32, sight: Sight) -> Edge {
    // Where a deck begins, the road continues on the ground.
    let road = select(own, label_of(textureLoad(ground_labels, pixel, 0).r), own == 0u);
    let is_bare = own == 0u && road == 0u;
    let radius = i32(ceil(WIDER_EDGE * frame.road_scale.z));
    let last = last_pixel();
    let place = position_at(vec2f(pixel) + 0.5, sight.depth_buffer);
    let pixel_m = pixel_m_at(sight.distance_m);
    let own_is_painted = own != 0u && is_painted(pixel);
    var most = Edge(0u, 0.0);
    for (var y = -radius; y <= radius; y++) {
        for (var x = -radius; x <= radius; x++) {
            let near = clamp(pixel + vec2(x, y), vec2(0), last);
            let label = label_of(textureLoad(road_labels, near, 0).r);
            if is_slab(label) || rank_of(label) < rank_of(most.label) {
                continue;
            }
            let depth_buffer = depth_at(near);
            // A deck behind a crest has no edge on the crest.
            if !is_from_above() && depth_buffer < sight.depth_buffer / FARTHER {
                continue;
            }
            let rises = select(STEEPEST, STEEPEST_GROUND * f32(radius) * frame.scale.y, own_is_painted || is_painted(near));
            let there = position_at(vec2f(near) + 0.5, depth_buffer);
            let is_alike = own != 0u && class_of(label) == class_of(own);
            let along_m = select(0.0, STEEPEST_ALONG * frame.scale.y * distance(place.xy, there.xy), is_alike);
            let same_m = SAME_HEIGHT_M * frame.scale.y + rises * pixel_m + along_m;
            let above_m = there.z - place.z;
            // Roads that meet have no edge between them, as on the ground.
            let is_free = is_bare || (above_m >= -same_m && own != 0u && is_slab(own));
            // Next to the middle of a road, the ground may be lower than a deck that begins there.
            let least_m = same_m * select(1.0, BESIDE_A_BEGINNING, own == 0u && class_of(road) == class_of(label));
            let share = select(smoothstep(least_m, 1.5 * least_m, above_m), 1.0, is_free);
            if share > 0.0 && (share > most.share || rank_of(label) > rank_of(most.label)) {
                most = Edge(label, share);
            }
        }
    }
    return most;
}

// The result is premultiplied.
@fragment
fn deck_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position.xy);
    let sight = sight_of(position.xy, depth_at(min(pixel, last_pixel())));
    let facing = facing_of(position.xy, sight);
    // The sky has neither a deck nor its edge.
    if sight.depth_buffer == 0.0 {
        discard;
    }
    let label = label_of(textureLoad(road_labels, pixel, 0).r);
    let most = edge_at(pixel, label, sight);
    if label == 0u && most.label == 0u {
        discard;
    }
    var fill = vec4(0.0);
    if label != 0u && is_slab(label) {
        let slab = colors.slab.rgb * select(1.0, IN_SHADE, label == UNDERSIDE_LABEL);
        fill = vec4(mix(slab, colors.haze.rgb, sight.haze), 1.0);
    } else if label != 0u {
        fill = fill_of(label, sight);
    }
    var edge = vec4(0.0);
    if most.label != 0u {
        edge = edge_of(most.label, sight, facing) * vec4(1.0, 1.0, 1.0, most.share);
    }
    return vec4(fill.rgb * fill.a * (1.0 - edge.a) + edge.rgb * edge.a, 1.0 - (1.0 - fill.a) * (1.0 - edge.a));
}
