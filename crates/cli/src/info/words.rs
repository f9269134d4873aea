//! The words that `info` uses, explained where they are used.

use std::fmt::Write as _;

/// Words in the order in which they come, and what they mean. More is told of some at the address that [`words_of`] gives.
const WORDS: [(&str, &str); 30] = [
    ("CRS", "coordinate reference system: what coordinates mean"),
    ("working metres", "the coordinates of the package, close to true metres"),
    ("cell", "the rectangle between four neighbouring heights of a level; its sides in metres"),
    ("quantum", "heights are stored as multiples of it"),
    ("datum", "what heights are measured from"),
    ("nodes", "points of the grid of heights"),
    ("filled", "nodes in gaps of the data, whose heights come from around them"),
    ("void", "nodes without data, where the ground is open"),
    ("sha256", "a hash, by which the content of a file is known"),
    (
        "level",
        "one resolution of the ground; 0 is the coarsest, each further one has half its cell",
    ),
    ("tolerance", "how far the triangles of a level may be from the level's own heights"),
    ("terrain", "bytes of the triangles"),
    ("relief", "bytes of the heights that are kept for shading"),
    ("roads to FRC", "the last class of roads that the level shows"),
    ("uncovered", "nodes with data beneath no triangle, beside voids and at the edge of the data"),
    (
        "error",
        "how far a tile's triangles are from the finest heights, the worst tile of the level",
    ),
    ("median", "half of the tiles have no larger error"),
    ("p95", "95 of 100 have no larger one"),
    ("p99", "99 of 100 have no larger one"),
    (
        "stored/true",
        "the error that a tile stores, which is never too small, over the measured one",
    ),
    ("TIN", "the triangles of a level"),
    ("off TIN", "samples beneath no triangle, as for uncovered"),
    ("RMS", "root mean square, a mean that large values count more in"),
    ("texel", "a pixel of a photo on the ground"),
    ("parts", "pieces of lines, cut at the borders of tiles"),
    ("runs", "stretches of roads off the ground in one tile"),
    ("FRC", "functional road class, the importance of a road: 0 (motorway) to 8"),
    ("blobs", "the pieces that an extract consists of"),
    ("defect", "something wrong in the extract; build --defects lists each"),
    ("extract", "a file of OpenStreetMap data"),
];

/// The words that a text uses, with their meanings, and where there are more.
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
        "More of them: {}/blob/main/docs/conventions.md#terms",
        env!("CARGO_PKG_REPOSITORY")
    );
    words
}

/// Whether a text has a word, not as a part of another one.
fn uses(text: &str, word: &str) -> bool {
    let is_apart = |neighbour: Option<char>| !neighbour.is_some_and(char::is_alphanumeric);
    text.match_indices(word).any(|(at, _)| {
        is_apart(text[..at].chars().next_back()) && is_apart(text[at + word.len()..].chars().next())
    })
}

#[cfg(test)]
#[path = "words_tests.rs"]
mod tests;
