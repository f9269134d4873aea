//! Titles of layers and classes in several languages.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The title of a layer or of a class, by language (`en`, `de`, `pt-BR`). In a table a single text
/// is the English title.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected a text, or a table of texts by language")]
pub enum Titles {
    /// No title: the id is shown.
    #[default]
    #[serde(skip)]
    Missing,
    /// The English title.
    English(String),
    /// Titles by language.
    ByLanguage(BTreeMap<String, String>),
}

/// The largest length of a title, characters.
const MAX_TITLE_CHARS: usize = 80;
/// The largest number of languages.
const MAX_LANGUAGES: usize = 64;

impl Titles {
    /// Returns the title in the first of these languages that has one (`de` also for `de-CH`), else
    /// the English title, else the first one.
    #[must_use]
    pub fn title(&self, languages: &[&str]) -> Option<&str> {
        match self {
            Self::Missing => None,
            Self::English(title) => Some(title),
            Self::ByLanguage(titles) => {
                let of_language = |language: &&str| {
                    let general = language.split('-').next().unwrap_or_default();
                    titles.get(*language).or_else(|| titles.get(general))
                };
                let title = languages.iter().chain(&["en"]).find_map(of_language);
                title.or_else(|| titles.values().next()).map(String::as_str)
            }
        }
    }

    /// Whether there is no title.
    #[must_use]
    pub fn is_missing(&self) -> bool {
        *self == Self::Missing
    }

    /// Checks that all titles can be shown (see [`is_plain_text`]), and that their languages are
    /// tags such as `pt-BR`.
    ///
    /// # Errors
    /// What is wrong with the first title that cannot be shown.
    pub(crate) fn check(&self) -> Result<(), String> {
        let check_title = |title: &str| {
            if is_plain_text(title, MAX_TITLE_CHARS) {
                return Ok(());
            }
            Err(format!(
                "{title:?} is not a title: use 1 to {MAX_TITLE_CHARS} characters in one line, without characters that are invisible or change the direction of writing"
            ))
        };
        match self {
            Self::Missing => Ok(()),
            Self::English(title) => check_title(title),
            Self::ByLanguage(titles) if (1..=MAX_LANGUAGES).contains(&titles.len()) => {
                titles.iter().try_for_each(|(language, title)| {
                    if language.len() <= 20 && is_language_tag(language, 8) {
                        return check_title(title);
                    }
                    Err(format!("{language:?} is not a language tag such as \"de\" or \"pt-BR\""))
                })
            }
            Self::ByLanguage(titles) => {
                let languages = titles.len();
                Err(format!("a title has 1 to {MAX_LANGUAGES} languages, got {languages}"))
            }
        }
    }
}

/// Whether a text has the form of a language tag (`de`, `zh-Hant`, `be-tarask`; BCP 47): at most
/// `longest` letters, then parts of letters and digits, joined by hyphens.
pub(crate) fn is_language_tag(text: &str, longest: usize) -> bool {
    let is_part = |part: &str| {
        (1..=8).contains(&part.len()) && part.bytes().all(|byte| byte.is_ascii_alphanumeric())
    };
    let language = text.split('-').next().unwrap_or_default();
    (2..=longest).contains(&language.len())
        && language.bytes().all(|byte| byte.is_ascii_lowercase())
        && text.split('-').all(is_part)
}

/// Whether a text can be shown in one line and cannot disguise what is around it: it is not empty,
/// has at most `longest` characters, no spaces at its ends, no control characters and line breaks,
/// and no characters that are invisible or change the direction of writing.
///
/// Source of the characters: Unicode Standard Annex 9, *Unicode Bidirectional Algorithm*, section
/// 2; Unicode Standard, section 23.2, *Layout Controls*. The joiners U+200C and U+200D stay,
/// because Persian and Indic words need them.
pub(crate) fn is_plain_text(text: &str, longest: usize) -> bool {
    let is_unseen = |c: char| {
        c.is_control()
            || matches!(c, '\u{ad}' | '\u{61c}' | '\u{200b}' | '\u{200e}' | '\u{200f}')
            || matches!(c, '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
    };
    let is_joiner = |c: char| matches!(c, '\u{200c}' | '\u{200d}');
    text.trim() == text
        && text.chars().count() <= longest
        && !text.chars().any(is_unseen)
        && !text.chars().all(is_joiner)
}

#[cfg(test)]
#[path = "titles_tests.rs"]
mod tests;
