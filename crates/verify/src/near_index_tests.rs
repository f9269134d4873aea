//! Queries of the index find the same boxes as a scan.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use corniche_geom::StepBudget;
use corniche_testing::Random;

use super::NearIndex;

/// The index finds all boxes that a scan of all boxes finds, in any number; of many boxes, it
/// returns few others.
#[test]
fn all_that_lie_there_are_found() {
    let mut random = Random::new(7);
    for count in [0, 1, 32, 33, 2000] {
        let mut place = || [random.share() * 1000.0, random.share() * 1000.0];
        let boxes: Vec<[[f64; 2]; 2]> = (0..count)
            .map(|_| {
                let [u, v] = place();
                let [du, dv] = place();
                [[u, v], [u + du / 50.0, v - dv / 50.0]]
            })
            .collect();
        let index = NearIndex::new(boxes.iter().copied());
        for _ in 0..50 {
            let (asked, reach) = ([place(), place()], 3.0);
            let is_there = |axis: usize, of: [[f64; 2]; 2]| {
                let [low, high] = [f64::min, f64::max].map(|pick| pick(of[0][axis], of[1][axis]));
                let [from, to] =
                    [f64::min, f64::max].map(|pick| pick(asked[0][axis], asked[1][axis]));
                low <= to + reach && high >= from - reach
            };
            let scanned: Vec<usize> = (0..count)
                .filter(|&number| is_there(0, boxes[number]) && is_there(1, boxes[number]))
                .collect();
            let work = StepBudget::unlimited();
            let mut found: Vec<usize> = index.near(asked, reach, &work).collect();
            found.sort_unstable();
            assert_eq!(work.done(), found.len() as u64);
            if count > 32 {
                assert_eq!(found, scanned);
            } else {
                assert!(scanned.iter().all(|number| found.contains(number)));
            }
        }
    }
}
