//! Defects that are told later, or never.

use std::io;

use corniche_store::{Scratch, append_record, take_record};

use crate::{Defect, spool::Spool};

/// Keeps defects until they are told.
pub(crate) struct Deferred<'a> {
    kept: Spool<'a>,
    /// Who finds defects cannot fail; the first failure is kept.
    failed: Option<io::Error>,
}

impl<'a> Deferred<'a> {
    /// Keeps at most about `memory_bytes` in memory.
    pub(crate) fn new(scratch: &'a dyn Scratch, memory_bytes: u64) -> Self {
        Self { kept: Spool::new(scratch, memory_bytes), failed: None }
    }

    pub(crate) fn push(&mut self, defect: &Defect) {
        if self.failed.is_none() {
            self.failed = self.kept.push(|bytes| append_record(bytes, defect)).err();
        }
    }

    /// Tells what was kept.
    pub(crate) fn tell(self, on_defect: &mut dyn FnMut(Defect)) -> io::Result<()> {
        self.failed.map_or(Ok(()), Err)?;
        let mut kept = self.kept.read();
        while let Some(defect) = kept.next(take_record)? {
            on_defect(defect);
        }
        Ok(())
    }
}
