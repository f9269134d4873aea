//! Removes the parts of roads that are on decks of bridges from the roads on the ground.
//!
//! ```text
//!   the way, as both methods have it:   ●────●──────────●───────●      on the ground along its whole length
//!   a run of it, off the ground:             ○────●───○                same points in plan
//!   what is drawn on the ground:        ●────●          ○────────●     it ends flat where the deck begins
//! ```

use std::{
    borrow::Cow,
    collections::{BTreeMap, BTreeSet},
};

use corniche_geom::{Bounds, StepBudget, along};

use super::{
    super::{distance, shares_in},
    DeckLine, GroundLine, PlanLine, TileLines,
    flat_ends::LineEnds,
};

/// Maximum distance of a point of a run from its way: a few steps of the lattice.
const NEAR_M: f64 = 0.005;

/// A position on a line: a segment, and the share of it before the position.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
struct LinePlace {
    segment: usize,
    share: f64,
}

/// A part to remove from a line: its start and end on the line, and their positions.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stretch {
    from: (LinePlace, [f64; 2]),
    to: (LinePlace, [f64; 2]),
}

/// A run in plan.
struct Run {
    ends_m: [[f64; 2]; 2],
    length_m: f64,
    points: usize,
}

impl Run {
    fn new(deck: &DeckLine) -> Option<Self> {
        let plan = |[x, y, _]: &[f64; 3]| [*x, *y];
        let ends_m = [plan(deck.points_m.first()?), plan(deck.points_m.last()?)];
        let pairs = deck.points_m.windows(2);
        let length_m = pairs.map(|pair| distance(plan(&pair[0]), plan(&pair[1]))).sum();
        (length_m > NEAR_M).then_some(Self { ends_m, length_m, points: deck.points_m.len() })
    }
}

/// The parts of a tile's roads that are off the ground.
pub(crate) struct OffGroundRoads<'a> {
    by_way: BTreeMap<i64, Vec<Run>>,
    lines: &'a [DeckLine],
    /// Points where tunnels emerge from the ground.
    portals: BTreeSet<[u64; 2]>,
    /// The ways of bridges, in order of their ids.
    bridges: &'a [i64],
    pub(crate) tile: Bounds,
    work: &'a StepBudget,
}

impl<'a> OffGroundRoads<'a> {
    /// Finds the parts of these lines, in the tile with these bounds, that are off the ground.
    pub(crate) fn new(lines: &'a TileLines, tile: Bounds, work: &'a StepBudget) -> Self {
        let TileLines { decks, portals, bridges, .. } = lines;
        let mut by_way: BTreeMap<i64, Vec<Run>> = BTreeMap::new();
        for deck in decks {
            work.add(deck.points_m.len());
            by_way.entry(deck.way_id).or_default().extend(Run::new(deck));
        }
        let portals = portals.iter().map(|at| at.map(f64::to_bits)).collect();
        Self { by_way, lines: decks, portals, bridges, tile, work }
    }

    /// The ends of the parts.
    pub(crate) fn ends(&self) -> impl Iterator<Item = LineEnds> {
        self.lines.iter().filter_map(DeckLine::ends)
    }

    /// Whether a line has a portal at its ends. Only bores have portals.
    pub(crate) fn portals(&self, ends: &LineEnds) -> [bool; 2] {
        [ends.first, ends.last]
            .map(|end| end.is_some_and(|[_, at]| self.portals.contains(&at.map(f64::to_bits))))
    }

