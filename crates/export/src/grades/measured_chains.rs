//! The chains of a network (roads joined end to end) with heights of the elevation files, and
//! smooth lines along them.

use std::{
    collections::{HashMap, HashSet, VecDeque},
    ops::Range,
};

use corniche_geom::{IndexLists, LatticePoint};
use corniche_network::{
    Breaks, Chain, ChainLengths, ChainNumber, Chains, Link, Network, NodeNumber,
};
use corniche_roads::Structure;
use corniche_work::{Observer, Stage};

use super::{
    junctions::{Leg, Legs, node_heights},
    smooth_line::{SmoothLine, Station, stations},
    smoothing::Smoothing,
    span_decks::SpanDecks,
};
use crate::{
    dem_ground::DemNodes,
    error::ElevationError,
    heights::Elevation,
    measures::between,
    places::Places,
    plane::{mix, steps_between},
};

/// Progress is reported after this many chains.
const TOLD_CHAINS: usize = 1024;

/// The chains of a network, cut where bridges and tunnels begin, with their heights.
pub(crate) struct MeasuredChains<'a> {
    pub(crate) network: &'a Network,
    pub(crate) places: &'a Places<'a>,
    chains: Chains,
    smoothing: Smoothing,
    lengths: ChainLengths,
    /// The index of the first station of each chain, and the total. Bridges and tunnels have no
    /// stations, nor do chains that do not affect what reaches the data.
    starts: Vec<usize>,
    /// The ground at all stations; NaN where there is none.
    grounds_m: Vec<f32>,
    /// The difference between the smooth line and the ground: rounding loses less of it than of
    /// heights.
    above_m: Vec<f32>,
    /// The height at each node; NaN if there is no shared height.
    nodes_m: Vec<f64>,
    /// The nodes at which rings without a junction begin.
    ring_nodes: HashSet<usize>,
    /// Bridges and tunnels, whose supports are at the height of the ground there.
    pub(crate) decks: SpanDecks,
    /// The nodes of chains that reach the data.
    is_reached: Vec<bool>,
    /// The distance of the first station from the ring's node, for each chain that is such a ring:
    /// the station's place does not depend on ways.
    ring_starts_m: HashMap<usize, f64>,
}

/// A chain with its points and their distances from its beginning.
struct Along {
    points: Vec<LatticePoint>,
    distances_m: Vec<f64>,
}

impl Along {
    fn from_points(places: &Places<'_>, points: Vec<LatticePoint>) -> Self {
        Self { distances_m: places.distances_m(points.iter().copied()), points }
    }

    fn length_m(&self) -> f64 {
        self.distances_m.last().copied().unwrap_or_default()
    }

    /// The distance of the point with the smallest coordinates.
    fn least_point_m(&self) -> f64 {
        let least = self.points.iter().zip(&self.distances_m).min_by_key(|(point, _)| **point);
        least.map_or(0.0, |(_, &distance_m)| distance_m)
    }

    /// Returns the place at a distance; distances must ascend from call to call. `after` is the
    /// index of the point after the previous place.
    fn at(&self, along_m: f64, after: &mut usize) -> [f64; 2] {
        while *after + 1 < self.points.len() && self.distances_m[*after] < along_m {
            *after += 1;
        }
        let [from, to] = [after.saturating_sub(1), *after];
        let ends = [from, to].map(|index| self.points[index].in_steps());
        let coordinate = |axis: usize| {
            let of = |index: usize| [self.distances_m[index], ends[index - from][axis]];
            between(of(from), of(to), along_m)
        };
        [coordinate(0), coordinate(1)]
    }
}

