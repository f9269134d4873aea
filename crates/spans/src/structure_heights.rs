//! The heights of decks and tunnels.

use std::{collections::BTreeSet, sync::Arc};

use corniche_network::{ChainNumber, NodeNumber};

use crate::{
    crossing_place::CrossingPlace,
    crossings::{Crossing, Crossings, Order},
    harmonic::Harmonic,
    lifts::{OnEdge, Reach, Tent, put_up},
    refusals::Refusals,
    spans::{SpanEdge, SpanProblem, SpanReason, Spans},
};

/// The desired height between crossing roads, metres.
const FREE_HEIGHT_M: f64 = 1.0;
/// The height that is always created between crossing roads, however steep it is, metres.
const LEAST_FREE_HEIGHT_M: f64 = 0.3;
/// The flanks of a lift may always have this grade.
const LEAST_FLANK: f64 = 0.02;
/// The maximum number of passes. A lifted span may be in the way of the span above it, so all
/// crossings are checked again.
const MOST_PASSES: usize = 8;
/// The spacing of height samples along lifted decks, metres: between the bends of one tent, another
/// tent may be higher.
const STATION_M: f64 = 10.0;
/// The maximum number of samples on an edge, enough for 40 km.
const MOST_STATIONS: f64 = 4096.0;
/// The distance from an end of an edge below which a position counts as the end, metres.
const END_M: f64 = 1e-6;
/// The minimum length for which a grade is computed, metres.
const SHORTEST_M: f64 = 1.0;
/// The minimum difference that is a reason to lift, or that makes a grade too steep; smaller
/// differences are rounding errors, metres.
const ENOUGH_M: f64 = 1e-6;

/// The free height at a crossing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeHeight {
    /// The crossing; for a stretch that both roads share, the place with the least free height.
    pub crossing: Crossing,
    /// The height of the upper above the lower, metres; `None` if a height or the order is unknown.
    pub free_m: Option<f64>,
}

/// The heights of bridges and tunnels.
#[derive(Debug)]
pub struct Decks {
    spans: Arc<Spans>,
    /// For each joint, whether the ground does not carry it.
    is_refused: Vec<bool>,
    /// The height of each joint; NaN if unknown.
    joints_m: Vec<f64>,
    /// The tents on each edge.
    tents: Vec<Vec<Tent>>,
    /// The free heights at the crossings, in the order of the crossings.
    free_heights: Vec<FreeHeight>,
    /// The problems of joints and ways.
    problems: Vec<SpanProblem>,
    /// The problems of crossings, with the ways of the spans there.
    of_crossings: Vec<(SpanReason, [Option<i64>; 2])>,
}

impl Decks {
    /// Returns the positions on the lattice whose ground [`Decks::solve`] needs, in the required
    /// order.
    pub fn places(spans: &Spans, crossings: &Crossings) -> impl Iterator<Item = [f64; 2]> {
        let joints = spans.joints.iter().map(|joint| joint.at.in_steps());
        joints.chain(crossings.all.iter().map(|crossing| crossing.at))
    }

    /// Solves the heights of spans over the ground. `grounds_m` are the ground's heights at
    /// [`Decks::places`]; `None` where there is no ground.
    ///
    /// At supports, the heights are the ground's. Between supports they are harmonic along the
    /// chains, which for two supports means a straight line. If a span passes through a node of the
    /// ground that is far from that line, the ground does not carry it there (see
    /// [`SpanReason::GroundWayOnDeck`]). At crossings, bridges are lifted and tunnels lowered until
    /// there is a metre between them and the road that they cross. The flanks are at most as steep
    /// as roads of that kind are built, minus the span's own grade, and always at least 2 %; 0.3 m
    /// are always created.
    #[must_use]
    pub fn solve(spans: Arc<Spans>, crossings: &Crossings, grounds_m: &[Option<f64>]) -> Self {
        let (of_joints_m, of_crossings_m) = grounds_m.split_at(spans.joints.len());
        let grounds_m = (of_joints_m, of_crossings_m);
        let refusals = Refusals::find(&spans, &crossings.all, grounds_m, FREE_HEIGHT_M);
        let mut problems = spans.problems(&refusals.is_refused);
        let unsolved = refusals.unsolved.iter();
        problems.extend(unsolved.map(|&at| spans.problem_of_joint(SpanReason::TooIntricate, at)));
        let left_out = crossings.left_out.iter();
        problems.extend(
            left_out.map(|&way_id| SpanProblem::of_way(SpanReason::TooManyCrossings, way_id)),
        );
        let held_m = held_m(&spans, &refusals.is_refused, of_joints_m);
        for (number, joint) in spans.joints.iter().enumerate() {
            let is_held = joint.support.is_some() && !refusals.is_refused[number];
            if is_held && of_joints_m[number].is_none() {
                problems.push(spans.problem_of_joint(SpanReason::NoGround, number));
            }
        }
        let joints_m = solved(&spans, &held_m);
        problems.extend(too_intricate(&spans, &held_m, &joints_m));
        let mut decks = Self {
            joints_m,
            tents: vec![Vec::new(); spans.edges.len()],
            spans,
            is_refused: refusals.is_refused,
            free_heights: Vec::with_capacity(crossings.all.len()),
            problems,
            of_crossings: Vec::new(),
        };
        decks.lift(&crossings.all, of_crossings_m, &held_m);
        decks.judge(&crossings.all, of_crossings_m);
        decks.judge_grades();
        decks
    }

