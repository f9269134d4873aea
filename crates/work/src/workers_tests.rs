//! Results come in order at any number of threads, and errors and panics are passed on.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::*;

/// Cancels the run at this number of checks.
struct CancelAfter(AtomicUsize);

impl Observer for CancelAfter {
    fn is_cancelled(&self) -> bool {
        let left =
            self.0.fetch_update(Ordering::SeqCst, Ordering::SeqCst, |left| left.checked_sub(1));
        left.is_err()
    }
}

fn run(threads: usize, fail_at: Option<usize>) -> (Vec<usize>, Result<(), usize>) {
    let mut seen = Vec::new();
    let result = in_order(
        threads,
        200,
        || Ok(0_usize),
        |_, index| {
            if index % 7 == 0 {
                thread::sleep(std::time::Duration::from_micros(300));
            }
            if fail_at.is_some_and(|at| index >= at) { Err(index) } else { Ok(index * 2) }
        },
        |index, value| {
            assert_eq!(value, index * 2);
            seen.push(index);
            Ok(())
        },
    );
    (seen, result)
}

#[test]
fn results_come_in_order_at_any_thread_count() {
    for threads in [1, 2, 8] {
        let (seen, result) = run(threads, None);
        assert_eq!(seen, (0..200).collect::<Vec<_>>());
        assert_eq!(result, Ok(()));
    }
}

#[test]
fn the_first_error_in_order_wins() {
    for threads in [1, 2, 8] {
        assert_eq!(run(threads, Some(63)).1, Err(63));
    }
}

#[test]
fn nothing_to_do_is_done() {
    let result = in_order(4, 0, || Ok(()), |(), _| Ok(()), |_, ()| Err("never called"));
    assert_eq!(result, Ok(()));
}

#[test]
#[should_panic(expected = "writer panics")]
fn a_panic_of_the_writer_does_not_leave_workers_waiting() {
    let _ = in_order(
        2,
        100,
        || Ok::<_, ()>(()),
        |(), index| Ok(index),
        |index, _| {
            assert!(index != 3, "writer panics");
            Ok(())
        },
    );
}

#[test]
#[should_panic(expected = "a scoped thread panicked")]
fn a_panic_of_a_worker_is_passed_on() {
    let _ = in_order(
        2,
        10,
        || Ok::<_, ()>(()),
        |(), index| {
            assert!(index != 5, "worker panics");
            Ok(())
        },
        |_, ()| Ok(()),
    );
}

#[test]
fn a_run_that_is_cancelled_writes_the_first_results_and_no_other() {
    for threads in [1, 2, 8] {
        let observer = CancelAfter(AtomicUsize::new(20));
        let mut written = Vec::new();
        let items: Vec<usize> = (0..100).collect();
        let result = in_order_unless_cancelled(
            &observer,
            threads,
            &items,
            || Ok::<_, Interrupted>(()),
            |(), index| Ok(*index),
            |_, index| {
                written.push(index);
                Ok(())
            },
        );
        assert_eq!(result, Err(Interrupted));
        assert!(written.len() <= 20, "{} items were written", written.len());
        assert_eq!(written, (0..written.len()).collect::<Vec<_>>());
    }
}
