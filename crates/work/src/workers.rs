//! Worker threads: they work in parallel, and one writer takes their results in order.

use std::{
    collections::BTreeMap,
    sync::{Condvar, Mutex, PoisonError},
    thread,
};

use crate::{Interrupted, Observer, Stage, locked};

/// Works on each item with [`in_order`], and checks before each item whether `observer` cancels the
/// run.
///
/// # Errors
/// The errors of [`in_order`], or [`Interrupted`].
pub fn in_order_unless_cancelled<I: Sync, S, R: Send, E: Send + From<Interrupted>>(
    observer: &dyn Observer,
    threads: usize,
    items: &[I],
    start: impl Fn() -> Result<S, E> + Sync,
    work: impl Fn(&mut S, &I) -> Result<R, E> + Sync,
    mut take: impl FnMut(&I, R) -> Result<(), E>,
) -> Result<(), E> {
    let work = |state: &mut S, index: usize| {
        observer.check()?;
        work(state, &items[index])
    };
    in_order(threads, items.len(), start, work, |index, made| take(&items[index], made))
}

/// Works on the items of a stage that has begun, and reports the progress to `observer`. The
/// results are passed to `take` in the items' order.
///
/// # Errors
/// The errors of [`in_order_unless_cancelled`].
pub fn advance<I: Sync, S, R: Send, E: Send + From<Interrupted>>(
    (observer, stage): (&dyn Observer, Stage),
    threads: usize,
    items: &[I],
    start: impl Fn() -> Result<S, E> + Sync,
    work: impl Fn(&mut S, &I) -> Result<R, E> + Sync,
    mut take: impl FnMut(&I, R) -> Result<(), E>,
) -> Result<(), E> {
    in_order_unless_cancelled(observer, threads, items, start, work, |item, made| {
        take(item, made)?;
        observer.advance(stage, 1);
        Ok(())
    })
}

/// Does the same as [`advance`] for a whole stage, which begins and ends with it.
///
/// # Errors
/// The errors of [`in_order_unless_cancelled`].
pub fn side_by_side<I: Sync, S, R: Send, E: Send + From<Interrupted>>(
    (observer, stage): (&dyn Observer, Stage),
    threads: usize,
    items: &[I],
    start: impl Fn() -> Result<S, E> + Sync,
    work: impl Fn(&mut S, &I) -> Result<R, E> + Sync,
    take: impl FnMut(&I, R) -> Result<(), E>,
) -> Result<(), E> {
    observer.begin(stage, Some(items.len() as u64));
    advance((observer, stage), threads, items, start, work, take)?;
    observer.end(stage);
    Ok(())
}

/// Computes a result for each item of a stage that has begun, and reports the progress to
/// `observer`. The results are in the items' order.
///
/// # Errors
/// The errors of [`in_order_unless_cancelled`].
pub fn make_all<I: Sync, S, T: Send, E: Send + From<Interrupted>>(
    told: (&dyn Observer, Stage),
    threads: usize,
    items: &[I],
    start: impl Fn() -> Result<S, E> + Sync,
    work: impl Fn(&mut S, &I) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    let mut made = Vec::with_capacity(items.len());
    advance(told, threads, items, start, work, |_, one| {
        made.push(one);
        Ok(())
    })?;
    Ok(made)
}

/// Computes the `missing` items of `all` items of a stage, each with `work`, and reports the
/// progress to `observer`. `work` stores the results itself.
///
/// # Errors
/// The errors of [`in_order_unless_cancelled`].
pub fn make_missing<S, T: Sync, E: Send + From<Interrupted>>(
    observer: &dyn Observer,
    stage: Stage,
    threads: usize,
    (missing, all): (&[T], usize),
    start: impl Fn() -> Result<S, E> + Sync,
    work: impl Fn(&mut S, &T) -> Result<(), E> + Sync,
) -> Result<(), E> {
    observer.begin(stage, Some(all as u64));
    observer.already(stage, (all - missing.len()) as u64);
    advance((observer, stage), threads, missing, start, work, |_, ()| Ok(()))?;
    observer.end(stage);
    Ok(())
}

/// Runs a whole stage on the calling thread: `act` handles one item after the other, and `observer`
/// gets the progress and may cancel before each item.
///
/// # Errors
/// The first error of `act`, or [`Interrupted`].
pub fn one_by_one<I, E: From<Interrupted>>(
    (observer, stage): (&dyn Observer, Stage),
    items: &[I],
    mut act: impl FnMut(&I) -> Result<(), E>,
) -> Result<(), E> {
    observer.begin(stage, Some(items.len() as u64));
    for item in items {
        observer.check()?;
        act(item)?;
        observer.advance(stage, 1);
    }
    observer.end(stage);
    Ok(())
}

