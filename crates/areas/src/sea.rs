//! The sea is made of coastlines: they are closed along the edge of a rectangle, and what is missing or wrong is reported.

use corniche_geom::{LatticeBounds, LatticePoint, cross};

use crate::{
    OutlineError, OutlineWay, Polygon, assemble,
    coastlines::{Chain, Coastline, cut, join},
    rectangle_edge::{
        along_edge, corner_places, corners, edge_distance, nearest_on_edge, perimeter,
        point_on_edge, squared_distance,
    },
};

/// More open ends than this are not looked at for one near by.
const MOST_OPEN_ENDS: usize = 4096;

/// The sea within a rectangle.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Sea {
    /// No two have inner points in common.
    pub polygons: Vec<Polygon>,
    /// Ways that end where no other begins, inside the rectangle. A straight line goes on to the nearest beginning or to the edge.
    pub bridged: Vec<i64>,
    /// Ways that say that there is sea where others say that there is land. They were left out.
    pub left_out: Vec<i64>,
}

/// Makes the sea of coastlines: what lies on their right. Along the edge of `bounds` it is closed clockwise, from where a coast leaves the
/// rectangle to where the next one enters it. A rectangle without any coast has no sea.
///
/// The rule that sea lies on the right is OSM's (wiki, "Tag:natural=coastline"). As in Jochen Topf's *osmcoastline*, open ends are joined
/// with the nearest open beginning.
///
/// # Errors
/// When coastlines cross between their points.
pub fn close_sea(coastlines: Vec<Coastline>, bounds: &LatticeBounds) -> Result<Sea, OutlineError> {
    let mut sea = Sea::default();
    let chains = bridge(join(coastlines), bounds, &mut sea.bridged);
    let mut rings = Vec::new();
    let mut parts = Vec::new();
    for chain in &chains {
        for part in cut(chain, bounds) {
            if part.is_ring() {
                rings.push(part);
            } else {
                parts.push(to_edge(part, bounds, &mut sea.bridged));
            }
        }
    }
    sea.bridged.sort_unstable();
    sea.bridged.dedup();
    let crossings = agreeing(crossings_of(&parts, bounds), &mut parts, &mut sea.left_out);
    sea.left_out.sort_unstable();
    sea.left_out.dedup();
    let mut lines: Vec<Vec<LatticePoint>> = edge_lines(&crossings, bounds);
    if crossings.is_empty() && is_surrounded_by_sea(&rings) {
        lines.push(closed(corners(bounds)));
    }
    lines.extend(parts.into_iter().chain(rings).map(|part| part.points));
    let ways: Vec<OutlineWay<'_>> = lines.iter().map(|points| OutlineWay { points }).collect();
    match assemble(&ways) {
        Ok(assembled) => sea.polygons = assembled.polygons,
        Err(OutlineError::Nothing) => {}
        Err(error) => return Err(error),
    }
    Ok(sea)
}

fn closed(mut points: Vec<LatticePoint>) -> Vec<LatticePoint> {
    points.extend(points.first().copied());
    points
}

/// Joins ends that lie inside with the nearest beginnings inside, where these are nearer than the edge.
fn bridge(chains: Vec<Chain>, bounds: &LatticeBounds, bridged: &mut Vec<i64>) -> Vec<Chain> {
    let inside =
        |point: Option<LatticePoint>| point.filter(|&point| edge_distance(point, bounds) > 0);
    let open = |chain: &&Chain| !chain.is_ring();
    let ends = || chains.iter().enumerate().filter(|(_, chain)| open(chain));
    let tails: Vec<(usize, LatticePoint)> =
        ends().filter_map(|(index, chain)| Some((index, inside(chain.last())?))).collect();
    let heads: Vec<(usize, LatticePoint)> =
        ends().filter_map(|(index, chain)| Some((index, inside(chain.first())?))).collect();
    if tails.len().max(heads.len()) > MOST_OPEN_ENDS {
        return chains;
    }
    let mut pairs: Vec<(i128, usize, usize)> = Vec::new();
    for &(tail, end) in &tails {
        for &(head, beginning) in &heads {
            let nearest_edge = edge_distance(end, bounds).min(edge_distance(beginning, bounds));
            let away = squared_distance(end, beginning);
            if away <= i128::from(nearest_edge).pow(2) {
                pairs.push((away, tail, head));
            }
        }
    }
    pairs.sort_unstable();
    let mut next: Vec<Option<usize>> = vec![None; chains.len()];
    let mut has_before = vec![false; chains.len()];
    for (_, tail, head) in pairs {
        if next[tail].is_none() && !has_before[head] {
            next[tail] = Some(head);
            has_before[head] = true;
            bridged.extend(chains[tail].ways.last());
            bridged.extend(chains[head].ways.first());
        }
    }
    follow(chains, &next, &has_before)
}

/// Joins chains as `next` says; those that nothing comes before first, then what is left, which are rings.
fn follow(chains: Vec<Chain>, next: &[Option<usize>], has_before: &[bool]) -> Vec<Chain> {
    let mut left: Vec<Option<Chain>> = chains.into_iter().map(Some).collect();
    let (first, others): (Vec<usize>, Vec<usize>) =
        (0..left.len()).partition(|&index| !has_before[index]);
    let mut joined = Vec::new();
    for index in first.into_iter().chain(others) {
        let Some(mut chain) = left[index].take() else { continue };
        let mut at = index;
        while let Some(following) = next[at] {
            let Some(following_chain) = left[following].take() else {
                // Round again.
                chain.first().into_iter().for_each(|first| chain.push(first));
                break;
            };
            chain.append(following_chain);
            at = following;
        }
        joined.push(chain);
    }
    joined
}

