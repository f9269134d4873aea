//! Silences system libraries that would write to standard error.

/// The folder of Wayland's socket.
#[cfg(target_os = "linux")]
const FOLDER: &str = "XDG_RUNTIME_DIR";

/// Restarts the program, as the same process, with an environment in which libraries print nothing.
///
/// If [`FOLDER`] is not set, as on servers, libwayland prints this to standard error whenever
/// Vulkan searches for GPUs, because a layer of Mesa requests a display. A folder that does not
/// exist has no socket either, and nothing is printed. A process must not change its environment
/// while other threads may read it, and drivers have threads; so it is changed before anything else
/// begins.
#[cfg(target_os = "linux")]
pub(crate) fn begin() {
    use std::{env, os::unix::process::CommandExt as _, path::Path, process::Command};

    if env::var_os(FOLDER).is_some_and(|folder| Path::new(&folder).is_absolute()) {
        return;
    }
    let mut words = env::args_os();
    let name = words.next().unwrap_or_default();
    // This returns only after a failure; then one line too many is printed.
    let _ =
        Command::new("/proc/self/exe").arg0(name).args(words).env(FOLDER, "/nonexistent").exec();
}

#[cfg(not(target_os = "linux"))]
pub(crate) fn begin() {}
