//! Attribution texts are lines of plain text: they are drawn into images, and written into files of
//! many formats.

/// The largest number of characters of one attribution text.
const MOST_CHARS: usize = 1000;
/// The largest number of bytes of all attribution texts of a package together: some exports repeat
/// them in each tile.
pub(crate) const MOST_CREDITS_BYTES: usize = 1 << 20;

/// Why a text cannot be an attribution text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
pub enum CreditError {
    #[error(
        "it contains the control character U+{:04X}; write plain text on one line",
        u32::from(*.0)
    )]
    Control(char),
    #[error("it has {0} characters; shorten it to at most {MOST_CHARS}")]
    Long(usize),
}

/// Checks that a text can be shown as an attribution text wherever a package is shown.
///
/// # Errors
/// If it contains a control character, such as a line break, or is too long.
pub fn check_credit(text: &str) -> Result<(), CreditError> {
    if let Some(control) = text.chars().find(|character| character.is_control()) {
        return Err(CreditError::Control(control));
    }
    match text.chars().count() {
        ..=MOST_CHARS => Ok(()),
        chars => Err(CreditError::Long(chars)),
    }
}

/// Converts a text from a file to the closest attribution text: on one line, and shortened to the
/// largest length.
#[must_use]
pub fn to_credit(text: &str) -> String {
    let is_between = |character: char| character.is_whitespace() || character.is_control();
    let words = text.split(is_between).filter(|word| !word.is_empty()).collect::<Vec<_>>();
    words.join(" ").chars().take(MOST_CHARS).collect()
}

#[cfg(test)]
#[path = "credits_tests.rs"]
mod tests;
