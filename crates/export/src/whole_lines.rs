//! Reconstructs lines in plan from overlapping parts: each tile has the segments that come near it,
//! whole.

use std::collections::BTreeMap;

use corniche_geom::LatticePoint;

use crate::join::Following;

type Segment = [LatticePoint; 2];

/// Returns the lines of a way, each of its segments once, from the parts in tiles.
///
/// ```text
///   tile A   a────b────c────d
///   tile B             c────d────e          one line: a b c d e
///   tile C        b────c                    c f g, where f is on no tile: one line up to f, and one from f,
///                                           which are joined
/// ```
///
/// Segments follow each other in the order of the parts, so a line that touches itself continues as
/// the way does. Lines that then end where another one begins are joined. A segment that is
/// repeated in the same direction occurs once.
pub(crate) fn whole_lines<'a>(
    parts: &(impl Iterator<Item = &'a [LatticePoint]> + Clone),
) -> Vec<Vec<LatticePoint>> {
    let segments = || parts.clone().flat_map(|points| points.array_windows::<2>()).copied();
    let mut known: Vec<Segment> = segments().collect();
    known.sort_unstable();
    known.dedup();
    let number_of = |segment: &Segment| known.binary_search(segment).ok();
    let mut following = Following::among(known.len());
    for &[a, b, c] in parts.clone().flat_map(|points| points.array_windows::<3>()) {
        if let (Some(one), Some(other)) = (number_of(&[a, b]), number_of(&[b, c]))
            && following.next[one].is_none()
            && !following.has_before[other]
        {
            following.join(one, other);
        }
    }
    let chains = following.chains(segments().filter_map(|segment| number_of(&segment)));
    let line = |chain: &Vec<usize>| {
        let ends = chain.iter().map(|&number| known[number][1]);
        std::iter::once(known[chain[0]][0]).chain(ends).collect()
    };
    join_ends(&chains.iter().map(line).collect::<Vec<_>>())
}

/// Joins lines that end where others begin; rings are complete.
fn join_ends(lines: &[Vec<LatticePoint>]) -> Vec<Vec<LatticePoint>> {
    let mut beginnings: BTreeMap<LatticePoint, Vec<usize>> = BTreeMap::new();
    let is_open = |line: &[LatticePoint]| line.first() != line.last();
    for (number, line) in lines.iter().enumerate().rev().filter(|(_, line)| is_open(line)) {
        beginnings.entry(line[0]).or_default().push(number);
    }
    let mut following = Following::among(lines.len());
    for (number, line) in lines.iter().enumerate().filter(|(_, line)| is_open(line)) {
        let at_end = line.last().and_then(|end| beginnings.get_mut(end));
        if let Some(other) = at_end.and_then(Vec::pop) {
            following.join(number, other);
        }
    }
    let joined = |chain: &Vec<usize>| {
        let mut line = lines[chain[0]].clone();
        for &number in &chain[1..] {
            line.extend(&lines[number][1..]);
        }
        line
    };
    following.chains(0..lines.len()).iter().map(joined).collect()
}

#[cfg(test)]
#[path = "whole_lines_tests.rs"]
mod tests;
