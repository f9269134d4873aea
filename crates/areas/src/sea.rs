//! Builds the sea from coastlines: closes them along the edge of a region, and reports what is
//! missing or wrong.

use corniche_geom::{LatticePoint, doubled_area};

use crate::{
    OutlineError, Polygon, Ring, assemble,
    assemble::polygons_of,
    coastlines::{Coastline, CoastlineChain, cut, join},
    intersection,
    region_edge::{AlongEdge, RegionEdge, squared_distance},
    segments::{segments_of, uncrossed_segments_of},
};

/// The minimum distance from the edge, in steps, at which points that are rounded to the lattice
/// count as inside.
const INSIDE: f64 = 1.0;
/// The maximum number of open ends for which nearby beginnings are searched.
const MOST_OPEN_ENDS: usize = 4096;

/// The sea within a region.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Sea {
    /// The polygons of the sea. No two have inner points in common.
    pub polygons: Vec<Polygon>,
    /// Ways that end inside the region where no other way begins. A straight line connects each to
    /// the nearest beginning or to the edge.
    pub bridged: Vec<i64>,
    /// Ways that claim sea where others claim land. They were omitted.
    pub left_out: Vec<i64>,
}

/// Builds the sea from coastlines: it is to the right of them. Along the edge of each part of
/// `region`, the sea is closed clockwise, from where a coast leaves the part to where the next
/// coast enters it. A part without any coast has no sea. Coasts in holes of the region are also
/// considered, and the sea then ends there.
///
/// The rule that the sea is on the right is OSM's (wiki, "Tag:natural=coastline"). As in Jochen
/// Topf's *osmcoastline*, open ends are joined with the nearest open beginning.
///
/// # Errors
/// When coastlines cross between their points.
pub fn close_sea(coastlines: Vec<Coastline>, region: &[Polygon]) -> Result<Sea, OutlineError> {
    let mut sea = Sea::default();
    let chains = join(coastlines);
    for part in region {
        let Some(edge) = RegionEdge::new(part.outer()) else { continue };
        let mut polygons = close_in(chains.clone(), &edge, &mut sea)?;
        if !part.holes().is_empty() {
            polygons = intersection(&polygons, part.rings().map(Ring::points), 1)?;
        }
        sea.polygons.extend(polygons);
    }
    for ways in [&mut sea.bridged, &mut sea.left_out] {
        ways.sort_unstable();
        ways.dedup();
    }
    Ok(sea)
}

/// Returns the sea within an edge.
fn close_in(
    chains: Vec<CoastlineChain>,
    edge: &RegionEdge,
    sea: &mut Sea,
) -> Result<Vec<Polygon>, OutlineError> {
    let chains = bridge(chains, edge, &mut sea.bridged);
    let mut rings = Vec::new();
    let mut parts = Vec::new();
    for chain in &chains {
        for part in cut(chain, edge.region()) {
            if part.is_ring() {
                rings.push(part);
            } else {
                parts.push(to_edge(part, edge, &mut sea.bridged));
            }
        }
    }
    let crossings = agreeing(crossings_of(&parts, edge), &mut parts, &mut sea.left_out);
    let mut lines: Vec<Vec<LatticePoint>> =
        parts.iter().chain(&rings).map(|part| part.points.clone()).collect();
    let coasts = lines.len();
    lines.extend(edge_lines(&crossings, edge));
    if crossings.is_empty() && is_surrounded_by_sea(&rings) {
        lines.push(closed(edge.corners().to_vec()));
    }
    match assemble(&lines) {
        Ok(assembled) => Ok(assembled.polygons),
        Err(OutlineError::Nothing) => Ok(Vec::new()),
        // Coasts are rounded where they meet a slanting edge, so a line along the edge may cross
        // one of them by less than a step.
        Err(OutlineError::Crossing { .. }) if segments_of(&lines[..coasts]).is_ok() => {
            polygons_of(uncrossed_segments_of(&lines)?)
        }
        Err(error) => Err(error),
    }
}

fn closed(mut points: Vec<LatticePoint>) -> Vec<LatticePoint> {
    points.extend(points.first().copied());
    points
}

