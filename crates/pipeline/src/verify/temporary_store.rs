//! Where `verify` keeps what does not fit in memory.

use corniche_store::MemoryStore;

use super::error::VerifyError;

pub(super) fn temporary_store() -> Result<MemoryStore, VerifyError> {
    Ok(MemoryStore::default())
}
