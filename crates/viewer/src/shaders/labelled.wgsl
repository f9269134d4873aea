// Inputs of shaders that turn labels into colours: the labels, the blocks that have labels, and the
// depth of the ground.

@group(1) @binding(0) var terrain_depth: texture_2d<f32>;
@group(1) @binding(1) var road_labels: texture_2d<f32>;
@group(1) @binding(2) var road_blocks: texture_2d<f32>;

// Pixels on each side of a block.
override BLOCK: u32 = 16u;

// Converts a value of the target to a label.
fn label_of(stored: f32) -> u32 {
    return u32(round(stored * 255.0));
}

fn is_tunnel(label: u32) -> bool {
    return label < SERVICE_LABELS;
}

fn look_of(label: u32) -> u32 {
    return select(select(PLAIN, SERVICE, label < ROAD_LABELS), TUNNEL, is_tunnel(label));
}

// Where two roads meet, the one of the higher rank has the edge: tunnels have 1 to 9, service roads
// 10 to 18, other roads 19 to 27. 0 means no road.
fn rank_of(label: u32) -> u32 {
    switch look_of(label) {
        case TUNNEL: { return label / 2u; }
        case SERVICE: { return label - SERVICE_LABELS + CLASSES; }
        default: { return label / BANDS - 1u + 2u * CLASSES; }
    }
}

fn class_of(label: u32) -> u32 {
    return (3u * CLASSES - rank_of(label)) % CLASSES;
}

// Two triangles for each block, row by row; the triangles of a block without roads have no area.
@vertex
fn block_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let number = index / 6u;
    let columns = textureDimensions(road_blocks).x;
    let block = vec2(number % columns, number / columns);
    let has_roads = textureLoad(road_blocks, block, 0).r > 0.0;
    //   0 ── 1    3
    //   │  ╱    ╱ │
    //   2    4 ── 5
    let in_block = index % 6u;
    let corner = select(in_block, in_block - 2u, in_block > 2u);
    let side = select(vec2(0u), vec2(corner & 1u, corner >> 1u), has_roads);
    // The last blocks may extend beyond the edge of the picture, where nothing is drawn.
    return vec4(in_clip_space(vec2f((block + side) * BLOCK)), 0.0, 1.0);
}

// The share of a colour that haze hides on the way from the eye.
fn haze_at(distance_m: f32) -> f32 {
    return haze_share(distance_m, colors.haze.w);
}