/// Joins ends inside the region with the nearest beginnings inside it, if these are nearer than the
/// sum of both distances to the edge.
fn bridge(
    chains: Vec<CoastlineChain>,
    edge: &RegionEdge,
    bridged: &mut Vec<i64>,
) -> Vec<CoastlineChain> {
    let inside = |point: Option<LatticePoint>| {
        let distance = edge.distance(point?);
        Some((point?, distance)).filter(|_| distance >= INSIDE)
    };
    let open = |chain: &&CoastlineChain| !chain.is_ring();
    let ends = || chains.iter().enumerate().filter(|(_, chain)| open(chain));
    let tails: Vec<(usize, (LatticePoint, f64))> =
        ends().filter_map(|(index, chain)| Some((index, inside(chain.last())?))).collect();
    let heads: Vec<(usize, (LatticePoint, f64))> =
        ends().filter_map(|(index, chain)| Some((index, inside(chain.first())?))).collect();
    if tails.len().max(heads.len()) > MOST_OPEN_ENDS {
        return chains;
    }
    let mut pairs: Vec<(i128, usize, usize)> = Vec::new();
    for &(tail, (end, end_to_edge)) in &tails {
        for &(head, (beginning, beginning_to_edge)) in &heads {
            let away = squared_distance(end, beginning);
            // Of the two ways to close the coast, take the one that invents less coast.
            if away as f64 <= (end_to_edge + beginning_to_edge).powi(2) {
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

/// Joins chains as `next` says: first the chains that nothing precedes, then the rest, which are
/// rings.
fn follow(
    chains: Vec<CoastlineChain>,
    next: &[Option<usize>],
    has_before: &[bool],
) -> Vec<CoastlineChain> {
    let mut left: Vec<Option<CoastlineChain>> = chains.into_iter().map(Some).collect();
    let (first, others): (Vec<usize>, Vec<usize>) =
        (0..left.len()).partition(|&index| !has_before[index]);
    let mut joined = Vec::new();
    for index in first.into_iter().chain(others) {
        let Some(mut chain) = left[index].take() else { continue };
        let mut at = index;
        while let Some(following) = next[at] {
            let Some(following_chain) = left[following].take() else {
                // Close the ring.
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

/// Returns the same part with ends inside the region extended to the edge by the shortest way.
fn to_edge(mut part: CoastlineChain, edge: &RegionEdge, bridged: &mut Vec<i64>) -> CoastlineChain {
    if let Some(last) = part.last().filter(|&last| edge.distance(last) >= INSIDE) {
        bridged.extend(part.ways.last());
        part.push(edge.nearest_on_edge(last));
    }
    if let Some(first) = part.first().filter(|&first| edge.distance(first) >= INSIDE) {
        bridged.extend(part.ways.first());
        part.points.insert(0, edge.nearest_on_edge(first));
        part.ways.extend_from_within(..1);
        part.ways.rotate_right(1);
    }
    part
}

/// A point where a coast meets the edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Crossing {
    /// The position along the edge, clockwise.
    along: AlongEdge,
    leaves: bool,
    part: usize,
    at: LatticePoint,
}

fn crossings_of(parts: &[CoastlineChain], edge: &RegionEdge) -> Vec<Crossing> {
    let mut crossings = Vec::new();
    for (part, chain) in parts.iter().enumerate() {
        for (at, leaves) in [(chain.first(), false), (chain.last(), true)] {
            crossings.extend(at.map(|at| Crossing { along: edge.along(at), leaves, part, at }));
        }
    }
    crossings.sort_unstable();
    crossings
}

/// Returns the crossings in order, alternately in and out. Of two that contradict each other, the
/// shorter part is omitted.
fn agreeing(
    mut crossings: Vec<Crossing>,
    parts: &mut Vec<CoastlineChain>,
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
    // A part that is omitted is not a line of the outline, either.
    let mut is_out = is_out.into_iter();
    parts.retain(|_| !is_out.next().unwrap_or_default());
    crossings
}

/// Orders crossings at the same position so that the one that fits the preceding crossings is
/// first.
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
    // The first crossing is preceded only by the last.
    if let [first, second, .., last] = crossings
        && first.along == second.along
        && first.leaves == last.leaves
        && first.leaves != second.leaves
    {
        std::mem::swap(first, second);
    }
}

fn length_steps(chain: &CoastlineChain) -> f64 {
    chain.points.array_windows().map(|&[from, to]| from.distance_steps(to)).sum()
}

/// Returns the lines along the edge from where coasts leave to where the next coast enters,
/// clockwise.
fn edge_lines(crossings: &[Crossing], edge: &RegionEdge) -> Vec<Vec<LatticePoint>> {
    let corners = || edge.corners().iter().enumerate().map(|(index, &corner)| ((index, 0), corner));
    let mut lines = Vec::new();
    let count = crossings.len();
    for (index, crossing) in crossings.iter().enumerate().filter(|(_, crossing)| crossing.leaves) {
        let next = crossings[(index + 1) % count];
        let behind = |place: AlongEdge| place > crossing.along;
        let before = |place: AlongEdge| place < next.along;
        let mut line = vec![crossing.at];
        if index + 1 == count {
            // The last line continues to the first crossing, past the beginning of the edge.
            line.extend(corners().filter(|&(place, _)| behind(place)).map(|(_, corner)| corner));
            line.extend(corners().filter(|&(place, _)| before(place)).map(|(_, corner)| corner));
        } else {
            let between = corners().filter(|&(place, _)| behind(place) && before(place));
            line.extend(between.map(|(_, corner)| corner));
        }
        line.push(next.at);
        line.dedup();
        lines.push(line);
    }
    lines
}

/// Whether there is sea around all rings: the outermost ring, which has the smallest point, is an
/// island.
fn is_surrounded_by_sea(rings: &[CoastlineChain]) -> bool {
    let outermost = rings.iter().min_by_key(|ring| ring.points.iter().min().copied());
    outermost.is_some_and(|ring| doubled_area(&ring.points) > 0)
}

#[cfg(test)]
#[path = "sea_tests.rs"]
mod tests;