impl<'a> MeasuredChains<'a> {
    /// Reads the ground along all chains that reach the package's data, also beyond its bounds, and
    /// computes one height for each of their junctions.
    pub(crate) fn measure(
        network: &'a Network,
        places: &'a Places<'a>,
        Elevation { dem, plan }: Elevation<'_>,
        observer: &dyn Observer,
    ) -> Result<Self, ElevationError> {
        let manifest = places.manifest;
        let frame = &manifest.frame;
        // Roads beyond the bounds affect roads within.
        let plan = if plan.clip.is_some() { plan.of_whole_data() } else { plan.clone() };
        let nodes = &mut DemNodes::new(Elevation { dem, plan: &plan }, frame);
        let chains = Chains::from_network(network, Breaks::JunctionsAndStructures);
        let lengths = chains.lengths(network, &places.metric());
        let data = frame.lattice_bounds(manifest.data_nodes());
        let measured = (network, &chains, &lengths);
        let decks = SpanDecks::solve(measured, (places, &data), nodes, observer)?;
        let mut measured = Self {
            network,
            places,
            smoothing: Smoothing::of_frame(frame),
            lengths,
            is_reached: vec![false; network.node_count()],
            starts: vec![0],
            grounds_m: Vec::new(),
            above_m: Vec::new(),
            nodes_m: Vec::new(),
            ring_nodes: HashSet::new(),
            ring_starts_m: HashMap::new(),
            decks,
            chains,
        };
        let is_needed = measured.find_needed();
        let mut order = Vec::with_capacity(measured.chains.len());
        for number in measured.chains.numbers() {
            if !is_needed[number.0] {
                measured.starts.push(measured.starts[number.0]);
                continue;
            }
            let along = measured.along(number);
            let length_m = measured.lengths.chains_m[number.0];
            if measured.is_ring(number) {
                let node = measured.chains.get(number).ends[0];
                measured.ring_nodes.insert(network.index_of(node));
                measured.ring_starts_m.insert(number.0, along.least_point_m());
            }
            let own = if measured.is_on_ground(number) { stations(length_m) } else { 0 };
            measured.starts.push(measured.starts[number.0] + own);
            if own > 0 {
                // Neighbours are read in sequence, so that each height is read only once or twice.
                order.push((nodes.block_of(along.points[0].in_steps()), number));
            }
        }
        order.sort_unstable();
        let count = measured.starts.last().copied().unwrap_or_default();
        measured.grounds_m = vec![f32::NAN; count];
        observer.begin(Stage::ExportChains, Some(order.len() as u64));
        for some in order.chunks(TOLD_CHAINS) {
            for &(_, number) in some {
                measured.read_ground(number, nodes)?;
            }
            observer.check()?;
            observer.advance(Stage::ExportChains, some.len() as u64);
        }
        measured.nodes_m = node_heights(&measured, observer)?;
        // Lines are fixed at the beginning of bridges and tunnels. Otherwise both sides of a short
        // bridge would be smoothed separately, and the bridge would be steep.
        for &(node, height_m) in &measured.decks.supports {
            measured.nodes_m[network.index_of(node)] = height_m;
        }
        measured.above_m = vec![f32::NAN; count];
        for some in order.chunks(TOLD_CHAINS) {
            observer.check()?;
            for &(_, number) in some {
                measured.smooth(number);
            }
        }
        observer.end(Stage::ExportChains);
        Ok(measured)
    }

    /// Returns whether each chain affects what reaches the data: its edge reaches the data, or
    /// lines are smoothed into it from a node of an edge that does.
    fn find_needed(&mut self) -> Vec<bool> {
        let mut is_needed = vec![false; self.chains.len()];
        let mut along_m = vec![f64::INFINITY; self.network.node_count()];
        let mut waiting = VecDeque::new();
        let edges = Chains::from_network(self.network, Breaks::Junctions);
        for edge in edges.numbers().map(|number| edges.get(number)) {
            if !self.reaches(&edge) {
                continue;
            }
            for &link in edge.links {
                let (number, _) = self.chains.of_link(link);
                if std::mem::replace(&mut is_needed[number.0], true) {
                    continue;
                }
                for node in self.chains.get(number).ends.map(|node| self.network.index_of(node)) {
                    self.is_reached[node] = true;
                    along_m[node] = 0.0;
                    waiting.push_back(node);
                }
            }
        }
        let ends_at = self.chains.ends_at(self.network, |_| true);
        while let Some(node) = waiting.pop_front() {
            for &end in ends_at.list(node) {
                let number = end as usize / 2;
                is_needed[number] = true;
                let other = self.chains.get(ChainNumber(number)).ends[1 - end as usize % 2];
                let other = self.network.index_of(other);
                let other_m = along_m[node] + self.lengths.chains_m[number];
                if other_m < along_m[other] && other_m <= self.smoothing.length_m {
                    along_m[other] = other_m;
                    waiting.push_back(other);
                }
            }
        }
        is_needed
    }

