//! Work on many things, such as tiles, by several threads.

use std::sync::{
    atomic::{AtomicBool, AtomicUsize, Ordering},
    mpsc,
};

use crate::{
    error::ExportError,
    observer::{Observer, Stage, stop_if_asked},
};

/// Who is told how far items are.
#[derive(Clone, Copy)]
pub(crate) struct Progress<'a> {
    pub(crate) observer: &'a dyn Observer,
    pub(crate) stage: Stage,
    /// Items that were done before.
    pub(crate) done: u64,
    /// All items, those included.
    pub(crate) total: u64,
}

/// Makes something of each item; the results are in the items' order. Each thread begins with a state of its own: PROJ's objects, for example, belong
/// to one thread each.
pub(crate) fn on_all<I: Sync, S, T: Send>(
    items: &[I],
    threads: usize,
    Progress { observer, stage, done, total }: Progress<'_>,
    begin: impl Fn() -> Result<S, ExportError> + Sync,
    make: impl Fn(&mut S, &I) -> Result<T, ExportError> + Sync,
) -> Result<Vec<T>, ExportError> {
    let (next, is_stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
    let work = |send: &mpsc::SyncSender<Result<(usize, T), ExportError>>| {
        let mut state = match begin() {
            Ok(state) => state,
            Err(failure) => {
                is_stopped.store(true, Ordering::Relaxed);
                // Nobody listens only where all is over.
                let _ = send.send(Err(failure));
                return;
            }
        };
        while !is_stopped.load(Ordering::Relaxed) {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(number) else { return };
            if send.send(make(&mut state, item).map(|made| (number, made))).is_err() {
                return;
            }
        }
    };
    let mut made: Vec<Option<T>> = items.iter().map(|_| None).collect();
    let mut first_failure = None;
    std::thread::scope(|scope| {
        let threads = threads.clamp(1, items.len().max(1));
        let (send, receive) = mpsc::sync_channel(threads);
        for _ in 0..threads {
            let (send, work) = (send.clone(), &work);
            scope.spawn(move || work(&send));
        }
        drop(send);
        for (count, result) in receive.iter().enumerate() {
            match result {
                Ok((number, result)) => made[number] = Some(result),
                Err(failure) => {
                    first_failure.get_or_insert(failure);
                }
            }
            observer.done(stage, done + count as u64 + 1, total);
            if let Err(stopped) = stop_if_asked(observer) {
                first_failure.get_or_insert(stopped);
            }
            if first_failure.is_some() {
                is_stopped.store(true, Ordering::Relaxed);
            }
        }
    });
    match first_failure {
        Some(failure) => Err(failure),
        None => Ok(made.into_iter().flatten().collect()),
    }
}
