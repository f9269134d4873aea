//! The heights of decks and tunnels.

use std::{collections::BTreeSet, sync::Arc};

use corniche_network::{ChainNumber, NodeNumber};

use crate::{
    crossings::{Crossing, CrossingPlace, Order},
    harmonic::Harmonic,
    lifts::{OnEdge, Reach, Tent, put_up},
    spans::{Edge, Joint, SpanKind, SpanProblem, SpanReason, Spans},
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
/// What is nearer to an end of an edge is at it, metres.
const END_M: f64 = 1e-6;
/// What is shorter has no grade, metres.
const SHORTEST_M: f64 = 1.0;
/// Less is no reason to lift, metres.
const ENOUGH_M: f64 = 1e-6;

/// How much room there is between what crosses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeHeight {
    /// The crossing.
    pub crossing: Crossing,
    /// How far the upper is above the lower, metres; `None` where a height is not known, or which is which.
    pub free_m: Option<f64>,
}

/// How high bridges and tunnels are.
#[derive(Debug)]
pub struct Decks {
    spans: Arc<Spans>,
    /// The height of each joint, NaN where it is not known.
    joints_m: Vec<f64>,
    /// The tents on each edge.
    tents: Vec<Vec<Tent>>,
    /// The crossings, in their order.
    free_heights: Vec<FreeHeight>,
    problems: Vec<SpanProblem>,
}

impl Decks {
    /// The places of the lattice whose ground [`Decks::solve`] needs, in this order.
    pub fn places(spans: &Spans, crossings: &[Crossing]) -> impl Iterator<Item = [f64; 2]> {
        let joints = spans.joints.iter().map(|joint| joint.at.in_steps());
        joints.chain(crossings.iter().map(|crossing| crossing.at))
    }

    /// Solves the heights of spans over the ground, whose heights at [`Decks::places`] are given; `None` where there is none.
    ///
    /// At supports they are the ground's; between them they are harmonic along the chains, which for two supports is a straight line. At crossings
    /// bridges are lifted and tunnels lowered until there is a metre between them and what they cross, with flanks no steeper than roads of that
    /// kind are built, less what the span itself has, and 2 % at least; 0.3 m are always made.
    #[must_use]
    pub fn solve(spans: Arc<Spans>, crossings: &[Crossing], grounds_m: &[Option<f64>]) -> Self {
        let (of_joints_m, of_crossings_m) = grounds_m.split_at(spans.joints.len());
        let mut problems = spans.problems();
        let held = |(number, (joint, own_m)): (usize, (&Joint, &Option<f64>))| {
            if joint.support.is_none() {
                return f64::NAN;
            }
            if own_m.is_none() {
                let way_id = spans.way_of_joint(number);
                problems.push(SpanProblem { reason: SpanReason::NoGround, way_id });
            }
            own_m.unwrap_or(f64::NAN)
        };
        let held_m: Vec<f64> = spans.joints.iter().zip(of_joints_m).enumerate().map(held).collect();
        let joints_m = solved(&spans, &held_m);
        problems.extend(too_intricate(&spans, &held_m, &joints_m));
        let mut decks = Self {
            joints_m,
            tents: vec![Vec::new(); spans.edges.len()],
            spans,
            free_heights: Vec::with_capacity(crossings.len()),
            problems,
        };
        decks.lift(crossings, of_crossings_m, &held_m);
        decks.judge(crossings, of_crossings_m);
        decks.judge_grades();
        decks
    }

    /// The same decks on another ground, as coarse levels have it, whose heights at the joints are given: solved anew, with the lifts that they have.
    #[must_use]
    pub fn on(&self, grounds_m: &[Option<f64>]) -> Self {
        let joints = self.spans.joints.iter().zip(grounds_m);
        let held_m: Vec<f64> = joints
            .map(|(joint, own_m)| own_m.filter(|_| joint.support.is_some()).unwrap_or(f64::NAN))
            .collect();
        Self {
            joints_m: solved(&self.spans, &held_m),
            tents: self.tents.clone(),
            spans: Arc::clone(&self.spans),
            free_heights: Vec::new(),
            problems: Vec::new(),
        }
    }

