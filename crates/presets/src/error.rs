use corniche_roads::{ClassFilterError, FrcTableError};

/// Why a text is no settings file or FRC table. The caller knows which file the text came from.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum PresetError {
    #[error("it holds {bytes} bytes, far more than any settings; at most {limit} are read")]
    TooLong { bytes: usize, limit: usize },
    #[error(transparent)]
    Toml(#[from] toml::de::Error),
    #[error(transparent)]
    FrcTable(#[from] FrcTableError),
    #[error("class-max-cell: {text:?} is no class; classes are 0 to 8")]
    Class { text: String },
    #[error("class-max-cell: {0}")]
    ClassFilter(#[from] ClassFilterError),
}

/// Longest text that is read. The longest preset has some 3 kB.
pub(crate) const MAX_TEXT_BYTES: usize = 1 << 20;

/// The text, if it is short enough to be parsed.
pub(crate) fn bounded(text: &str) -> Result<&str, PresetError> {
    if text.len() > MAX_TEXT_BYTES {
        return Err(PresetError::TooLong { bytes: text.len(), limit: MAX_TEXT_BYTES });
    }
    Ok(text)
}
