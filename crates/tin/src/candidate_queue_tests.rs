//! The queue of candidates has the order of a single heap.

use super::*;
use proptest::prelude::*;

proptest! {
    /// The order is that of a single heap, even if candidates are added in between.
    #[test]
    fn pops_like_one_heap(errors in prop::collection::vec((0.0_f32..1e4, any::<bool>()), 0..300)) {
        let (mut queue, mut heap) = (CandidateQueue::new(), BinaryHeap::new());
        let fresh = |candidate: Candidate| !candidate.face().is_multiple_of(5);
        let pop_fresh = |heap: &mut BinaryHeap<Candidate>| loop {
            match heap.pop() {
                Some(candidate) if !fresh(candidate) => {}
                other => return other,
            }
        };
        for (index, &(error_m, pop)) in errors.iter().enumerate() {
            let candidate = Candidate::new(error_m, 7 * index as u32);
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
    let candidate = Candidate::new(2.5, u32::MAX);
    assert_eq!((candidate.far_m(), candidate.face()), (2.5, u32::MAX));
    assert!(Candidate::new(2.5, 3) > Candidate::new(2.5, 4));
    assert!(Candidate::new(2.5, 3) < Candidate::new(2.75, 4));
}