    /// The nodes at which spans are carried, with their heights; those without ground are left out.
    pub fn supports(&self) -> impl Iterator<Item = (NodeNumber, f64)> + '_ {
        let all = self.spans.joints.iter().zip(&self.joints_m);
        all.filter(|(joint, height_m)| joint.support.is_some() && height_m.is_finite())
            .map(|(joint, &height_m)| (joint.node, height_m))
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

    /// What is to be told of spans, in order.
    #[must_use]
    pub fn problems(&self) -> &[SpanProblem] {
        &self.problems
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
            let count = (length_m / STATION_M).ceil();
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
        // Which of both makes room: the bridge; of two tunnels, and beneath the ground, the lower one. A bridge over a tunnel has the ground between.
        let moved = |crossing: &Crossing| match (crossing.upper.kind, crossing.lower.kind) {
            (Some(SpanKind::Bridge), Some(SpanKind::Tunnel)) => None,
            (Some(SpanKind::Bridge), _) => Some((crossing.upper, crossing.lower)),
            _ => Some((crossing.lower, crossing.upper)),
        };
        let known = |(number, crossing): (usize, &Crossing)| {
            let (own, other) = moved(crossing).filter(|_| crossing.order == Order::Known)?;
            let edge = self.spans.edge_of(own.chain)?;
            let at = OnEdge { edge, along_m: own.along_m };
            let ground_m = grounds_m[number].unwrap_or(f64::NAN);
            Some((at, own, other, ground_m))
        };
        let mut all: Vec<_> = crossings.iter().enumerate().filter_map(known).collect();
        all.sort_by_key(|(_, own, ..)| own.layer.unsigned_abs());
        let grades = self.median_grades();
        let is_held = |joint: usize| held_m[joint].is_finite();
        for _ in 0..MOST_PASSES {
            let mut is_changed = false;
            for (at, own, other, ground_m) in &all {
                let edge = &self.spans.edges[at.edge];
                let away = edge.kind.away();
                let other_m = self.crossing_m(other, *ground_m);
                let [raised_m, base_m] = [self.raised_m(*at), self.base_m(*at)];
                let room_m = away * (raised_m - other_m);
                if room_m.is_nan() || room_m >= FREE_HEIGHT_M - ENOUGH_M {
                    continue;
                }
                let Some(reach) = Reach::of(&self.spans, &is_held, *at) else { continue };
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

    /// Says what there is between what crosses.
    fn judge(&mut self, crossings: &[Crossing], grounds_m: &[Option<f64>]) {
        for (crossing, ground_m) in crossings.iter().zip(grounds_m) {
            let own = [crossing.upper, crossing.lower];
            let way_id =
                own.iter().filter(|place| place.kind.is_some()).map(|place| place.way_id).min();
            // Where there is no ground, two bridges have their heights yet.
            let ground_m = ground_m.unwrap_or(f64::NAN);
            let [upper_m, lower_m] = own.map(|place| self.crossing_m(&place, ground_m));
            let free_m = Some(upper_m - lower_m)
                .filter(|free_m| free_m.is_finite() && crossing.order == Order::Known);
            let reason = match free_m {
                _ if crossing.order == Order::Tie => Some(SpanReason::LayerTie),
                Some(free_m) if free_m < 0.0 => Some(SpanReason::OrderReversed),
                Some(free_m) if free_m < FREE_HEIGHT_M - ENOUGH_M => {
                    Some(SpanReason::OrderUnreachable)
                }
                _ => None,
            };
            let problem = reason.zip(way_id).map(|(reason, way_id)| SpanProblem { reason, way_id });
            self.problems.extend(problem);
            self.free_heights.push(FreeHeight { crossing: *crossing, free_m });
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
                length_m > SHORTEST_M && rise_m > edge.steepest * length_m
            });
            if is_steep {
                steep.insert(edge.way_id);
            }
        }
        let problem = |way_id| SpanProblem { reason: SpanReason::GradeOverLimit, way_id };
        self.problems.extend(steep.into_iter().map(problem));
        self.problems.sort_unstable();
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
    let problem = |way_id| SpanProblem { reason: SpanReason::TooIntricate, way_id };
    ways.into_iter()
        .filter(|(_, is_carried)| *is_carried)
        .filter_map(|(way_id, _)| way_id)
        .map(problem)
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
#[path = "decks_tests.rs"]
mod tests;
