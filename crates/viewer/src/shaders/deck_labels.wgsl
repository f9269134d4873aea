// The labels of decks, in addition to the labels of roads, and which decks are equally high: for
// the passes that draw labels and for their colours.

// Decks whose heights differ by less, true metres, count as equally high.
const SAME_HEIGHT_M = 0.25;
// The labels of sides and undersides.
const SIDE_LABEL = 1u;
const UNDERSIDE_LABEL = 2u;
