//! Errors of object storage, without passwords in their messages.

use std::{io, path::PathBuf};

use corniche_store::StoreError;

/// The reason why an object could not be read or written.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum ObjectError {
    #[error("invalid address of an object or a prefix: {}; write s3://BUCKET/NAME", without_secret(.text))]
    Address { text: String },
    #[error("cannot use object storage: {what}; check the environment variables AWS_…")]
    Settings { what: String },
    #[error(
        "{name}: no credentials found; set AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY, or \
         AWS_SKIP_SIGNATURE=true for a public bucket"
    )]
    NoCredentials { name: String },
    #[error("{name}: the server rejects the request ({why}); {advice}")]
    Refused { name: String, why: String, advice: &'static str },
    #[error(
        "{name}: the bucket {bucket:?} does not exist there; create it, or correct its name or \
         AWS_ENDPOINT_URL"
    )]
    NoBucket { name: String, bucket: String },
    #[error("{name} does not exist; check its name, and that nothing removed it")]
    Missing { name: String },
    #[error("{name} changed while it was in use; run the same command again")]
    Changed { name: String },
    #[error(
        "{name}: the server ignores byte ranges and sends the whole object; use an endpoint that \
         supports range requests"
    )]
    NoRanges { name: String },
    #[error(
        "{name}: the server overwrites an existing object despite If-None-Match; use an endpoint \
         that supports conditional writes, and remove the object"
    )]
    NoConditions { name: String },
    #[error(
        "{name}: the server keeps sending {got} bytes instead of {wanted}; run the same command \
         later, or report it to the server's operator"
    )]
    Short { name: String, got: u64, wanted: u64 },
    #[error(
        "{name}: the server's object listing does not end ({count} names so far); use another \
         prefix, or report it to the server's operator"
    )]
    EndlessList { name: String, count: usize },
    #[error(
        "{name}: the server sends more than {most} bytes, the maximum for such an answer; use \
         another endpoint, or report it to the server's operator"
    )]
    TooMuchSent { name: String, most: u64 },
    #[error(
        "{name}: the server sends an invalid answer ({what}); use another endpoint, or report it \
         to the server's operator"
    )]
    BadAnswer { name: String, what: String },
    #[error(
        "{name}: the server confirmed the upload, but {found}; use another endpoint, or report it \
         to the server's operator"
    )]
    NotStored { name: String, found: String },
    #[error("{name} already exists; pass -O to overwrite it")]
    Exists { name: String },
    #[error(
        "cannot {doing} {name}, even after several tries; check the network and AWS_ENDPOINT_URL, then run the same command again"
    )]
    Failed { doing: &'static str, name: String, source: Box<dyn std::error::Error + Send + Sync> },
    #[error("{name} has {length} bytes, more than an object can hold")]
    TooLarge { name: String, length: u64 },
    #[error("stopped while {name} was being uploaded; no part of it was stored")]
    Stopped { name: String },
    #[error("cannot {doing} {path:?}")]
    File { path: PathBuf, doing: &'static str, source: io::Error },
}

impl ObjectError {
    /// Whether the input (a name, credentials) cannot be used, as opposed to a failed operation.
    #[must_use]
    pub fn is_unusable(&self) -> bool {
        matches!(
            self,
            Self::Address { .. }
                | Self::Settings { .. }
                | Self::NoCredentials { .. }
                | Self::Refused { .. }
                | Self::NoBucket { .. }
                | Self::Missing { .. }
                | Self::NoRanges { .. }
                | Self::NoConditions { .. }
        )
    }

    /// The message with the messages of its causes, as far as they add something.
    #[must_use]
    pub fn told(&self) -> String {
        let mut said = self.to_string();
        let mut cause = std::error::Error::source(self);
        while let Some(error) = cause {
            let text = error.to_string();
            if !said.contains(&text) {
                said = format!("{said}: {text}");
            }
            cause = error.source();
        }
        said
    }
}

/// An address without the part that may contain a password.
fn without_secret(text: &str) -> String {
    match text.rsplit_once('@') {
        Some((_, rest)) => format!("s3://…@{rest}"),
        None => text.to_owned(),
    }
}

impl From<ObjectError> for StoreError {
    fn from(error: ObjectError) -> Self {
        Self::Place { what: error.told(), is_unusable: error.is_unusable() }
    }
}

impl From<ObjectError> for io::Error {
    /// Converts the error to an I/O error for readers.
    fn from(error: ObjectError) -> Self {
        let kind = match &error {
            ObjectError::Missing { .. } => io::ErrorKind::NotFound,
            ObjectError::NoCredentials { .. } | ObjectError::Refused { .. } => {
                io::ErrorKind::PermissionDenied
            }
            _ => io::ErrorKind::Other,
        };
        Self::new(kind, error.told())
    }
}
