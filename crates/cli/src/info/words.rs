//! The glossary of the words that `info` prints.

use std::fmt::Write as _;

/// The words in their order in the text, and their meanings. The page whose address [`words_of`]
/// prints explains some in more detail.
const WORDS: [(&str, &str); 30] = [
    ("CRS", "coordinate reference system: the meaning of coordinates"),
    ("working metres", "the coordinates of the package, close to true metres"),
    (
        "cell",
        "the rectangle between four neighbouring nodes of a level; in tables, its sides in metres",
    ),
    ("quantum", "the step in which heights are stored"),
    ("datum", "the surface that heights are measured from"),
    ("nodes", "points of the height grid"),
    ("filled", "nodes in gaps of the data, with heights interpolated from around them"),
    ("void", "nodes without data (nodata), where the terrain has holes"),
    ("sha256", "a hash, which identifies the content of a file"),
    (
        "level",
        "a resolution of the terrain, like a zoom; 0 is the coarsest, and each level halves the cell",
    ),
    (
        "tolerance",
        "the allowed distance of a level's triangles from the nodes of the level's own grid",
    ),
    ("terrain", "bytes of the triangles"),
    ("relief", "bytes of the height rasters for shading"),
    ("roads to FRC", "the least important class of roads that the level shows"),
    (
        "uncovered",
        "with a height, but without a triangle: next to voids and at the edge of the data",
    ),
    (
        "error",
        "largest distance between triangles and nodes of the finest level; of the worst tile",
    ),
    ("median", "half of the tiles have a smaller or equal error"),
    ("p95", "95 % of the tiles have a smaller or equal value"),
    ("p99", "99 % of the samples have a smaller or equal error"),
    ("stored/true", "the stored error of a tile (never too small), divided by the measured error"),
    ("samples", "the heights in the DEM's files; filled nodes are not samples"),
    ("RMS", "root mean square"),
    ("texel", "a pixel of a photo on the ground"),
    ("parts", "objects of a layer, or pieces of them, in or near a tile"),
    ("spans", "bridges or tunnels: all connected ways, between the points on the ground"),
    ("runs", "stretches of spans off the ground in one tile"),
    ("FRC", "functional road class, the importance of a road: 0 (motorway) to 8"),
    ("blobs", "the blocks of an .osm.pbf file"),
    ("defect", "an error in the extract; build --defects lists each of them"),
    ("extract", "a file of OpenStreetMap data"),
];

/// The glossary of the words that a text uses, with the address of the full one.
pub(crate) fn words_of(text: &str) -> String {
    let all = WORDS.into_iter().chain(corniche_spec::span_reasons());
    let used: Vec<_> = all.filter(|(word, _)| uses(text, word)).collect();
    let width = used.iter().map(|(word, _)| word.len()).max().unwrap_or_default();
    let mut words = "\nWords:\n".to_owned();
    for (word, meaning) in used {
        let _ = writeln!(words, "  {word:<width$}  {meaning}");
    }
    let _ = writeln!(
        words,
        "Full glossary: {}/blob/main/docs/conventions.md#terms",
        env!("CARGO_PKG_REPOSITORY")
    );
    words
}

/// Whether a text contains a word, not as a part of another.
fn uses(text: &str, word: &str) -> bool {
    let is_apart = |neighbour: Option<char>| !neighbour.is_some_and(char::is_alphanumeric);
    text.match_indices(word).any(|(at, _)| {
        is_apart(text[..at].chars().next_back()) && is_apart(text[at + word.len()..].chars().next())
    })
}

#[cfg(test)]
#[path = "words_tests.rs"]
mod tests;
