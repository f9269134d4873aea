//! Addresses of files on web servers, displayed without passwords.

use std::fmt;

use reqwest::Url;

use crate::AddressError;

/// The address of a file on a web server: `http://…` or `https://…`.
///
/// The address may contain secrets: a user name and a password, or a signature in the query.
/// Neither `Display` nor `Debug` shows them.
#[derive(Clone, PartialEq, Eq)]
pub struct HttpAddress {
    /// The URL for requests, with user name and password if there are some.
    pub(crate) url: Url,
    /// The address without secrets.
    pub(crate) shown: String,
}

impl HttpAddress {
    /// Parses a text that begins like an address; returns `None` for other texts, which are file
    /// names.
    ///
    /// # Errors
    /// [`AddressError`] for an invalid or unsupported address.
    pub fn parse(text: &str) -> Result<Option<Self>, AddressError> {
        let Some((scheme, _)) = text.split_once("://") else { return Ok(None) };
        let is_scheme_char = |c: char| c.is_ascii_alphanumeric() || matches!(c, '+' | '-' | '.');
        let begins_right = scheme.chars().next().is_some_and(|c| c.is_ascii_alphabetic());
        if !begins_right || !scheme.chars().all(is_scheme_char) {
            return Ok(None);
        }
        let scheme = scheme.to_ascii_lowercase();
        if !matches!(scheme.as_str(), "http" | "https") {
            return Err(AddressError::Scheme { scheme });
        }
        let url = Url::parse(text).map_err(|error| AddressError::NoAddress {
            shown: format!("{scheme}://…"),
            reason: error.to_string(),
        })?;
        let shown = shown(&url);
        if url.fragment().is_some() {
            return Err(AddressError::Fragment { shown });
        }
        Ok(Some(Self { url, shown }))
    }

    /// The last segment of the path, usually a file name.
    #[must_use]
    pub fn file_name(&self) -> &str {
        self.url.path().rsplit('/').find(|part| !part.is_empty()).unwrap_or(&self.shown)
    }
}

/// An address without user name, password and query, which may contain a signature.
pub(crate) fn shown(url: &Url) -> String {
    let mut clean = url.clone();
    clean.set_fragment(None);
    clean.set_query(None);
    // These calls fail only for addresses without a host, which have neither.
    let _ = clean.set_username("");
    let _ = clean.set_password(None);
    if url.query().is_some() { format!("{clean}?…") } else { clean.to_string() }
}

impl fmt::Display for HttpAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.shown)
    }
}

impl fmt::Debug for HttpAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("HttpAddress").field(&self.shown).finish()
    }
}

#[cfg(test)]
#[path = "address_tests.rs"]
mod tests;
