//! `--die-with-parent`: ends the run when stdin is closed.
//!
//! The parent process keeps the other end of a pipe open. The kernel closes it when the parent
//! ends, in whatever way, also by SIGKILL. A signal at the death of the parent (`PR_SET_PDEATHSIG`)
//! would be sent at the end of the *thread* that started the process, and a thread pool may end a
//! thread although the work continues.

use std::{io, thread};

use crate::{
    failure::Result,
    interrupt::{self, Cause},
};

/// Starts watching stdin: when it is closed, the program ends as after a signal, with another exit
/// code.
pub(crate) fn watch() -> Result<()> {
    let waiting = || {
        // The input is ignored. An error counts as the end: nothing else would report the end of
        // the parent any more.
        let _ = io::copy(&mut io::stdin().lock(), &mut io::sink());
        interrupt::note(Cause::ParentGone);
    };
    thread::Builder::new().name("parent".into()).spawn(waiting)?;
    Ok(())
}
