//! Defects that are reported later, or never.

use std::io;

use corniche_store::{ScratchSpace, append_record, take_record};

use crate::{ExtractDefect, spool::Spool};

/// Stores defects until they are reported.
pub(crate) struct Deferred<'a> {
    kept: Spool<'a>,
    /// The first failure. It is stored because the code that finds defects cannot return errors.
    failed: Option<io::Error>,
}

impl<'a> Deferred<'a> {
    /// Creates a store that keeps at most about `memory_bytes` in memory.
    pub(crate) fn new(scratch: &'a dyn ScratchSpace, memory_bytes: u64) -> Self {
        Self { kept: Spool::new(scratch, memory_bytes), failed: None }
    }

    pub(crate) fn push(&mut self, defect: &ExtractDefect) {
        if self.failed.is_none() {
            self.failed = self.kept.push(|bytes| append_record(bytes, defect)).err();
        }
    }

    /// Reports the stored defects.
    pub(crate) fn tell(self, on_defect: &mut dyn FnMut(ExtractDefect)) -> io::Result<()> {
        self.failed.map_or(Ok(()), Err)?;
        let mut kept = self.kept.read();
        while let Some(defect) = kept.next(take_record)? {
            on_defect(defect);
        }
        Ok(())
    }
}
