//! Handling of Ctrl-C, of other signals that request the program to end, and of the end of the
//! parent process. The run stops at its next check and cleans up. If it does not check, because it
//! waits in a read that never returns, or if a second signal arrives, the program cleans up and
//! ends at once.
//!
//! ```text
//!   first signal, or parent gone ─► noted ─┬─ checked within half a second: the run ends itself, in ten seconds at most
//!                                          └─ not checked: the program removes temporary files and exits
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

use crate::{
    exit::ExitCode,
    failure::{CommandFailure, Result},
    messages,
};

/// The cause of an early end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Cause {
    /// A signal.
    Signal,
    /// The parent process has ended.
    ParentGone,
}

/// Whether the program was requested to end.
static NOTED: AtomicBool = AtomicBool::new(false);
/// The first cause; set before `NOTED`.
static CAUSE: OnceLock<Cause> = OnceLock::new();
/// Whether the run has noticed the request.
static SEEN: AtomicBool = AtomicBool::new(false);
/// Temporary files and folders next to targets, which are removed when the program ends early. The
/// list is locked during the removal, so a path is spared either before the removal or never.
static TEMPORARY: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// The folder of intermediate results of the run, which is kept.
static KEPT: Mutex<Option<PathBuf>> = Mutex::new(None);

/// The longest time between two checks of a run that can stop.
const ASKS_WITHIN: Duration = Duration::from_millis(500);
/// The longest time that a run may need to stop and clean up.
const STOPS_WITHIN: Duration = Duration::from_secs(10);

/// Registers the handler: from now on, signals are noted instead of ending the program at once.
pub(crate) fn watch() -> Result<()> {
    ctrlc::set_handler(|| note(Cause::Signal))?;
    spare_from_file_limits()
}

/// Notes that the program is to end, and ensures that it does.
pub(crate) fn note(cause: Cause) {
    // The first cause is reported.
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

/// Replaces the failure of a run whose parent process has ended by one that says so; other failures
/// are returned unchanged.
pub(crate) fn explain(failure: CommandFailure) -> CommandFailure {
    match CAUSE.get() {
        Some(Cause::ParentGone) if failure.code() == ExitCode::Interrupted => reason(),
        _ => failure,
    }
}

/// The reason for the early end.
fn reason() -> CommandFailure {
    match CAUSE.get() {
        Some(Cause::ParentGone) => CommandFailure::failed(
            "stdin was closed, so the parent process has ended (--die-with-parent); finished work on \
             a part is kept; rerun the same command to resume",
        ),
        Some(Cause::Signal) | None => CommandFailure::interrupted(),
    }
}

/// Whether the program was requested to end.
pub(crate) fn is_noted() -> bool {
    let is_noted = NOTED.load(Ordering::SeqCst);
    if is_noted {
        SEEN.store(true, Ordering::SeqCst);
    }
    is_noted
}

/// Registers a temporary file or folder, which is removed if the program ends early. It may be gone
/// by then.
pub(crate) fn remove_at_end(path: &Path) {
    temporary().push(path.to_path_buf());
}

/// Unregisters temporary files and folders. If the program is just ending and removes them, this
/// does not return.
pub(crate) fn spare(paths: &[&Path]) {
    temporary().retain(|path| !paths.contains(&&**path));
}

/// The registered files and folders, locked for other threads.
pub(crate) fn temporary() -> MutexGuard<'static, Vec<PathBuf>> {
    locked(&TEMPORARY)
}

/// Registers a folder of intermediate results, from which the same run can resume. It is kept if
/// the program ends early, and the user is informed.
pub(crate) fn keep(path: &Path) {
    *locked(&KEPT) = Some(path.to_path_buf());
}

fn end() -> ! {
    // Held until the program has ended.
    let temporary = temporary();
    // Other threads are still at work and may add files while a folder is emptied, so the removal
    // is repeated.
    for _ in 0..3 {
        // The first entry identifies the owner of the others, so it is removed last.
        for path in temporary.iter().rev() {
            let _ = match path.symlink_metadata() {
                Ok(found) if found.is_dir() => fs::remove_dir_all(path),
                Ok(_) => fs::remove_file(path),
                Err(_) => Ok(()),
            };
        }
    }
    // A message can block forever when the reader of a full pipe has stopped, so it gets a limited
    // time.
    let (said, waits) = mpsc::channel();
    let code = i32::from(reason().code().number());
    thread::spawn(move || {
        let kept = locked(&KEPT).clone();
        if let Some(kept) = kept.filter(|kept| kept.exists()) {
            warning!(
                "progress is saved in {kept:?}; rerun with --resume to continue, or with -O to start over"
            );
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

/// Makes a limit on file sizes (`ulimit -f`) look like a full disk: writing fails with an error
/// instead of a signal that ends the program without a message.
fn spare_from_file_limits() -> Result<()> {
    #[cfg(unix)]
    {
        use std::sync::Arc;
        // The handler does nothing: it only replaces the default action, which is to end the
        // program.
        let ignored = Arc::new(AtomicBool::new(false));
        signal_hook::flag::register(signal_hook::consts::SIGXFSZ, ignored)?;
    }
    Ok(())
}
