// A box around what is drawn: its corners, in the order in which a strip of triangles goes around it.

// The corners of a box as one strip of twelve triangles, all counter-clockwise seen from outside:
// bit 0: end or start, bit 1: left or right, bit 2: top or bottom.
const STRIP = array<u32, 14>(0u, 1u, 4u, 5u, 7u, 1u, 3u, 0u, 2u, 4u, 6u, 7u, 2u, 3u);
