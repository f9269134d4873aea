//! `--die-with-parent`: the run ends when its standard input does.
//!
//! Whoever starts the process keeps the other end of a pipe open. The kernel closes it when its holder ends, however it ends, also by
//! SIGKILL. A signal at the death of the parent (`PR_SET_PDEATHSIG`) would come when the *thread* that started the process ends,
//! and a pool may end a thread whose work goes on.

use std::{io, thread};

use crate::{
    failure::Failure,
    interrupt::{self, Cause},
};

/// From now on the program ends when standard input does: as after a signal, with another exit code.
pub(crate) fn watch() -> Result<(), Failure> {
    let waiting = || {
        // What comes in is not looked at. An error is an end, too: nothing will tell of the parent any more.
        let _ = io::copy(&mut io::stdin().lock(), &mut io::sink());
        interrupt::note(Cause::ParentGone);
    };
    thread::Builder::new().name("parent".into()).spawn(waiting)?;
    Ok(())
}
