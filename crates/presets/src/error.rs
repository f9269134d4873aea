//! Errors of parsing settings and tables, and the limit on the length of their texts.

use corniche_layers::LayerTableError;
use corniche_roads::{ClassFilterError, FrcTableError};

/// The reason why a text is not a settings file, a class table or a layer. The caller knows which
/// file the text came from.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum PresetError {
    #[error("the file has {bytes} bytes, far more than any settings; the limit is {limit}")]
    TooLong { bytes: usize, limit: usize },
    #[error(transparent)]
    Toml(#[from] toml::de::Error),
    #[error(transparent)]
    FrcTable(#[from] FrcTableError),
    #[error("line {line}: {error}")]
    Layer { line: usize, error: LayerTableError },
    #[error("class-max-cell: {text:?} is not a class; the classes are 0 to 8")]
    Class { text: String },
    #[error("class-max-cell: {0}")]
    ClassFilter(#[from] ClassFilterError),
}

/// The largest length of a text. The longest preset has some 3 kB.
pub(crate) const MAX_TEXT_BYTES: usize = 1 << 20;

/// Returns the text if it is short enough to be parsed.
pub(crate) fn bounded(text: &str) -> Result<&str, PresetError> {
    if text.len() > MAX_TEXT_BYTES {
        return Err(PresetError::TooLong { bytes: text.len(), limit: MAX_TEXT_BYTES });
    }
    Ok(text)
}
