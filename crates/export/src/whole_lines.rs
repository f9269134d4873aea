//! Lines in plan out of parts that overlap: each tile has the segments that come near it, whole.

use std::collections::BTreeMap;

use corniche_geom::LatticePoint;

type Segment = [LatticePoint; 2];

/// The lines of a way, each of its segments once, from the parts that tiles have of it.
///
/// ```text
///   tile A   a────b────c────d
///   tile B             c────d────e          one line: a b c d e
///   tile C        b────c                    c f g, where f lies on no tile: a line of its own up to f, and one from there,
///                                           which are joined
/// ```
///
/// Segments follow each other as they do in a part. So a line that touches itself goes on as the way does. Lines that then end where another one begins
/// are joined. What is once more in the same direction is there once.
pub(crate) fn whole_lines<'a>(
    parts: &(impl Iterator<Item = &'a [LatticePoint]> + Clone),
) -> Vec<Vec<LatticePoint>> {
    let segments = || parts.clone().flat_map(|points| points.array_windows::<2>()).copied();
    let mut known: Vec<Segment> = segments().collect();
    known.sort_unstable();
    known.dedup();
    let number_of = |segment: &Segment| known.binary_search(segment).ok();
    let mut next = vec![None; known.len()];
    let mut follows = vec![false; known.len()];
    for &[a, b, c] in parts.clone().flat_map(|points| points.array_windows::<3>()) {
        if let (Some(one), Some(other)) = (number_of(&[a, b]), number_of(&[b, c]))
            && next[one].is_none()
            && !follows[other]
        {
            next[one] = Some(other);
            follows[other] = true;
        }
    }
    // Lines with a beginning first; what is left are rings.
    let numbers = || segments().filter_map(|segment| number_of(&segment));
    let beginnings = numbers().filter(|&number| !follows[number]);
    let mut taken = vec![false; known.len()];
    let mut lines: Vec<Vec<LatticePoint>> = Vec::new();
    for beginning in beginnings.chain(numbers()) {
        let mut line = Vec::new();
        let mut at = Some(beginning);
        while let Some(number) = at.filter(|&number| !std::mem::replace(&mut taken[number], true)) {
            let [from, to] = known[number];
            if line.is_empty() {
                line.push(from);
            }
            line.push(to);
            at = next[number];
        }
        if !line.is_empty() {
            lines.push(line);
        }
    }
    join_ends(&lines)
}

/// Lines go on with others that begin where they end; rings are whole.
fn join_ends(lines: &[Vec<LatticePoint>]) -> Vec<Vec<LatticePoint>> {
    let mut beginnings: BTreeMap<LatticePoint, Vec<usize>> = BTreeMap::new();
    let is_open = |line: &[LatticePoint]| line.first() != line.last();
    for (number, line) in lines.iter().enumerate().rev().filter(|(_, line)| is_open(line)) {
        beginnings.entry(line[0]).or_default().push(number);
    }
    let mut next = vec![None; lines.len()];
    let mut follows = vec![false; lines.len()];
    for (number, line) in lines.iter().enumerate().filter(|(_, line)| is_open(line)) {
        let at_end = line.last().and_then(|end| beginnings.get_mut(end));
        next[number] = at_end.and_then(Vec::pop);
        if let Some(other) = next[number] {
            follows[other] = true;
        }
    }
    let mut joined = Vec::new();
    let mut taken = vec![false; lines.len()];
    let firsts = (0..lines.len()).filter(|&number| !follows[number]);
    for first in firsts.chain(0..lines.len()) {
        let mut line: Vec<LatticePoint> = Vec::new();
        let mut at = Some(first);
        while let Some(number) = at.filter(|&number| !std::mem::replace(&mut taken[number], true)) {
            line.extend(&lines[number][usize::from(!line.is_empty())..]);
            at = next[number];
        }
        if !line.is_empty() {
            joined.push(line);
        }
    }
    joined
}

#[cfg(test)]
#[path = "whole_lines_tests.rs"]
mod tests;
