//! Ctrl-C and other signals that ask a program to end, and the end of the process that started it. The run stops as soon as it
//! asks, and cleans up. If it does not ask, because it waits in a read that never returns, or if a second signal comes, the
//! program cleans up and ends at once.
//!
//! ```text
//!   first signal, or parent gone ─► noted ─┬─ asked for within half a second: the run ends itself, in ten seconds at most
//!                                          └─ not asked for: the program removes temporary files and exits
//!   second signal ─► the program removes temporary files and exits
//! ```

use std::{
    fs,
    path::{Path, PathBuf},
    sync::{
        Mutex, MutexGuard, OnceLock,
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
    thread,
    time::Duration,
};

use corniche_work::locked;

use crate::{exit::ExitCode, failure::Failure, messages};

/// What asks the program to end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Cause {
    /// A signal.
    Signal,
    /// The process that started this one is gone.
    ParentGone,
}

/// The program was asked to end.
static NOTED: AtomicBool = AtomicBool::new(false);
/// What ended the run; set before `NOTED`.
static CAUSE: OnceLock<Cause> = OnceLock::new();
/// The run knows of it.
static SEEN: AtomicBool = AtomicBool::new(false);
/// What is removed when the program ends early: temporary files and folders beside targets. It is locked for as long as they are removed, so
/// that who spares one before it is moved does so before that or never.
static TEMPORARY: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Where the intermediate results of the run are, which stay.
static KEPT: Mutex<Option<PathBuf>> = Mutex::new(None);

/// A run that can stop asks more often than this.
const ASKS_WITHIN: Duration = Duration::from_millis(500);
/// What a run may take to stop and clean up.
const STOPS_WITHIN: Duration = Duration::from_secs(10);

/// From now on a signal is noted instead of ending the program at once.
pub(crate) fn watch() -> Result<(), Failure> {
    ctrlc::set_handler(|| note(Cause::Signal))?;
    spare_from_file_limits()
}

/// Notes that the program is to end, and sees to it that it does.
pub(crate) fn note(cause: Cause) {
    // The first cause is the one that is told.
    let _ = CAUSE.set(cause);
    if NOTED.swap(true, Ordering::SeqCst) {
        if cause == Cause::Signal {
            end();
        }
        return;
    }
    thread::spawn(|| {
        thread::sleep(ASKS_WITHIN);
        if SEEN.load(Ordering::SeqCst) {
            thread::sleep(STOPS_WITHIN);
        }
        end();
    });
}

/// A run that ended because the process that started it is gone says so; other failures stay what they are.
pub(crate) fn explain(failure: Failure) -> Failure {
    match CAUSE.get() {
        Some(Cause::ParentGone) if failure.code() == ExitCode::Interrupted => reason(),
        _ => failure,
    }
}

/// Why the program ends early.
fn reason() -> Failure {
    match CAUSE.get() {
        Some(Cause::ParentGone) => Failure::failed(
            "standard input has ended, so the process that started this one is gone (--die-with-parent); what was done of \
             a part is kept, and the same command goes on from there",
        ),
        Some(Cause::Signal) | None => Failure::interrupted(),
    }
}

/// Whether the program was asked to end.
pub(crate) fn is_noted() -> bool {
    let is_noted = NOTED.load(Ordering::SeqCst);
    if is_noted {
        SEEN.store(true, Ordering::SeqCst);
    }
    is_noted
}

/// A temporary file or folder, which is removed when the program ends early. It may be gone already.
pub(crate) fn remove_at_end(path: &Path) {
    temporary().push(path.to_path_buf());
}

/// These are not removed any more when the program ends early. Where it is about to end and removes them, this does not return.
pub(crate) fn spare(paths: &[&Path]) {
    temporary().retain(|path| !paths.contains(&&**path));
}

/// What is removed when the program ends early, for as long as no other thread may change that.
pub(crate) fn temporary() -> MutexGuard<'static, Vec<PathBuf>> {
    locked(&TEMPORARY)
}

/// A folder of intermediate results, from which the same run can go on. It stays when the program ends early, and the user is told.
pub(crate) fn keep(path: &Path) {
    *locked(&KEPT) = Some(path.to_path_buf());
}

fn end() -> ! {
    // Held until the program is gone.
    let temporary = temporary();
    // Other threads are still at work and may add files while a folder is emptied, so it is tried again.
    for _ in 0..3 {
        // What was begun first says whose the rest is, so it goes last.
        for path in temporary.iter().rev() {
            let _ = match path.symlink_metadata() {
                Ok(found) if found.is_dir() => fs::remove_dir_all(path),
                Ok(_) => fs::remove_file(path),
                Err(_) => Ok(()),
            };
        }
    }
    // A message can wait for ever when the reader of a full pipe has stopped, so it gets a limited time.
    let (said, waits) = mpsc::channel();
    let code = i32::from(reason().code().number());
    thread::spawn(move || {
        let kept = locked(&KEPT).clone();
        if let Some(kept) = kept.filter(|kept| kept.exists()) {
            messages::warning(&format!(
                "what was done is kept in {}; the same command with --resume goes on from there, with -O it starts again",
                kept.display()
            ));
        }
        let reason = reason();
        messages::ended(reason.code(), Some(&reason));
        said.send(())
    });
    let _ = waits.recv_timeout(ASKS_WITHIN);
    // A normal exit would wait for locks of other threads.
    #[cfg(unix)]
    signal_hook::low_level::exit(code);
    #[cfg(not(unix))]
    std::process::exit(code);
}

/// Makes a limit on the size of files (`ulimit -f`) look like a full disk: writing fails with an error, instead of a signal
/// that ends the program without a message.
fn spare_from_file_limits() -> Result<(), Failure> {
    #[cfg(unix)]
    {
        use std::sync::Arc;
        // The handler does nothing: it only replaces the default action, which is to end the program.
        let ignored = Arc::new(AtomicBool::new(false));
        signal_hook::flag::register(signal_hook::consts::SIGXFSZ, ignored)?;
    }
    Ok(())
}
