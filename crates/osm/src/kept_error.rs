//! Errors of the intermediate results that shares of an extract store.

use std::io;

use corniche_store::StoreError;

use crate::share::Share;

/// The reason why the results of shares cannot be used.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum KeptError {
    #[error(transparent)]
    Store(#[from] StoreError),
    #[error(
        "chunk {share} of the extract's {what} is missing; compute it with corniche part --step {what} --share {share}"
    )]
    Missing { what: &'static str, share: Share },
    #[error(
        "chunk {share} of the extract is corrupt: {what}; delete its parts and create them again"
    )]
    Damaged { share: Share, what: &'static str },
}

impl From<KeptError> for io::Error {
    fn from(error: KeptError) -> Self {
        Self::other(error)
    }
}
