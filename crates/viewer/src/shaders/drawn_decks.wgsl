// Inputs for decks of bridges: the ground from the terrain pass, the nearest deck at each pixel,
// and the roads on the ground.

@group(2) @binding(0) var terrain_depth: texture_2d<f32>;
// 0 without a deck. While depths of decks are drawn, this is the terrain's depth, and not read.
@group(2) @binding(1) var deck_depth: texture_2d<f32>;
@group(2) @binding(2) var ground_labels: texture_2d<f32>;
