//! The network of bridges, tunnels and the roads near them, with where along its road each stretch lies.

use std::{path::PathBuf, sync::Arc};

use corniche_drape::OwnedBorders;
use corniche_geom::{CoordinateTable, GridFrame, LatticeBounds, LatticePoint, wgs84};
use corniche_network::{Breaks, ChainNumber, Chains, Network, NetworkBuilder};
use corniche_spans::{Crossing, Decks, Distance, SpanKind, Spans, crossings};
use corniche_store::Artifacts;

use crate::{
    BuildError,
    layers::fixed_points::road_of_part,
    roads::near_spans::{self, NearRoad},
    true_lengths::pieces_um,
};

/// Where bridges and tunnels are found.
#[derive(Clone, Copy)]
pub(crate) struct SpanInputs<'a> {
    /// The extracts, for messages.
    pub(crate) osm: &'a [PathBuf],
    /// Holds the roads near spans, and the ground beneath them; takes the sections.
    pub(crate) store: &'a dyn Artifacts,
    pub(crate) frame: &'a GridFrame,
    pub(crate) coordinates: &'a CoordinateTable,
    /// Where roads end: the data's rectangle, or the bounds that were asked for.
    pub(crate) within: LatticeBounds,
}

/// A place along a road.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct OnRoad {
    /// The number of the road.
    pub(crate) ordinal: u32,
    /// How far along it, micrometres.
    pub(crate) along_um: u64,
}

/// Bridges and tunnels of a build, before their heights are known.
pub(crate) struct SpanNetwork {
    /// In the order of their roads, and along each.
    stretches: Vec<Stretch>,
    pub(crate) spans: Arc<Spans>,
    pub(crate) crossings: Vec<Crossing>,
}

/// A stretch of a bridge or a tunnel between two nodes at which roads may join.
struct Stretch {
    ordinal: u32,
    from_um: u64,
    to_um: u64,
    chain: ChainNumber,
    /// Where along the chain its ends lie, metres: those at `from_um` and `to_um`.
    on_chain_m: [f64; 2],
}

impl SpanNetwork {
    /// Finds the spans of the roads that were kept.
    pub(crate) fn load(inputs: &SpanInputs<'_>) -> Result<Self, BuildError> {
        let (network, places) = network(inputs)?;
        let chains = Chains::of(&network, Breaks::JunctionsAndStructures);
        let (frame, table) = (inputs.frame, inputs.coordinates);
        let degrees = |at| table.wgs84_from_working(frame.position_of_fraction_m(at));
        let distance_m = |from, to| wgs84::short_distance_m(degrees(from), degrees(to));
        let spans = Spans::find(&network, &chains, &distance_m);
        let crossings = crossings(&network, &chains, &distance_m)
            .map_err(|_| BuildError::ManyCrossings { osm: inputs.osm.to_vec() })?;
        let on_chains_m = links_on_chains(&network, &chains, &distance_m);
        let mut stretches = Vec::new();
        for (way, place) in network.ways().iter().zip(&places) {
            let mut from_um = place.from_um;
            let mut lengths_um = place.segments_um.iter();
            for (chain, index) in chains.of_road(way) {
                let link = chains.get(chain).links[index];
                let points = network.points_of_link(link).count();
                let to_um = from_um + lengths_um.by_ref().take(points - 1).sum::<u64>();
                let mut on_chain_m = on_chains_m[chains.place_of(chain, index)];
                if link.is_against {
                    on_chain_m.reverse();
                }
                if SpanKind::of(way.structure).is_some() {
                    let ordinal = place.ordinal;
                    stretches.push(Stretch { ordinal, from_um, to_um, chain, on_chain_m });
                }
                from_um = to_um;
            }
        }
        Ok(Self { stretches, spans: Arc::new(spans), crossings })
    }

    /// The chain at a place of a bridge or a tunnel, and how far along it the place is, metres.
    pub(crate) fn on_chain(&self, at: OnRoad) -> Option<(ChainNumber, f64)> {
        let after = self
            .stretches
            .partition_point(|own| (own.ordinal, own.from_um) <= (at.ordinal, at.along_um));
        let own = self.stretches.get(after.checked_sub(1)?)?;
        if own.ordinal != at.ordinal || own.to_um < at.along_um {
            return None;
        }
        Some((own.chain, own.along_m(at.along_um)))
    }

    /// Where bends of a deck between two places of a road lie along it, ascending; both are on one stretch.
    pub(crate) fn bends(
        &self,
        decks: &Decks,
        ordinal: u32,
        [from_um, to_um]: [u64; 2],
    ) -> Vec<u64> {
        let mut bends = Vec::new();
        let first =
            self.stretches.partition_point(|own| (own.ordinal, own.to_um) <= (ordinal, from_um));
        let own = self.stretches[first..]
            .iter()
            .take_while(|own| own.ordinal == ordinal && own.from_um < to_um);
        for stretch in own {
            let ends = [from_um, to_um].map(|um| um.clamp(stretch.from_um, stretch.to_um));
            let mut on_chain_m = ends.map(|um| stretch.along_m(um));
            on_chain_m.sort_by(f64::total_cmp);
            let found = decks.bends_m(stretch.chain, on_chain_m);
            bends.extend(found.into_iter().map(|at_m| stretch.along_um(at_m)));
            // Where two stretches meet, a deck may bend, too.
            bends.push(stretch.to_um);
        }
        bends.sort_unstable();
        bends.dedup();
        bends.retain(|&um| um > from_um && um < to_um);
        bends
    }