    fn read_ground(
        &mut self,
        number: ChainNumber,
        nodes: &mut DemNodes<'_>,
    ) -> Result<(), ElevationError> {
        let along = self.along(number);
        let own = self.stations_of(number);
        let (mut after, last) = (0, own.len() - 1);
        let (length_m, start_m) = (along.length_m(), self.start_m(number));
        for k in 0..own.len() {
            let mut at_m = start_m + length_m * k as f64 / last as f64;
            if at_m > length_m {
                // On a ring, the first part comes last.
                (at_m, after) = (at_m - length_m, 0);
            }
            let at = match (k, along.points.last()) {
                // Exact to the last bit, so that all legs of a junction have the same ground there.
                (k, Some(end)) if k == last && start_m <= 0.0 => end.in_steps(),
                _ => along.at(at_m, &mut after),
            };
            if let Some(height_m) = nodes.height_m(at)? {
                self.grounds_m[own.start + k] = height_m as f32;
            }
        }
        Ok(())
    }

    fn stations_of(&self, ChainNumber(number): ChainNumber) -> Range<usize> {
        self.starts[number]..self.starts[number + 1]
    }

    /// The distance from one of a chain's stations to the next.
    fn spacing_m(&self, number: ChainNumber) -> f64 {
        self.lengths.chains_m[number.0] / (self.stations_of(number).len().max(2) - 1) as f64
    }

    fn is_on_ground(&self, number: ChainNumber) -> bool {
        self.network.structure_of(&self.chains.get(number)) == Structure::Ground
    }

    fn along(&self, number: ChainNumber) -> Along {
        Along::from_points(self.places, self.network.points_of_chain(&self.chains.get(number)))
    }

    fn smooth(&mut self, number: ChainNumber) {
        let own = self.stations_of(number);
        let grounds_m: Vec<f64> =
            self.grounds_m[own.clone()].iter().copied().map(f64::from).collect();
        let last = grounds_m.len() - 1;
        let spacing_m = self.spacing_m(number);
        if self.is_ring(number) && grounds_m.iter().all(|height_m| height_m.is_finite()) {
            let smooth_m = self.smoothing.solve_ring(spacing_m, &grounds_m[..last]);
            for (k, &ground_m) in grounds_m.iter().enumerate() {
                self.above_m[own.start + k] = (smooth_m[k % last] - ground_m) as f32;
            }
            return;
        }
        let ends = self.chains.get(number).ends;
        let held_m = ends.map(|node| self.node_m(node));
        let mut first = 0;
        while first <= last {
            let known = grounds_m[first..].iter().take_while(|height_m| height_m.is_finite());
            let end = first + known.count();
            if end > first {
                let held =
                    [held_m[0].filter(|_| first == 0), held_m[1].filter(|_| end == last + 1)];
                let smooth_m = self.smoothing.solve(spacing_m, &grounds_m[first..end], held);
                for (k, height_m) in smooth_m.iter().enumerate() {
                    let above_m = height_m - grounds_m[first + k];
                    self.above_m[own.start + first + k] = above_m as f32;
                }
                // The ground ends somewhere before the next station; up to there, the line
                // continues with its grade.
                let inner = |from: usize, before: usize| match smooth_m.get(before) {
                    Some(before_m) => 2.0 * smooth_m[from] - before_m,
                    None => smooth_m[from],
                };
                let count = end - first;
                if let Some(before) = first.checked_sub(1) {
                    self.go_on(own.start + before, inner(0, 1));
                }
                if end <= last {
                    self.go_on(own.start + end, inner(count - 1, count.wrapping_sub(2)));
                }
            }
            first = end.max(first + 1);
        }
    }

    /// Sets the height of the smooth line at a station without ground.
    fn go_on(&mut self, station: usize, height_m: f64) {
        if self.above_m[station].is_nan() {
            (self.grounds_m[station], self.above_m[station]) = (height_m as f32, 0.0);
        }
    }

    /// The distance of a chain's first station along it: 0, except for rings.
    fn start_m(&self, ChainNumber(number): ChainNumber) -> f64 {
        self.ring_starts_m.get(&number).copied().unwrap_or_default()
    }

    /// Whether a chain returns to its beginning without a junction there.
    fn is_ring(&self, number: ChainNumber) -> bool {
        let chain = self.chains.get(number);
        chain.is_closed() && self.network.degree(chain.ends[0]) == 2
    }

