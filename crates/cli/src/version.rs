//! The version of the program, its formats and its libraries.

use std::{env, io};

use crate::messages;

/// Whether the command line requests more than the version number: `--version`, not `-V`.
pub(crate) fn is_long_asked_for() -> bool {
    env::args_os().any(|argument| argument == "--version")
}

/// Prints the program's version, followed by everything else that a bug report should contain.
pub(crate) fn print_long() -> io::Result<()> {
    let backends = corniche_viewer::gpu::backends();
    let missing = corniche_gis::missing_formats();
    let text = format!(
        "corniche {}\n{}\nformats: package {}, plan {}, store {}\ninputs: {}\nwgpu backends: {}\n",
        env!("CARGO_PKG_VERSION"),
        corniche_gis::libraries(),
        corniche_tileset::FORMAT_VERSION,
        corniche_plan::PLAN_VERSION,
        corniche_store::FORMAT_VERSION,
        if missing.is_empty() {
            "all of the manual".to_owned()
        } else {
            format!("all of the manual except {}", missing.join(", "))
        },
        if backends.is_empty() { "none".to_owned() } else { backends.join(", ") },
    );
    messages::answer(&text)
}