    /// For each of [`Decks::places`] where it is along a road.
    pub(crate) fn places(&self) -> Vec<Option<OnRoad>> {
        let mut by_chain: Vec<&Stretch> = self.stretches.iter().collect();
        by_chain.sort_by(|one, other| {
            let key = |own: &Stretch| (own.chain, own.on_chain_m[0].min(own.on_chain_m[1]));
            let ((chain, at_m), (others, others_m)) = (key(one), key(other));
            chain.cmp(&others).then(at_m.total_cmp(&others_m))
        });
        let place = |chain: ChainNumber, along_m: f64| {
            let after = by_chain.partition_point(|own| {
                let first_m = own.on_chain_m[0].min(own.on_chain_m[1]);
                own.chain < chain || (own.chain == chain && first_m <= along_m)
            });
            let own = by_chain.get(after.checked_sub(1)?).filter(|own| own.chain == chain)?;
            Some(OnRoad { ordinal: own.ordinal, along_um: own.along_um(along_m) })
        };
        let joints = self.spans.places_of_joints().map(|at| {
            let (chain, along_m) = at?;
            place(chain, along_m)
        });
        let of_crossing = |crossing: &Crossing| {
            let both = [crossing.upper, crossing.lower];
            let own = both.into_iter().find(|place| place.kind.is_some())?;
            place(own.chain, own.along_m)
        };
        joints.chain(self.crossings.iter().map(of_crossing)).collect()
    }

    /// The places of the joints.
    pub(crate) fn joints(&self) -> Vec<LatticePoint> {
        self.spans.joints().iter().map(|joint| joint.at).collect()
    }
}

impl Stretch {
    fn along_m(&self, along_um: u64) -> f64 {
        let [from_m, to_m] = self.on_chain_m;
        if along_um <= self.from_um {
            from_m
        } else if along_um >= self.to_um {
            to_m
        } else {
            let share = (along_um - self.from_um) as f64 / (self.to_um - self.from_um) as f64;
            from_m + share * (to_m - from_m)
        }
    }

    fn along_um(&self, along_m: f64) -> u64 {
        let [from_m, to_m] = self.on_chain_m;
        let share = ((along_m - from_m) / (to_m - from_m)).clamp(0.0, 1.0);
        self.from_um + (share * (self.to_um - self.from_um) as f64).round() as u64
    }
}

/// A road of the network: a piece of a road of the extract.
struct PlacedRoad {
    ordinal: u32,
    from_um: u64,
    segments_um: Vec<u64>,
}

/// The roads as a network, and what each of its roads is. They end where the data end, or the bounds that were asked for.
fn network(inputs: &SpanInputs<'_>) -> Result<(Network, Vec<PlacedRoad>), BuildError> {
    let mut builder = NetworkBuilder::default();
    let mut places = Vec::new();
    near_spans::for_each(inputs.store, |near| {
        let Some(road) = near.road() else { return };
        let NearRoad { ordinal, from_um, segments_um, .. } = near;
        if road.line.points().iter().all(|point| inputs.within.contains(*point)) {
            builder.push(&road);
            places.push(PlacedRoad { ordinal, from_um, segments_um });
            return;
        }
        for part in corniche_drape::clip_parts(&road.line, &inputs.within, OwnedBorders::ALL) {
            let pieces: Vec<[u64; 2]> = pieces_um(&road.line, &part, &segments_um).collect();
            let (Some(&first), Some(&[begin_um, _])) = (part.segments.first(), pieces.first())
            else {
                continue;
            };
            let before_um: u64 = segments_um[..first].iter().sum();
            places.push(PlacedRoad {
                ordinal,
                from_um: from_um + before_um + begin_um,
                segments_um: pieces.iter().map(|[from, to]| to - from).collect(),
            });
            builder.push(&road_of_part(&road, part));
        }
    })?;
    Ok((builder.finish(), places))
}

/// Where each link begins and ends along its chain, metres, by [`Chains::place_of`].
fn links_on_chains(network: &Network, chains: &Chains, distance_m: &Distance<'_>) -> Vec<[f64; 2]> {
    let mut all = Vec::with_capacity(chains.link_count());
    for chain in chains.numbers() {
        let mut along_m = 0.0;
        for &link in chains.get(chain).links {
            let from_m = along_m;
            let points: Vec<LatticePoint> = network.points_of_link(link).collect();
            for [from, to] in points.array_windows() {
                along_m += distance_m(from.in_steps(), to.in_steps());
            }
            all.push([from_m, along_m]);
        }
    }
    all
}
