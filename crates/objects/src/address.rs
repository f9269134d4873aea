//! Addresses in object storage: `s3://BUCKET/NAME`.

use std::fmt;

use crate::ObjectError;

/// The address of an object, or of all objects with a common prefix: `s3://BUCKET/NAME`.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct ObjectAddress {
    /// The bucket.
    pub bucket: String,
    /// The object's name (its key), without slashes at its ends; empty for the whole bucket.
    pub key: String,
}

impl ObjectAddress {
    /// Parses a text that begins with `s3://`; returns `None` for other texts, which are file
    /// names.
    ///
    /// # Errors
    /// [`ObjectError::Address`] for an invalid address.
    pub fn parse(text: &str) -> Result<Option<Self>, ObjectError> {
        let Some(rest) = text.strip_prefix("s3://") else { return Ok(None) };
        let (bucket, key) = rest.split_once('/').unwrap_or((rest, ""));
        let key = key.strip_suffix('/').unwrap_or(key);
        let is_plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_');
        let has_bucket = !bucket.is_empty() && bucket.chars().all(is_plain);
        // The characters that separate the query and the fragment of a URL could be part of a name
        // here, but programs do not agree on this.
        let is_fine = |name: &str| {
            !matches!(name, "" | "." | "..") && !name.contains(['?', '#', '\\', '\0', '\n', '\r'])
        };
        let has_key = key.is_empty() || key.split('/').all(is_fine);
        if has_bucket && has_key {
            Ok(Some(Self { bucket: bucket.to_owned(), key: key.to_owned() }))
        } else {
            Err(ObjectError::Address { text: text.to_owned() })
        }
    }

    /// The key of an object below this one.
    #[must_use]
    pub fn beneath(&self, name: &str) -> String {
        if self.key.is_empty() { name.to_owned() } else { format!("{}/{name}", self.key) }
    }

    /// The object's name after the last slash.
    #[must_use]
    pub fn file_name(&self) -> &str {
        self.key.rsplit('/').next().unwrap_or_default()
    }
}

impl fmt::Display for ObjectAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { bucket, key } = self;
        write!(f, "s3://{bucket}")?;
        if key.is_empty() { Ok(()) } else { write!(f, "/{key}") }
    }
}

#[cfg(test)]
#[path = "address_tests.rs"]
mod tests;