    /// Returns the ground and the smooth line at a distance along a chain, between its stations;
    /// NaN where there is none. Bridges and tunnels have their own heights.
    fn heights_at(&self, number: ChainNumber, at_m: f64) -> [f64; 2] {
        let own = self.stations_of(number);
        if own.is_empty() {
            return [self.decks.height_m(number, at_m).unwrap_or(f64::NAN); 2];
        }
        let last = own.len().max(2) - 1;
        let (length_m, start_m) = (self.lengths.chains_m[number.0], self.start_m(number));
        let at_m = if at_m < start_m { at_m - start_m + length_m } else { at_m - start_m };
        let place = (at_m / length_m * last as f64).clamp(0.0, last as f64);
        let station = (place.floor() as usize).min(last - 1);
        let share = place - station as f64;
        // A station without ground counts only if it has a weight.
        let ends = [station, station + 1].map(|station| own.start + station);
        let of = |heights_m: &[f32]| {
            let [from_m, to_m] = ends.map(|at| f64::from(heights_m[at]));
            mix(from_m, to_m, share)
        };
        let ground_m = of(&self.grounds_m);
        [ground_m, ground_m + of(&self.above_m)]
    }

    /// Returns the smooth lines of a way, with distances along it; in parts if heights are missing.
    /// For a bridge or a tunnel, the ground's height is that of its deck, as if no ground
    /// obstructed it.
    pub(crate) fn of_way(&self, way_id: i64) -> Vec<SmoothLine> {
        let mut lines = vec![SmoothLine::default()];
        let mut begin_m = 0.0;
        for road in self.network.roads_of(way_id) {
            // The parts of a way that was cut do not continue each other.
            lines.push(SmoothLine::default());
            for (number, index) in self.chains.of_road(&self.network.ways()[road]) {
                begin_m += self.add_stretch(number, index, begin_m, &mut lines);
            }
        }
        lines.retain(|line| line.stations.len() >= 2);
        lines
    }

    /// Adds the smooth line of a stretch, in the direction of its way. Returns its length.
    fn add_stretch(
        &self,
        number: ChainNumber,
        index: usize,
        begin_m: f64,
        lines: &mut Vec<SmoothLine>,
    ) -> f64 {
        let link = self.chains.get(number).links[index];
        let along = Along::from_points(self.places, self.network.points_of_link(link).collect());
        let own_m = along.length_m();
        // The stretch's own points, and the stations of the chain between them.
        let [from_m, _] = self.lengths.links_m[self.chains.place_of(number, index)];
        let stations = self.distances_within(number, [from_m, from_m + own_m]);
        let mut distances_m = along.distances_m.clone();
        let inner = stations.len() - 1;
        distances_m.extend(stations[1..inner].iter().map(|at_m| at_m - from_m));
        distances_m.sort_by(f64::total_cmp);
        distances_m.dedup();
        let mut after = 0;
        let mut own: Vec<Station> = distances_m
            .into_iter()
            .map(|at_m| {
                let [ground_m, height_m] = self.heights_at(number, from_m + at_m);
                let along_m = begin_m + if link.is_against { own_m - at_m } else { at_m };
                Station { at: along.at(at_m, &mut after), along_m, height_m, ground_m }
            })
            .collect();
        if link.is_against {
            own.reverse();
        }
        for station in own {
            let is_known = station.height_m.is_finite();
            match lines.last_mut() {
                Some(line) if is_known => {
                    let last = line.stations.last().map(|last| last.along_m);
                    if last.is_none_or(|last| last < station.along_m) {
                        line.stations.push(station);
                    }
                }
                _ => lines.push(SmoothLine::default()),
            }
        }
        own_m
    }

    /// Returns the smooth line of consecutive links: distances from their beginning, and heights;
    /// `None` if one is missing. For bridges and tunnels, `given` has the lines by link number,
    /// since the ground can obstruct their decks; those that are not given get the solved decks.
    pub(crate) fn profile(
        &self,
        links: &[Link],
        given: &HashMap<usize, Vec<[f64; 2]>>,
    ) -> Option<Vec<[f64; 2]>> {
        let mut profile: Vec<[f64; 2]> = Vec::new();
        let mut begin_m = 0.0;
        for (place, &link) in links.iter().enumerate() {
            let (number, index) = self.chains.of_link(link);
            let [from_m, _] = self.lengths.links_m[self.chains.place_of(number, index)];
            let own_m = self.link_m(link);
            let is_turned = self.chains.get(number).links[index].is_against != link.is_against;
            let own = given.get(&place).cloned().unwrap_or_else(|| {
                let within = self.distances_within(number, [from_m, from_m + own_m]);
                let place = |at_m| {
                    let [_, height_m] = self.heights_at(number, at_m);
                    let at_m = at_m - from_m;
                    [if is_turned { own_m - at_m } else { at_m }, height_m]
                };
                let mut own: Vec<[f64; 2]> = within.into_iter().map(place).collect();
                if is_turned {
                    own.reverse();
                }
                own
            });
            let own = own.into_iter().map(|[at_m, height_m]| [begin_m + at_m, height_m]);
            profile.extend(own.skip(usize::from(!profile.is_empty())));
            begin_m += own_m;
        }
        profile.iter().all(|[_, height_m]| height_m.is_finite()).then_some(profile)
    }