    /// The parts of a line on the ground that are not on a deck: the line itself if no deck belongs
    /// to its way.
    pub(crate) fn without_ground<'l>(&self, line: &'l GroundLine) -> Vec<Cow<'l, GroundLine>> {
        if !self.by_way.contains_key(&line.way_id) {
            return vec![Cow::Borrowed(line)];
        }
        let plan: Vec<[f64; 2]> = line.points_m.iter().map(|[x, y, _]| [*x, *y]).collect();
        let stretches = self.stretches(line.way_id, &plan);
        if stretches.is_empty() {
            return vec![Cow::Borrowed(line)];
        }
        let kept = kept(&stretches, &plan);
        kept.iter().filter_map(|kept| kept.of_ground(line, &plan)).map(Cow::Owned).collect()
    }

    /// The parts of a line in plan that are not on a deck. Outside the tile, all of a bridge is
    /// removed: only the tile that contains such a part knows whether it is on the ground.
    pub(crate) fn without_plan<'l>(&self, line: &'l PlanLine) -> Vec<Cow<'l, PlanLine>> {
        let mut stretches = self.stretches(line.way_id, &line.points_m);
        if self.bridges.binary_search(&line.way_id).is_ok() {
            stretches = self.with_outside(&stretches, &line.points_m);
        }
        if stretches.is_empty() {
            return vec![Cow::Borrowed(line)];
        }
        let kept = kept(&stretches, &line.points_m);
        kept.iter().filter_map(|kept| kept.of_plan(line)).map(Cow::Owned).collect()
    }

    /// Adds the stretches outside the tile, then sorts and merges all stretches.
    fn with_outside(&self, stretches: &[Stretch], points_m: &[[f64; 2]]) -> Vec<Stretch> {
        let Bounds { min_x, min_y, max_x, max_y } = self.tile;
        let around = [[min_x, max_x], [min_y, max_y]];
        let mut all = stretches.to_vec();
        for (number, pair) in points_m.windows(2).enumerate() {
            self.work.add(1);
            let [a, b] = [pair[0], pair[1]];
            let place = |share: f64| (LinePlace { segment: number, share }, along(a, b, share));
            let [enters, leaves] = shares_in(a, [b[0] - a[0], b[1] - a[1]], around, 1.0);
            if enters > leaves {
                all.push(Stretch { from: place(0.0), to: place(1.0) });
                continue;
            }
            if enters > 0.0 {
                all.push(Stretch { from: place(0.0), to: place(enters) });
            }
            if leaves < 1.0 {
                all.push(Stretch { from: place(leaves), to: place(1.0) });
            }
        }
        all.sort_by(|a, b| {
            a.from.0.segment.cmp(&b.from.0.segment).then(a.from.0.share.total_cmp(&b.from.0.share))
        });
        let mut apart: Vec<Stretch> = Vec::new();
        for next in all {
            // The end of a segment is the start of the next one.
            let goes_on = |last: &Stretch| {
                let (reached, begins) = (last.to.0, next.from.0);
                begins <= reached
                    || (begins.segment == reached.segment + 1
                        && begins.share <= 0.0
                        && reached.share >= 1.0)
            };
            match apart.last_mut().filter(|last| goes_on(last)) {
                Some(last) if last.to.0 < next.to.0 => last.to = next.to,
                Some(_) => {}
                None => apart.push(next),
            }
        }
        apart
    }

    /// The stretches of a line that are on decks, sorted along the line and merged.
    fn stretches(&self, way_id: i64, points_m: &[[f64; 2]]) -> Vec<Stretch> {
        let mut found: Vec<Stretch> = Vec::new();
        let mut begin = LinePlace { segment: 0, share: 0.0 };
        for run in self.by_way.get(&way_id).into_iter().flatten() {
            self.work.add(1);
            if self.work.check().is_err() {
                break;
            }
            let Some(stretch) = self.stretch(points_m, run, begin) else { continue };
            begin = stretch.to.0;
            found.push(stretch);
        }
        found
    }

    /// The stretch in which a line follows a run from its first to its last point.
    fn stretch(&self, points_m: &[[f64; 2]], run: &Run, begin: LinePlace) -> Option<Stretch> {
        let Run { ends_m: [first, last], length_m, points } = *run;
        // Both lines are rounded to the lattice at each of their points.
        let slack_m = NEAR_M * (2.0 + points as f64);
        let mut from_segment = begin.segment;
        while let Some(from) = self.next_at(points_m, first, from_segment, f64::INFINITY) {
            if (from.segment, from.share + 1e-9) >= (begin.segment, begin.share) {
                let [start, end] = segment(points_m, from.segment);
                let before_m = from.share * distance(start, end);
                let mut reached_m = -before_m;
                let mut at = from.segment;
                while let Some(to) =
                    self.next_at(points_m, last, at, length_m + slack_m - reached_m)
                {
                    let lengths =
                        (at..to.segment).map(|k| segment(points_m, k)).map(|[a, b]| distance(a, b));
                    reached_m += lengths.sum::<f64>();
                    let [a, b] = segment(points_m, to.segment);
                    let along_m = reached_m + to.share * distance(a, b);
                    if (along_m - length_m).abs() <= slack_m + 1e-6 * length_m {
                        return Some(Stretch { from: (from, first), to: (to, last) });
                    }
                    reached_m += distance(a, b);
                    at = to.segment + 1;
                }
            }
            from_segment = from.segment + 1;
        }
        None
    }

    /// The first segment from this index on that passes through a point, at most `most_m` along the
    /// line; `None` if there is none, or the search takes too much work.
    fn next_at(
        &self,
        points_m: &[[f64; 2]],
        point: [f64; 2],
        from_segment: usize,
        most_m: f64,
    ) -> Option<LinePlace> {
        let mut along_m = 0.0;
        for number in from_segment..points_m.len().saturating_sub(1) {
            self.work.add(1);
            self.work.check().ok()?;
            let [a, b] = segment(points_m, number);
            let share = share_of(point, [a, b]);
            let at = along(a, b, share);
            if distance(at, point) <= NEAR_M {
                return Some(LinePlace { segment: number, share });
            }
            along_m += distance(a, b);
            if along_m > most_m {
                return None;
            }
        }
        None
    }
}

