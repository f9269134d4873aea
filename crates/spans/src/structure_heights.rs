//! The heights of decks and tunnels.

use std::{collections::BTreeSet, sync::Arc};

use corniche_network::{ChainNumber, NodeNumber};

use crate::{
    crossing_place::CrossingPlace,
    crossings::{Crossing, Crossings, Order},
    harmonic::Harmonic,
    lifts::{OnEdge, Reach, Tent, put_up},
    refusals::Refusals,
    spans::{Edge, SpanProblem, SpanReason, Spans},
};

/// What is wanted between what crosses, metres.
const FREE_HEIGHT_M: f64 = 1.0;
/// What is made between them, however steep it is, metres.
const LEAST_FREE_HEIGHT_M: f64 = 0.3;
/// The flanks of a lift may have at least this grade.
const LEAST_FLANK: f64 = 0.02;
/// What is lifted may be in the way of what is above it, so all are looked at again, as often at most.
const MOST_PASSES: usize = 8;
/// Where decks are lifted, heights are given so often along them, metres: between the bends of a tent another one may be higher.
const STATION_M: f64 = 10.0;
/// But so many at most along an edge: 40 km of it.
const MOST_STATIONS: f64 = 4096.0;
/// What is nearer to an end of an edge is at it, metres.
const END_M: f64 = 1e-6;
/// What is shorter has no grade, metres.
const SHORTEST_M: f64 = 1.0;
/// Less is no reason to lift, and makes no grade too steep: what is left of rounding, metres.
const ENOUGH_M: f64 = 1e-6;

/// How much room there is between what crosses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeHeight {
    /// The crossing; of a stretch that both share the place at which there is least room.
    pub crossing: Crossing,
    /// How far the upper is above the lower, metres; `None` where a height is not known, or which is which.
    pub free_m: Option<f64>,
}

/// How high bridges and tunnels are.
#[derive(Debug)]
pub struct Decks {
    spans: Arc<Spans>,
    /// At which joints the ground does not carry them.
    is_refused: Vec<bool>,
    /// The height of each joint, NaN where it is not known.
    joints_m: Vec<f64>,
    /// The tents on each edge.
    tents: Vec<Vec<Tent>>,
    /// The crossings, in their order.
    free_heights: Vec<FreeHeight>,
    /// What is to be told of joints and ways.
    problems: Vec<SpanProblem>,
    /// What is to be told of crossings, with the ways of the spans there.
    of_crossings: Vec<(SpanReason, [Option<i64>; 2])>,
}

impl Decks {
    /// The places of the lattice whose ground [`Decks::solve`] needs, in this order.
    pub fn places(spans: &Spans, crossings: &Crossings) -> impl Iterator<Item = [f64; 2]> {
        let joints = spans.joints.iter().map(|joint| joint.at.in_steps());
        joints.chain(crossings.all.iter().map(|crossing| crossing.at))
    }

    /// Solves the heights of spans over the ground, whose heights at [`Decks::places`] are given; `None` where there is none.
    ///
    /// At supports they are the ground's; between them they are harmonic along the chains, which for two supports is a straight line. Where a span passes
    /// through a node of the ground that is far from that line, the ground carries nothing (see [`SpanReason::GroundWayOnDeck`]). At crossings bridges are
    /// lifted and tunnels lowered until there is a metre between them and what they cross, with flanks no steeper than roads of that kind are built, less
    /// what the span itself has, and 2 % at least; 0.3 m are always made.
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

    /// The same decks on another ground, as coarse levels have it, whose heights at the joints are given: solved anew, with the supports and the lifts
    /// that they have.
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

    /// The nodes at which spans are carried, with their heights; those without ground are left out.
    pub fn supports(&self) -> impl Iterator<Item = (NodeNumber, f64)> + '_ {
        let all = self.spans.joints.iter().zip(&self.joints_m).zip(&self.is_refused);
        all.filter(|((joint, height_m), is_refused)| {
            joint.support.is_some() && !**is_refused && height_m.is_finite()
        })
        .map(|((joint, &height_m), _)| (joint.node, height_m))
    }

    /// The spans.
    #[must_use]
    pub fn spans(&self) -> &Spans {
        &self.spans
    }

    /// What is between bridges and tunnels and what they cross.
    #[must_use]
    pub fn free_heights(&self) -> &[FreeHeight] {
        &self.free_heights
    }

    /// What is to be told of the ways that `is_told` chooses, in order; of a crossing with the smallest of these.
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

    /// The height at a distance along a chain, as if there were no ground; `None` on the ground, and where it is not known.
    #[must_use]
    pub fn height_m(&self, chain: ChainNumber, along_m: f64) -> Option<f64> {
        let edge = self.spans.edge_of(chain)?;
        Some(self.raised_m(OnEdge { edge, along_m })).filter(|height_m| height_m.is_finite())
    }

    /// The distances between two places of a chain at which its deck may bend, ascending, without these places.
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

    /// The height at a place without any lift.
    fn base_m(&self, OnEdge { edge, along_m }: OnEdge) -> f64 {
        let edge = &self.spans.edges[edge];
        let [from_m, to_m] = edge.joints.map(|joint| self.joints_m[joint as usize]);
        // Sums of lengths are rounded: near enough to an end is the end, whose height is the support's to the bit.
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

    /// The height of what crosses: of a bridge or a tunnel that the ground does not let through, the ground's.
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

    /// Lifts bridges over what they cross, from the lowest layer upwards, and lowers tunnels from the highest downwards.
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
                let Some(reach) = Reach::of(&self.spans, &is_held, (*at, *half_m)) else {
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

    /// For each span the grade that half of its length has at most.
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

    /// Says what there is between what crosses; of a stretch that both share, where it is least.
    fn judge(&mut self, crossings: &[Crossing], grounds_m: &[Option<f64>]) {
        let all: Vec<FreeHeight> = crossings
            .iter()
            .zip(grounds_m)
            .map(|(crossing, ground_m)| {
                // Where there is no ground, two bridges have their heights yet.
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

    /// Tells which ways of spans are steeper than roads of their kind are built, each once.
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

/// Spans that are carried, and yet have joints without a height.
fn too_intricate<'a>(
    spans: &'a Spans,
    held_m: &'a [f64],
    joints_m: &'a [f64],
) -> impl Iterator<Item = SpanProblem> + use<'a> {
    let has = |of_joints: &[f64], edge: &Edge, is: fn(f64) -> bool| {
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

/// The ground's height at the joints that carry their spans, NaN at others.
fn held_m(spans: &Spans, is_refused: &[bool], grounds_m: &[Option<f64>]) -> Vec<f64> {
    let all = spans.joints.iter().zip(is_refused).zip(grounds_m);
    all.map(|((joint, &is_refused), own_m)| {
        own_m.filter(|_| joint.support.is_some() && !is_refused).unwrap_or(f64::NAN)
    })
    .collect()
}

/// The heights of all joints between those that are held; NaN where nothing holds them.
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