    /// The true length of a link in plan.
    pub(crate) fn link_m(&self, link: Link) -> f64 {
        self.places.length_m(self.network.points_of_link(link))
    }

    /// Returns two distances along a chain, and those of the stations between them; for a bridge or
    /// a tunnel, those of its bends.
    fn distances_within(&self, number: ChainNumber, [from_m, to_m]: [f64; 2]) -> Vec<f64> {
        if self.stations_of(number).is_empty() {
            let bends_m = self.decks.bends_m(number, [from_m, to_m]);
            return [from_m].into_iter().chain(bends_m).chain([to_m]).collect();
        }
        let (spacing_m, start_m) = (self.spacing_m(number), self.start_m(number));
        let first = ((from_m - start_m) / spacing_m).floor() as i64 + 1;
        let between = (first..).map(|k| start_m + k as f64 * spacing_m);
        let between = between.take_while(|&at_m| at_m < to_m);
        [from_m].into_iter().chain(between).chain([to_m]).collect()
    }

    /// The height of a node that several roads share; `None` for other nodes, and if it is unknown.
    pub(crate) fn node_m(&self, node: NodeNumber) -> Option<f64> {
        Some(self.nodes_m[self.network.index_of(node)]).filter(|height_m| height_m.is_finite())
    }

    /// Whether an edge of the network reaches the package's data.
    pub(crate) fn reaches(&self, chain: &Chain<'_>) -> bool {
        let manifest = self.places.manifest;
        self.network.reaches(chain, &manifest.frame.lattice_bounds(manifest.data_nodes()))
    }

    /// The smooth line of a link, in the direction of its way.
    pub(crate) fn of_link(&self, link: Link) -> Vec<SmoothLine> {
        let (number, index) = self.chains.of_link(link);
        let mut lines = vec![SmoothLine::default()];
        self.add_stretch(number, index, 0.0, &mut lines);
        lines
    }
}

impl Legs for MeasuredChains<'_> {
    fn by_node(&self) -> IndexLists {
        self.chains.ends_at(self.network, |number| self.is_on_ground(number))
    }

    fn is_alone(&self, node: usize) -> bool {
        let degree = self.network.degree_at(node);
        !self.is_reached[node] || degree < 2 || (degree == 2 && self.ring_nodes.contains(&node))
    }

    fn smoothing(&self) -> Smoothing {
        self.smoothing
    }

    fn leg(&self, Leg { chain, is_last }: Leg) -> (f64, Box<dyn Iterator<Item = f32> + '_>) {
        let grounds_m = &self.grounds_m[self.stations_of(ChainNumber(chain))];
        let spacing_m = self.spacing_m(ChainNumber(chain));
        if is_last {
            (spacing_m, Box::new(grounds_m.iter().rev().copied()))
        } else {
            (spacing_m, Box::new(grounds_m.iter().copied()))
        }
    }

    fn direction(&self, Leg { chain, is_last }: Leg) -> [f64; 2] {
        let mut points = self.network.points_of_chain(&self.chains.get(ChainNumber(chain)));
        if is_last {
            points.reverse();
        }
        // The direction of its first ten metres or so.
        let least_steps = 10.0 / self.places.manifest.frame.lattice_step_m();
        let from = points[0];
        let far = points.iter().find(|point| from.distance_steps(**point) >= least_steps);
        let to = far.unwrap_or(&points[points.len() - 1]);
        let run = steps_between(from, *to);
        let length = run[0].hypot(run[1]);
        if length > 0.0 { run.map(|part| part / length) } else { [0.0; 2] }
    }
}