/// A part of a line that is kept: from its start or the end of a stretch, to its end or the next
/// stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
struct KeptRange {
    from: Option<(LinePlace, [f64; 2])>,
    to: Option<(LinePlace, [f64; 2])>,
}

/// The parts of a line outside of these stretches.
fn kept(stretches: &[Stretch], points_m: &[[f64; 2]]) -> Vec<KeptRange> {
    let mut kept = Vec::new();
    let mut from = None;
    for stretch in stretches {
        kept.push(KeptRange { from, to: Some(stretch.from) });
        from = Some(stretch.to);
    }
    kept.push(KeptRange { from, to: None });
    kept.retain(|part| part.length_m(points_m) > NEAR_M);
    kept
}

impl KeptRange {
    fn length_m(&self, points_m: &[[f64; 2]]) -> f64 {
        self.pieces(points_m).map(|(_, ends)| distance(ends[0], ends[1])).sum()
    }

    /// The pieces of the part, each within one segment: the index of the segment, and both ends.
    fn pieces(&self, points_m: &[[f64; 2]]) -> impl Iterator<Item = (usize, [[f64; 2]; 2])> {
        let Self { from, to } = *self;
        let last = points_m.len().saturating_sub(2);
        let numbers = from.map_or(0, |(at, _)| at.segment)..=to.map_or(last, |(at, _)| at.segment);
        numbers.filter_map(move |number| {
            let [a, b] = [*points_m.get(number)?, *points_m.get(number + 1)?];
            let cut = |end: Option<(LinePlace, [f64; 2])>, whole| match end {
                Some((at, cut)) if at.segment == number => cut,
                _ => whole,
            };
            Some((number, [cut(from, a), cut(to, b)]))
        })
    }