    /// Returns the same decks on another ground, such as the ground of a coarse level, from its
    /// heights at the joints. The heights are solved again, with the same supports and lifts.
    #[must_use]
    pub fn on(&self, grounds_m: &[Option<f64>]) -> Self {
        let held_m = held_m(&self.spans, &self.is_refused, grounds_m);
        Self {
            joints_m: solved(&self.spans, &held_m),
            tents: self.tents.clone(),
            is_refused: self.is_refused.clone(),
            spans: Arc::clone(&self.spans),
            free_heights: Vec::new(),
            problems: Vec::new(),
            of_crossings: Vec::new(),
        }
    }

    /// Returns the nodes at which spans are carried, with their heights; nodes without ground are
    /// omitted.
    pub fn supports(&self) -> impl Iterator<Item = (NodeNumber, f64)> + '_ {
        let all = self.spans.joints.iter().zip(&self.joints_m).zip(&self.is_refused);
        all.filter(|((joint, height_m), is_refused)| {
            joint.support.is_some() && !**is_refused && height_m.is_finite()
        })
        .map(|((joint, &height_m), _)| (joint.node, height_m))
    }

    /// Returns the spans.
    #[must_use]
    pub fn spans(&self) -> &Spans {
        &self.spans
    }

    /// Returns the free heights between bridges or tunnels and the roads that they cross.
    #[must_use]
    pub fn free_heights(&self) -> &[FreeHeight] {
        &self.free_heights
    }

    /// Returns the problems of the ways that `is_told` accepts, in order; a problem of a crossing
    /// has the smallest of these ways.
    #[must_use]
    pub fn problems(&self, is_told: &dyn Fn(i64) -> bool) -> Vec<SpanProblem> {
        let own = self.problems.iter().copied().filter(|problem| is_told(problem.way_id));
        let of_crossings = self.of_crossings.iter().filter_map(|&(reason, ways)| {
            let told = ways.into_iter().flatten().filter(|&way_id| is_told(way_id)).min();
            Some(SpanProblem::of_way(reason, told?))
        });
        let mut all: Vec<SpanProblem> = own.chain(of_crossings).collect();
        all.sort_unstable();
        all
    }

    /// Returns the height at a distance along a chain, as if there were no ground; `None` on the
    /// ground, and if the height is unknown.
    #[must_use]
    pub fn height_m(&self, chain: ChainNumber, along_m: f64) -> Option<f64> {
        let edge = self.spans.edge_of(chain)?;
        Some(self.raised_m(OnEdge { edge, along_m })).filter(|height_m| height_m.is_finite())
    }

    /// Returns the distances, ascending, between two positions of a chain at which its deck may
    /// bend, without these positions.
    #[must_use]
    pub fn bends_m(&self, chain: ChainNumber, [from_m, to_m]: [f64; 2]) -> Vec<f64> {
        let Some(edge) = self.spans.edge_of(chain) else { return Vec::new() };
        let (length_m, tents) = (self.spans.edges[edge].length_m, &self.tents[edge]);
        let mut bends_m: Vec<f64> = tents.iter().flat_map(|tent| tent.bends_m(length_m)).collect();
        if !tents.is_empty() {
            let count = (length_m / STATION_M).ceil().min(MOST_STATIONS);
            let [first, last] =
                [from_m, to_m].map(|at_m| (at_m / length_m * count).floor().max(0.0) as usize);
            bends_m.extend((first..=last).map(|k| k as f64 * length_m / count));
        }
        bends_m.retain(|&at_m| at_m > from_m && at_m < to_m);
        bends_m.sort_by(f64::total_cmp);
        bends_m.dedup();
        bends_m
    }

    /// Returns the height at a position without any lift.
    fn base_m(&self, OnEdge { edge, along_m }: OnEdge) -> f64 {
        let edge = &self.spans.edges[edge];
        let [from_m, to_m] = edge.joints.map(|joint| self.joints_m[joint as usize]);
        // Sums of lengths are rounded. A position near enough to the end is the end, which has
        // exactly the support's height.
        if along_m >= edge.length_m - END_M {
            to_m
        } else if along_m > END_M {
            from_m + along_m / edge.length_m * (to_m - from_m)
        } else {
            from_m
        }
    }

    fn raised_m(&self, at: OnEdge) -> f64 {
        let edge = &self.spans.edges[at.edge];
        let heights_m =
            self.tents[at.edge].iter().map(|tent| tent.height_m(at.along_m, edge.length_m));
        self.base_m(at) + edge.kind.away() * heights_m.fold(0.0, f64::max)
    }

    /// Returns the height at a crossing: for a bridge or a tunnel that would be on the wrong side
    /// of the ground, the ground's height.
    fn crossing_m(&self, place: &CrossingPlace, ground_m: f64) -> f64 {
        let edge = self.spans.edge_of(place.chain);
        match (edge, place.kind) {
            (Some(edge), Some(kind)) => {
                let own_m = self.raised_m(OnEdge { edge, along_m: place.along_m });
                let is_within = kind.away() * (own_m - ground_m) < 0.0;
                if is_within { ground_m } else { own_m }
            }
            _ => ground_m,
        }
    }

    /// Lifts bridges over the roads that they cross, from the lowest layer upwards, and lowers
    /// tunnels from the highest layer downwards.
    fn lift(&mut self, crossings: &[Crossing], grounds_m: &[Option<f64>], held_m: &[f64]) {
        let known = |(number, crossing): (usize, &Crossing)| {
            if crossing.order != Order::Known {
                return None;
            }
            let [own, other] = crossing.moved();
            let edge = self.spans.edge_of(own.chain)?;
            let at = OnEdge { edge, along_m: own.along_m };
            let ground_m = grounds_m[number].unwrap_or(f64::NAN);
            Some(((at, crossing.half_m), own, other, ground_m))
        };
        let mut all: Vec<_> = crossings.iter().enumerate().filter_map(known).collect();
        all.sort_by_key(|((at, _), own, ..)| {
            self.spans.edges[at.edge].kind.away() as i16 * i16::from(own.layer)
        });
        let grades = self.median_grades();
        let is_held = |joint: usize| held_m[joint].is_finite();
        for _ in 0..MOST_PASSES {
            let mut is_changed = false;
            for ((at, half_m), own, other, ground_m) in &all {
                let edge = &self.spans.edges[at.edge];
                let away = edge.kind.away();
                let other_m = self.crossing_m(other, *ground_m);
                let [raised_m, base_m] = [self.raised_m(*at), self.base_m(*at)];
                let room_m = away * (raised_m - other_m);
                if room_m.is_nan() || room_m >= FREE_HEIGHT_M - ENOUGH_M {
                    continue;
                }
                let Some(reach) = Reach::around(&self.spans, &is_held, (*at, *half_m)) else {
                    continue;
                };
                let wanted_m = FREE_HEIGHT_M - away * (base_m - other_m);
                let limit = own.steepest - grades[edge.span as usize];
                let gentle_m = limit.max(LEAST_FLANK) * reach.support_m;
                let least_m = wanted_m - FREE_HEIGHT_M + LEAST_FREE_HEIGHT_M;
                let apex_m = wanted_m.min(gentle_m.max(least_m));
                let before_m = away * (raised_m - base_m);
                if apex_m > before_m + ENOUGH_M && reach.support_m > 0.0 {
                    is_changed |= put_up(&mut self.tents, reach.tents(&self.spans, apex_m));
                }
            }
            if !is_changed {
                break;
            }
        }
    }

    /// Returns, for each span, the grade that half of its length does not exceed.
    fn median_grades(&self) -> Vec<f64> {
        let mut of_spans: Vec<Vec<(f64, f64)>> = vec![Vec::new(); self.spans.count];
        for edge in &self.spans.edges {
            let [from_m, to_m] = edge.joints.map(|joint| self.joints_m[joint as usize]);
            let grade = ((to_m - from_m) / edge.length_m).abs();
            if grade.is_finite() {
                of_spans[edge.span as usize].push((grade, edge.length_m));
            }
        }
        let median = |mut own: Vec<(f64, f64)>| {
            own.sort_by(|one, other| one.0.total_cmp(&other.0));
            let half_m = own.iter().map(|(_, length_m)| length_m).sum::<f64>() / 2.0;
            let mut sum_m = 0.0;
            let found = own.iter().find(|(_, length_m)| {
                sum_m += length_m;
                sum_m >= half_m
            });
            found.map_or(0.0, |(grade, _)| *grade)
        };
        of_spans.into_iter().map(median).collect()
    }

    /// Determines the free height at each crossing; for a stretch that both share, the least.
    fn judge(&mut self, crossings: &[Crossing], grounds_m: &[Option<f64>]) {
        let all: Vec<FreeHeight> = crossings
            .iter()
            .zip(grounds_m)
            .map(|(crossing, ground_m)| {
                // Where there is no ground, two bridges still have heights.
                let ground_m = ground_m.unwrap_or(f64::NAN);
                let [upper_m, lower_m] =
                    [crossing.upper, crossing.lower].map(|place| self.crossing_m(&place, ground_m));
                let free_m = Some(upper_m - lower_m)
                    .filter(|free_m| free_m.is_finite() && crossing.order == Order::Known);
                FreeHeight { crossing: *crossing, free_m }
            })
            .collect();
        for stretch in all.chunk_by(|_, next| next.crossing.continues) {
            let room = |own: &FreeHeight| own.free_m.unwrap_or(f64::INFINITY);
            let least = stretch.iter().min_by(|one, other| room(one).total_cmp(&room(other)));
            let Some(&FreeHeight { crossing, free_m }) = least else { continue };
            let ways = [crossing.upper, crossing.lower]
                .map(|place| place.kind.is_some().then_some(place.way_id));
            let reason = match free_m {
                _ if crossing.order == Order::Tie => Some(SpanReason::LayerTie),
                Some(free_m) if free_m < 0.0 => Some(SpanReason::OrderReversed),
                Some(free_m) if free_m < FREE_HEIGHT_M - ENOUGH_M => {
                    Some(SpanReason::OrderUnreachable)
                }
                _ => None,
            };
            self.of_crossings.extend(reason.map(|reason| (reason, ways)));
            self.free_heights.push(FreeHeight { crossing, free_m });
        }
    }

    /// Reports the ways of spans that are steeper than roads of their kind are built, each once.
    fn judge_grades(&mut self) {
        let mut steep = BTreeSet::new();
        for (number, edge) in self.spans.edges.iter().enumerate() {
            let mut places_m = vec![0.0];
            places_m.extend(self.bends_m(edge.chain, [0.0, edge.length_m]));
            places_m.push(edge.length_m);
            let height_m = |along_m| self.raised_m(OnEdge { edge: number, along_m });
            let is_steep = places_m.array_windows().any(|&[from_m, to_m]| {
                let length_m = to_m - from_m;
                let rise_m = (height_m(to_m) - height_m(from_m)).abs();
                length_m > SHORTEST_M && rise_m > edge.steepest * length_m + ENOUGH_M
            });
            if is_steep {
                steep.insert(edge.way_id);
            }
        }
        let problem = |way_id| SpanProblem::of_way(SpanReason::GradeOverLimit, way_id);
        self.problems.extend(steep.into_iter().map(problem));
    }
}

