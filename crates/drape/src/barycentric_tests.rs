//! The comparison of the exits from a triangle by the orientation of its apex agrees with products
//! of 256 bits.

use std::collections::BTreeMap;

use super::*;
use crate::oracle_tests::exact::{Along, END, area, wide_product};
use corniche_testing::Random;
use proptest::prelude::*;

/// The position of a segment relative to a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Lie {
    /// The segment is anywhere, near or far.
    Anywhere,
    /// A corner is on the segment, or on its line before or beyond it.
    CornerOnLine,
    /// An edge is parallel to the segment.
    ParallelEdge,
    /// An edge is on the segment's line.
    EdgeOnLine,
    /// The segment begins or ends at a corner.
    EndAtCorner,
    /// The segment begins or ends on an edge or on its line.
    EndOnEdge,
}

impl Lie {
    const ALL: [Self; 6] = [
        Self::Anywhere,
        Self::CornerOnLine,
        Self::ParallelEdge,
        Self::EdgeOnLine,
        Self::EndAtCorner,
        Self::EndOnEdge,
    ];
}

/// A counter-clockwise triangle and a segment.
#[derive(Debug)]
struct Case {
    lie: Lie,
    corners: [LatticePoint; 3],
    segment: [LatticePoint; 2],
}

impl Case {
    /// Creates a random case; `None` if the random points do not form a triangle and a segment.
    fn new(seed: u64) -> Option<Self> {
        let mut random = Random::new(seed);
        let lie = random.one_of(&Lie::ALL);
        // Coordinates range from some steps to nearly the whole lattice that draping allows.
        let reach = random.one_of(&[2, 3, 5, 40, 1 << 15, 1 << 31, 1 << 40, 1 << 56]);
        let mut point = || LatticePoint::new(random.around(reach), random.around(reach));
        let [mut p, mut q] = [point(), point()];
        let mut corners = [point(), point(), point()];
        let step = point();
        let on = |from: LatticePoint, times: i64| {
            LatticePoint::new(from.u + step.u * times, from.v + step.v * times)
        };
        match lie {
            Lie::Anywhere => {}
            Lie::CornerOnLine => {
                q = on(p, 1 + random.below(4));
                corners[2] = on(p, random.around(5));
            }
            Lie::ParallelEdge => {
                q = on(p, 1 + random.below(4));
                corners[2] = on(corners[1], random.around(4));
            }
            Lie::EdgeOnLine => {
                q = on(p, 1 + random.below(4));
                corners[1] = on(p, random.around(5));
                corners[2] = on(p, random.around(5));
            }
            Lie::EndAtCorner => p = corners[0],
            Lie::EndOnEdge => {
                corners[1] = on(corners[0], 1 + random.below(4));
                p = on(corners[0], random.around(5));
            }
        }
        if random.below(2) == 0 {
            std::mem::swap(&mut p, &mut q);
        }
        corners.rotate_left(random.below(3) as usize);
        let [a, b, c] = corners;
        match area(a, b, c).cmp(&0) {
            Ordering::Equal => return None,
            Ordering::Greater => {}
            Ordering::Less => corners = [a, c, b],
        }
        (p != q).then_some(Self { lie, corners, segment: [p, q] })
    }

    /// The coordinate of a corner.
    fn coordinate(&self, corner: usize) -> Barycentric {
        Barycentric::new(
            self.segment,
            [self.corners[(corner + 1) % 3], self.corners[(corner + 2) % 3]],
        )
    }

    /// The coordinate at a point, computed independently.
    fn at(&self, corner: usize, point: LatticePoint) -> i128 {
        area(self.corners[(corner + 1) % 3], self.corners[(corner + 2) % 3], point)
    }

    fn rate(&self, corner: usize) -> i128 {
        self.at(corner, self.segment[1]) - self.at(corner, self.segment[0])
    }

    /// The position where the segment's line exits across the edge opposite a corner.
    fn exit(&self, corner: usize) -> Option<Along> {
        let rate = self.rate(corner);
        (rate < 0).then(|| Along::new(self.at(corner, self.segment[0]), -rate))
    }

    /// Checks the coordinates and each comparison of two exits; counts pairs of exits, and equal
    /// pairs.
    fn check_pairs(&self) -> [u64; 2] {
        let [p, q] = self.segment;
        let doubled_area = area(self.corners[0], self.corners[1], self.corners[2]);
        for point in [p, q] {
            assert_eq!((0..3).map(|corner| self.at(corner, point)).sum::<i128>(), doubled_area);
        }
        let (mut pairs, mut equal) = (0, 0);
        for apex in 0..3 {
            let (first, second) = ((apex + 1) % 3, (apex + 2) % 3);
            let coordinate = self.coordinate(first);
            assert_eq!(coordinate.at(p), self.at(first, p));
            assert_eq!(coordinate.rate(), self.rate(first));
            let side = area(p, q, self.corners[apex]).cmp(&0);
            assert_eq!(turn(self.segment[0], self.segment[1], self.corners[apex]), side);
            // The signs of the identity in the proof.
            let left = wide_product(self.at(first, p), self.rate(second));
            assert_eq!(left.cmp(&wide_product(self.at(second, p), self.rate(first))), side);
            let Some(exit) = self.exit(first) else { continue };
            assert_eq!(coordinate.sign_at_end(), exit.cmp(&END));
            if let Some(other) = self.exit(second) {
                assert_eq!(other.cmp(&exit), side);
                assert_eq!(self.coordinate(second).zero().cmp(&coordinate.zero()), side);
                pairs += 1;
                equal += u64::from(side.is_eq());
            }
        }
        [pairs, equal]
    }