/// The state that the workers and the writer share.
struct Queue<R, E> {
    /// The next item for a worker.
    next: usize,
    /// Results that wait for their turn.
    done: BTreeMap<usize, Result<R, E>>,
    /// The next result for the writer.
    written: usize,
    /// Set when the run is over early.
    stop: bool,
}

/// Works on `count` items with `threads` threads and hands the results to `write` in the order of
/// the items, on the calling thread.
///
/// Each thread creates its own state with `start` (an open dataset, a cache). At most four results
/// per thread wait for their turn, so memory is bounded even if some items take much longer than
/// others. The first error stops everything. Results are read in order, so the first error does not
/// depend on timing.
///
/// # Errors
/// The first error, in the order of the items, of `start`, `work` or `write`.
pub fn in_order<S, R: Send, E: Send>(
    threads: usize,
    count: usize,
    start: impl Fn() -> Result<S, E> + Sync,
    work: impl Fn(&mut S, usize) -> Result<R, E> + Sync,
    mut write: impl FnMut(usize, R) -> Result<(), E>,
) -> Result<(), E> {
    let threads = threads.clamp(1, count.max(1));
    if threads == 1 {
        return on_this_thread(count, start, work, write);
    }
    let ahead = threads * 4;
    let queue: Mutex<Queue<R, E>> =
        Mutex::new(Queue { next: 0, done: BTreeMap::new(), written: 0, stop: false });
    let changed = Condvar::new();
    let lock = || locked(&queue);
    let worker = || {
        let mut state = None;
        loop {
            let index = {
                let mut queue = lock();
                while !queue.stop && queue.next < count && queue.next >= queue.written + ahead {
                    queue = changed.wait(queue).unwrap_or_else(PoisonError::into_inner);
                }
                if queue.stop || queue.next >= count {
                    return;
                }
                queue.next += 1;
                queue.next - 1
            };
            // A worker that panics must not leave the writer waiting for its result.
            let guard = StopOnDrop { stop: &|| lock().stop = true, changed: &changed };
            let ready = match &mut state {
                Some(_) => Ok(()),
                empty => start().map(|new| *empty = Some(new)),
            };
            let result = ready.and_then(|()| match &mut state {
                Some(state) => work(state, index),
                None => unreachable!("the state was made above"),
            });
            std::mem::forget(guard);
            lock().done.insert(index, result);
            changed.notify_all();
        }
    };
    thread::scope(|scope| {
        // The scope waits for all workers, so workers that wait for space must end, however the
        // writer ends.
        let _guard = StopOnDrop { stop: &|| lock().stop = true, changed: &changed };
        for _ in 0..threads {
            scope.spawn(worker);
        }
        for index in 0..count {
            let result = {
                let mut queue = lock();
                loop {
                    if let Some(result) = queue.done.remove(&index) {
                        break Some(result);
                    }
                    if queue.stop {
                        break None;
                    }
                    queue = changed.wait(queue).unwrap_or_else(PoisonError::into_inner);
                }
            };
            // A missing result means that a worker has panicked; leaving the scope passes the panic
            // on.
            let Some(result) = result else { return Ok(()) };
            let written = result.and_then(|result| write(index, result));
            let mut queue = lock();
            queue.written = index + 1;
            queue.stop |= written.is_err();
            drop(queue);
            changed.notify_all();
            written?;
        }
        Ok(())
    })
}

/// Does the same as `in_order` without other threads.
fn on_this_thread<S, R, E>(
    count: usize,
    start: impl Fn() -> Result<S, E>,
    work: impl Fn(&mut S, usize) -> Result<R, E>,
    mut write: impl FnMut(usize, R) -> Result<(), E>,
) -> Result<(), E> {
    let mut state = None;
    for index in 0..count {
        let state = match &mut state {
            Some(state) => state,
            empty => empty.insert(start()?),
        };
        write(index, work(state, index)?)?;
    }
    Ok(())
}

/// Stops all workers when it is dropped.
struct StopOnDrop<'a> {
    stop: &'a dyn Fn(),
    changed: &'a Condvar,
}

impl Drop for StopOnDrop<'_> {
    fn drop(&mut self) {
        (self.stop)();
        self.changed.notify_all();
    }
}

#[cfg(test)]
#[path = "workers_tests.rs"]
mod tests;
