//! The queue of candidates pops in the order of one heap.

use super::*;
use proptest::prelude::*;

proptest! {
    /// The order is that of one heap, also when candidates arrive in between.
    #[test]
    fn pops_like_one_heap(errors in prop::collection::vec((0.0_f64..1e4, any::<bool>()), 0..300)) {
        let (mut queue, mut heap) = (CandidateQueue::new(), BinaryHeap::new());
        let fresh = |candidate: Candidate| !candidate.node().is_multiple_of(5);
        let pop_fresh = |heap: &mut BinaryHeap<Candidate>| loop {
            match heap.pop() {
                Some(candidate) if !fresh(candidate) => {}
                other => return other,
            }
        };
        for (index, &(error_m, pop)) in errors.iter().enumerate() {
            let candidate = Candidate::new(error_m, index as u32, 7 * index as u32, 3);
            queue.push(candidate);
            heap.push(candidate);
            if pop {
                prop_assert_eq!(queue.pop(fresh), pop_fresh(&mut heap));
            }
        }
        while let Some(candidate) = pop_fresh(&mut heap) {
            prop_assert_eq!(queue.pop(fresh), Some(candidate));
        }
        prop_assert_eq!(queue.pop(fresh), None);
    }
}

#[test]
fn holds_what_it_was_made_of() {
    let candidate = Candidate::new(2.5, 1_000_000, u32::MAX, 17);
    assert_eq!((candidate.node(), candidate.face(), candidate.apex()), (1_000_000, u32::MAX, 17));
    assert!(Candidate::new(2.5, 3, 0, 0) > Candidate::new(2.5, 4, 9, 9));
}