    /// Checks the exit from the triangle if the segment's line enters across the interior of an
    /// edge: the apex determines which of all exits is the smallest one ahead. Counts these cases,
    /// and those through the apex.
    fn check_way(&self) -> [u64; 2] {
        let [p, q] = self.segment;
        let (mut ways, mut through_apex) = (0, 0);
        for apex in 0..3 {
            let (start, end) = ((apex + 1) % 3, (apex + 2) % 3);
            if area(p, q, self.corners[start]) <= 0 || area(p, q, self.corners[end]) >= 0 {
                continue;
            }
            let entry = Along::new(self.at(apex, p), -self.rate(apex));
            let exits = [start, end, apex].map(|corner| self.exit(corner));
            let smallest = exits.into_iter().flatten().filter(|&exit| exit > entry).min();
            let first: Vec<usize> = [start, end, apex]
                .into_iter()
                .filter(|&corner| smallest.is_some() && self.exit(corner) == smallest)
                .collect();
            let expected = match turn(self.segment[0], self.segment[1], self.corners[apex]) {
                Ordering::Greater => vec![start],
                Ordering::Less => vec![end],
                Ordering::Equal => vec![start, end],
            };
            assert_eq!(first, expected);
            ways += 1;
            through_apex += u64::from(expected.len() == 2);
        }
        [ways, through_apex]
    }

    /// Checks the exit for a start in the interior of the triangle: if the orientations of two
    /// corners change from right to left, the edge between them has the smallest of the three
    /// exits. Counts these starts.
    fn check_from_inside(&self) -> u64 {
        let [p, q] = self.segment;
        if (0..3).any(|corner| self.at(corner, p) <= 0) {
            return 0;
        }
        let smallest = (0..3).filter_map(|corner| self.exit(corner)).min();
        let sides = self.corners.map(|corner| turn(p, q, corner));
        for corner in 0..3 {
            let (start, end) = (sides[(corner + 1) % 3], sides[(corner + 2) % 3]);
            assert_eq!(
                self.exit(corner).is_some() && self.exit(corner) == smallest,
                start.is_le() && end.is_ge()
            );
        }
        1
    }

    fn check(&self) -> Counts {
        let ([pairs, equal], [ways, through_apex]) = (self.check_pairs(), self.check_way());
        Counts { cases: 1, pairs, equal, ways, through_apex, inside: self.check_from_inside() }
    }
}

/// The numbers of checks.
#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    cases: u64,
    pairs: u64,
    equal: u64,
    ways: u64,
    through_apex: u64,
    inside: u64,
}

impl Counts {
    fn plus(self, other: Self) -> Self {
        Self {
            cases: self.cases + other.cases,
            pairs: self.pairs + other.pairs,
            equal: self.equal + other.equal,
            ways: self.ways + other.ways,
            through_apex: self.through_apex + other.through_apex,
            inside: self.inside + other.inside,
        }
    }
}

#[test]
fn the_apex_compares_the_exits() {
    let mut all: BTreeMap<Lie, Counts> = BTreeMap::new();
    for seed in 0..30_000 {
        let Some(case) = Case::new(seed) else { continue };
        let Ok(found) = std::panic::catch_unwind(|| case.check()) else {
            panic!("case {seed}: {case:?}");
        };
        let sum = all.entry(case.lie).or_default();
        *sum = sum.plus(found);
    }
    for lie in Lie::ALL {
        let counts = all[&lie];
        assert!(counts.cases > 2000, "{lie:?}: {all:?}");
        // There is no exit across an edge along the line.
        let has_parallel = [Lie::ParallelEdge, Lie::EdgeOnLine].contains(&lie);
        assert!(has_parallel || counts.pairs > 1000, "{lie:?}: {all:?}");
        assert!(lie == Lie::EdgeOnLine || counts.ways > 500, "{lie:?}: {all:?}");
        assert!(lie != Lie::Anywhere || counts.inside > 100, "{lie:?}: {all:?}");
        let meets_corner = [Lie::CornerOnLine, Lie::EndAtCorner].contains(&lie);
        assert!(!meets_corner || counts.equal.min(counts.through_apex) > 500, "{lie:?}: {all:?}");
    }
}

proptest! {
    /// The same check for seeds that proptest chooses.
    #[test]
    fn the_apex_compares_the_exits_for_any_seed(seed in any::<u64>()) {
        if let Some(case) = Case::new(seed) {
            case.check();
        }
    }
}
