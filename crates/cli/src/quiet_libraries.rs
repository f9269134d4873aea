//! Libraries of the system that would write to standard error in our place.

/// Where Wayland has its socket.
#[cfg(target_os = "linux")]
const FOLDER: &str = "XDG_RUNTIME_DIR";

/// Begins again, as the same process, with an environment in which libraries have nothing to say.
///
/// Where [`FOLDER`] is not set, as on servers, libwayland says so on standard error whenever Vulkan looks for graphics cards, because a layer of Mesa
/// asks it for a display. A folder that is not there has no socket either, and nothing is said. A process may not change its environment while
/// other threads may read it, and drivers have threads; so it is changed before anything else begins.
#[cfg(target_os = "linux")]
pub(crate) fn begin() {
    use std::{env, os::unix::process::CommandExt as _, path::Path, process::Command};

    if env::var_os(FOLDER).is_some_and(|folder| Path::new(&folder).is_absolute()) {
        return;
    }
    let mut words = env::args_os();
    let name = words.next().unwrap_or_default();
    // It comes back only where it failed; then one line too many is said.
    let _ =
        Command::new("/proc/self/exe").arg0(name).args(words).env(FOLDER, "/nonexistent").exec();
}

#[cfg(not(target_os = "linux"))]
pub(crate) fn begin() {}