/// The same part with ends that lie inside brought to the edge by the shortest way.
fn to_edge(mut part: Chain, bounds: &LatticeBounds, bridged: &mut Vec<i64>) -> Chain {
    if let Some(last) = part.last().filter(|&last| edge_distance(last, bounds) > 0) {
        bridged.extend(part.ways.last());
        part.push(nearest_on_edge(last, bounds));
    }
    if let Some(first) = part.first().filter(|&first| edge_distance(first, bounds) > 0) {
        bridged.extend(part.ways.first());
        part.points.insert(0, nearest_on_edge(first, bounds));
        part.ways.extend_from_within(..1);
        part.ways.rotate_right(1);
    }
    part
}

/// Where a coast meets the edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Crossing {
    /// How far along the edge, clockwise from the north-western corner.
    along: i128,
    leaves: bool,
    part: usize,
}

fn crossings_of(parts: &[Chain], bounds: &LatticeBounds) -> Vec<Crossing> {
    let mut crossings = Vec::new();
    for (part, chain) in parts.iter().enumerate() {
        for (point, leaves) in [(chain.first(), false), (chain.last(), true)] {
            let along = point.map(|point| along_edge(point, bounds)).unwrap_or_default();
            crossings.push(Crossing { along, leaves, part });
        }
    }
    crossings.sort_unstable();
    crossings
}

/// Crossings in order, in turns in and out. Of two that contradict each other, the shorter part is left out.
fn agreeing(
    mut crossings: Vec<Crossing>,
    parts: &mut Vec<Chain>,
    left_out: &mut Vec<i64>,
) -> Vec<Crossing> {
    let mut is_out = vec![false; parts.len()];
    loop {
        in_turns_where_equal(&mut crossings);
        let count = crossings.len();
        let wrong = (0..count)
            .map(|index| [crossings[index], crossings[(index + 1) % count]])
            .find(|[crossing, next]| crossing.leaves == next.leaves);
        let Some(pair) = wrong else { break };
        let length = |crossing: &Crossing| (length_steps(&parts[crossing.part]), crossing.part);
        let [first, second] = [length(&pair[0]), length(&pair[1])];
        let (_, shorter) = if first.0 <= second.0 { first } else { second };
        is_out[shorter] = true;
        left_out.extend(&parts[shorter].ways);
        crossings.retain(|crossing| crossing.part != shorter);
    }
    // A part that is left out is no line of the outline, either.
    let mut is_out = is_out.into_iter();
    parts.retain(|_| !is_out.next().unwrap_or_default());
    crossings
}

/// Where crossings lie at the same place, the one that fits to what comes before is first.
fn in_turns_where_equal(crossings: &mut [Crossing]) {
    let count = crossings.len();
    for index in 1..count {
        if crossings[index].leaves != crossings[index - 1].leaves {
            continue;
        }
        let along = crossings[index].along;
        let other = (index + 1..count)
            .take_while(|&other| crossings[other].along == along)
            .find(|&other| crossings[other].leaves != crossings[index].leaves);
        if let Some(other) = other {
            crossings.swap(index, other);
        }
    }
    // The first has none before it but the last.
    if let [first, second, .., last] = crossings
        && first.along == second.along
        && first.leaves == last.leaves
        && first.leaves != second.leaves
    {
        std::mem::swap(first, second);
    }
}

fn length_steps(chain: &Chain) -> f64 {
    let steps = chain.points.windows(2).map(|pair| match pair {
        &[from, to] => from.distance_steps(to),
        _ => 0.0,
    });
    steps.sum()
}

/// The lines along the edge from where coasts leave to where the next one enters, clockwise.
fn edge_lines(crossings: &[Crossing], bounds: &LatticeBounds) -> Vec<Vec<LatticePoint>> {
    let (corners, places, around) = (corners(bounds), corner_places(bounds), perimeter(bounds));
    let mut lines = Vec::new();
    let count = crossings.len();
    for (index, crossing) in crossings.iter().enumerate().filter(|(_, crossing)| crossing.leaves) {
        let next = crossings[(index + 1) % count];
        // The last one goes on to the first, past the beginning of the edge.
        let last = if index + 1 == count { next.along + around } else { next.along };
        let mut line = vec![point_on_edge(crossing.along, bounds)];
        for round in [0, around] {
            let between = places.iter().zip(&corners).filter(|(place, _)| {
                (crossing.along < **place + round) && (**place + round < last)
            });
            line.extend(between.map(|(_, corner)| *corner));
        }
        line.push(point_on_edge(next.along, bounds));
        line.dedup();
        lines.push(line);
    }
    lines
}

/// Whether there is sea around all rings: the outermost, which has the smallest point, is an island.
fn is_surrounded_by_sea(rings: &[Chain]) -> bool {
    let outermost = rings.iter().min_by_key(|ring| ring.points.iter().min().copied());
    outermost.is_some_and(|ring| {
        let origin = ring.points[0];
        ring.points.windows(2).map(|pair| cross(origin, pair[0], pair[1])).sum::<i128>() > 0
    })
}

#[cfg(test)]
#[path = "sea_tests.rs"]
mod tests;
