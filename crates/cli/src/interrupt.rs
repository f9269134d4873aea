//! Ctrl-C and the polite signals: the run stops at the next opportunity and cleans up. Where no opportunity comes, as in a
//! read that never returns, or a second signal does, the program cleans up and ends all the same.
//!
//! ```text
//!   first signal ─► noted ─┬─ asked for within half a second: the run ends itself, in ten seconds at most
//!                          └─ not asked for: the end
//!   second signal ─► the end
//! ```

use std::{
    fs,
    path::{Path, PathBuf},
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
    thread,
    time::Duration,
};

use crate::failure::Failure;

/// A signal came.
static NOTED: AtomicBool = AtomicBool::new(false);
/// The run knows of it.
static SEEN: AtomicBool = AtomicBool::new(false);
/// What is removed when the program ends early: temporary files and folders beside targets.
static LITTER: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A run that can stop asks more often than this.
const ASKS_WITHIN: Duration = Duration::from_millis(500);
/// What a run may take to stop and clean up.
const STOPS_WITHIN: Duration = Duration::from_secs(10);

/// From now on a signal is noted instead of ending the program at once.
pub(crate) fn watch() -> Result<(), Failure> {
    ctrlc::set_handler(|| {
        if NOTED.swap(true, Ordering::SeqCst) {
            end();
        }
        thread::spawn(|| {
            thread::sleep(ASKS_WITHIN);
            if SEEN.load(Ordering::SeqCst) {
                thread::sleep(STOPS_WITHIN);
            }
            end();
        });
    })
    .map_err(|error| Failure::new(crate::exit::ExitCode::Failed, error))?;
    spare_from_file_limits()
}

/// Whether a signal came.
pub(crate) fn is_noted() -> bool {
    let is_noted = NOTED.load(Ordering::SeqCst);
    if is_noted {
        SEEN.store(true, Ordering::SeqCst);
    }
    is_noted
}

/// A temporary file or folder, which goes when the program ends early. That it is gone already does no harm.
pub(crate) fn remove_at_end(path: &Path) {
    LITTER.lock().unwrap_or_else(PoisonError::into_inner).push(path.to_path_buf());
}

fn end() -> ! {
    let litter =
        LITTER.lock().map_or_else(|poisoned| poisoned.into_inner().clone(), |all| all.clone());
    // Other threads are still at work: what they add while a folder is emptied takes another turn.
    for _ in 0..3 {
        for path in litter.iter().filter(|path| path.symlink_metadata().is_ok()) {
            let _ = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
        }
    }
    // Whoever reads our words may have stopped reading, and then to say one is to wait for ever.
    let (said, waits) = mpsc::channel();
    thread::spawn(move || {
        Failure::interrupted().tell();
        said.send(())
    });
    let _ = waits.recv_timeout(ASKS_WITHIN);
    // Not the orderly way out, which waits for what other threads hold.
    #[cfg(unix)]
    signal_hook::low_level::exit(4);
    #[cfg(not(unix))]
    std::process::exit(4);
}

/// A limit on the size of files (`ulimit -f`) is then a full disk: writing fails and is told, instead of a signal that ends
/// the program without a word.
fn spare_from_file_limits() -> Result<(), Failure> {
    #[cfg(unix)]
    {
        use std::sync::Arc;
        // Any handler will do: what matters is that the signal's own way, to kill, is not taken.
        let ignored = Arc::new(AtomicBool::new(false));
        signal_hook::flag::register(signal_hook::consts::SIGXFSZ, ignored)
            .map_err(|error| Failure::new(crate::exit::ExitCode::Failed, error))?;
    }
    Ok(())
}