    /// The segments of this part of a line in plan and the ends of its points in them, without
    /// segments that are cut to less than a step.
    fn walked(&self, points_m: &[[f64; 2]]) -> Vec<(usize, [[f64; 2]; 2])> {
        let pieces = self.pieces(points_m);
        let is_kept = |(number, ends): &(usize, [[f64; 2]; 2])| {
            distance(ends[0], ends[1]) > NEAR_M || !self.is_cut_in(*number)
        };
        pieces.filter(is_kept).collect()
    }

    /// This part of a line on the ground; `plan` are the points of the line in plan.
    fn of_ground(&self, line: &GroundLine, plan: &[[f64; 2]]) -> Option<GroundLine> {
        let walked = self.walked(plan);
        let raised = |number: usize, at: [f64; 2]| {
            let [low, high] = [line.points_m[number], line.points_m[number + 1]];
            let share = share_of(at, [plan[number], plan[number + 1]]);
            [at[0], at[1], low[2] + share * (high[2] - low[2])]
        };
        let points_m = self.points(&walked, raised)?;
        let sources_m = walked.iter().map(|(number, _)| line.sources_m.get(*number).copied());
        let mut sources_m: Vec<[[f64; 2]; 2]> = sources_m.collect::<Option<_>>()?;
        // A cut segment ends where the deck begins.
        if let Some((_, at)) = self.from {
            trim(sources_m.iter_mut(), 0, at);
        }
        if let Some((_, at)) = self.to {
            trim(sources_m.iter_mut().rev(), 1, at);
        }
        Some(GroundLine { points_m, sources_m, dashes: None, ..*line })
    }

    /// This part of a line in plan.
    fn of_plan(&self, line: &PlanLine) -> Option<PlanLine> {
        let walked = self.walked(&line.points_m);
        let points_m = self.points(&walked, |_, at| at)?;
        let ranges_m = walked.iter().map(|(number, _)| line.ground_range_m.get(*number).copied());
        let ground_range_m = ranges_m.collect::<Option<_>>()?;
        Some(PlanLine { points_m, ground_range_m, dashes: None, ..*line })
    }

    /// The points of this part of a line, exactly where it is cut at its ends; `place` places a
    /// point of a segment. `None` without points.
    fn points<const N: usize>(
        &self,
        walked: &[(usize, [[f64; 2]; 2])],
        place: impl Fn(usize, [f64; 2]) -> [f64; N],
    ) -> Option<Vec<[f64; N]>> {
        let (number, [first, _]) = *walked.first()?;
        let ends = walked.iter().map(|(number, [_, end])| place(*number, *end));
        let mut points: Vec<_> = std::iter::once(place(number, first)).chain(ends).collect();
        let last = points.len() - 1;
        for (end, point) in [(self.from, 0), (self.to, last)] {
            if let Some((_, at)) = end {
                points[point][..2].copy_from_slice(&at);
            }
        }
        Some(points)
    }

    /// Whether a deck begins or ends in a segment.
    fn is_cut_in(&self, number: usize) -> bool {
        [self.from, self.to].into_iter().flatten().any(|(at, _)| at.segment == number)
    }
}

/// Moves one end of all pieces of the first segment in `sources`.
fn trim<'a>(sources: impl Iterator<Item = &'a mut [[f64; 2]; 2]>, end: usize, at: [f64; 2]) {
    let mut whole = None;
    for source in sources {
        if *whole.get_or_insert(*source) != *source {
            return;
        }
        source[end] = at;
    }
}

fn segment(points_m: &[[f64; 2]], number: usize) -> [[f64; 2]; 2] {
    [points_m[number], points_m[number + 1]]
}

/// The share of a segment before its point that is nearest to another point.
fn share_of([x, y]: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let squared = dx * dx + dy * dy;
    if squared == 0.0 {
        return 0.0;
    }
    (((x - a[0]) * dx + (y - a[1]) * dy) / squared).clamp(0.0, 1.0)
}

#[cfg(test)]
#[path = "cut_tests.rs"]
mod tests;
