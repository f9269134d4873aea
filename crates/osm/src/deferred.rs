//! Defects that are told later, or never.

use std::{
    cell::{Cell, RefCell},
    io,
};

use corniche_store::Scratch;

use crate::{
    Defect,
    defect_bytes::{push_defect, take_defect},
    spool::Spool,
};

/// Keeps defects until they are released; from then on it hands them on.
pub(crate) struct Deferred<'a> {
    kept: RefCell<Option<Spool<'a>>>,
    on_defect: RefCell<&'a mut dyn FnMut(Defect)>,
    /// Who finds defects cannot fail; the first failure is kept.
    failed: Cell<Option<io::Error>>,
}

impl<'a> Deferred<'a> {
    /// Keeps at most about `memory_bytes` in memory.
    pub(crate) fn new(
        scratch: &'a dyn Scratch,
        memory_bytes: u64,
        on_defect: &'a mut dyn FnMut(Defect),
    ) -> Self {
        let kept = RefCell::new(Some(Spool::new(scratch, memory_bytes)));
        Self { kept, on_defect: RefCell::new(on_defect), failed: Cell::new(None) }
    }

    pub(crate) fn push(&self, defect: Defect) {
        match &mut *self.kept.borrow_mut() {
            Some(kept) => {
                if let Err(error) = kept.push(|bytes| push_defect(bytes, &defect)) {
                    let first = self.failed.take().unwrap_or(error);
                    self.failed.set(Some(first));
                }
            }
            None => (self.on_defect.borrow_mut())(defect),
        }
    }

    /// Tells what was kept, and from now on what comes.
    pub(crate) fn release(&self) -> io::Result<()> {
        self.failed.take().map_or(Ok(()), Err)?;
        let Some(kept) = self.kept.take() else { return Ok(()) };
        let mut kept = kept.read();
        let mut on_defect = self.on_defect.borrow_mut();
        while let Some(defect) = kept.next(take_defect)? {
            on_defect(defect);
        }
        Ok(())
    }
}
