//! Errors of intermediate results that shares of an extract kept.

use std::io;

use corniche_store::StoreError;

use crate::share::Share;

/// Why what shares kept cannot be used.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum KeptError {
    #[error(transparent)]
    Store(#[from] StoreError),
    #[error("share {share} of the {what} of the extract is not there")]
    Missing { what: &'static str, share: Share },
    #[error(
        "share {share} of the extract is damaged: {what}; remove its parts and make them again"
    )]
    Damaged { share: Share, what: &'static str },
}

impl From<KeptError> for io::Error {
    fn from(error: KeptError) -> Self {
        Self::other(error)
    }
}