/// Returns spans that are carried but have joints without a height.
fn too_intricate<'a>(
    spans: &'a Spans,
    held_m: &'a [f64],
    joints_m: &'a [f64],
) -> impl Iterator<Item = SpanProblem> + use<'a> {
    let has = |of_joints: &[f64], edge: &SpanEdge, is: fn(f64) -> bool| {
        edge.joints.iter().any(|joint| is(of_joints[*joint as usize]))
    };
    let mut ways: Vec<(Option<i64>, bool)> = vec![(None, false); spans.count];
    for edge in &spans.edges {
        let (way_id, is_carried) = &mut ways[edge.span as usize];
        *is_carried |= has(held_m, edge, f64::is_finite);
        if has(joints_m, edge, f64::is_nan) {
            *way_id = Some(way_id.map_or(edge.way_id, |other| other.min(edge.way_id)));
        }
    }
    let problem = |way_id| SpanProblem::of_way(SpanReason::TooIntricate, way_id);
    ways.into_iter()
        .filter(|(_, is_carried)| *is_carried)
        .filter_map(|(way_id, _)| way_id)
        .map(problem)
}

/// Returns the ground's height at the joints that carry their spans; NaN at others.
fn held_m(spans: &Spans, is_refused: &[bool], grounds_m: &[Option<f64>]) -> Vec<f64> {
    let all = spans.joints.iter().zip(is_refused).zip(grounds_m);
    all.map(|((joint, &is_refused), own_m)| {
        own_m.filter(|_| joint.support.is_some() && !is_refused).unwrap_or(f64::NAN)
    })
    .collect()
}

/// Returns the heights of all joints between the fixed ones; NaN where no fixed height has an
/// influence.
fn solved(spans: &Spans, held_m: &[f64]) -> Vec<f64> {
    let mut harmonic = Harmonic::new(held_m.len());
    for edge in &spans.edges {
        harmonic.tie(edge.joints.map(|joint| joint as usize), edge.length_m);
    }
    harmonic.solve(held_m)
}

#[cfg(test)]
#[path = "structure_heights_tests.rs"]
mod tests;
