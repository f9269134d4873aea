use corniche_roads::{ClassFilterError, FrcTableError};

/// Why a text is no settings file, table or style. Which file it came from the caller knows.
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
    #[error("{entry} of {value} is out of range; it must be {least} to {most}")]
    StyleRange { entry: String, value: f64, least: f64, most: f64 },
    #[error("roads.{text:?} is no class; classes are 0 to 8")]
    StyleClass { text: String },
    #[error("[roads.{class}] is missing; a style says of every class, 0 to 8, how it looks")]
    MissingClass { class: String },
    #[error("a style has {needed} [[tint]] entries, not {count}")]
    TintCount { count: usize, needed: usize },
    #[error("the shares of [[tint]] must ascend from 0 to 1, both included, by 0.001 or more")]
    TintOrder,
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
