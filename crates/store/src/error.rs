use std::{io, path::PathBuf};

/// Why something could not be kept or read back.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum StoreError {
    #[error("{path:?} could not be read or written (disk full?)")]
    Io { path: PathBuf, source: io::Error },
    #[error("{path:?} is damaged: {what}")]
    Damaged { path: PathBuf, what: String },
}
