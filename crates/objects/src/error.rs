//! Errors of object storage, told without passwords.

use std::{io, path::PathBuf};

use corniche_store::StoreError;

/// Why an object could not be read or written.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum ObjectError {
    #[error("this is no address of an object or a prefix: {}; write s3://BUCKET/NAME", without_secret(.text))]
    Address { text: String },
    #[error("object storage cannot be used: {what}; look at the environment variables AWS_…")]
    Settings { what: String },
    #[error(
        "{name}: there are no credentials; set AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY, or AWS_SKIP_SIGNATURE=true for a bucket \
         that is open to all"
    )]
    NoCredentials { name: String },
    #[error("{name}: the server refuses it ({why}); {advice}")]
    Refused { name: String, why: String, advice: &'static str },
    #[error(
        "{name}: the bucket {bucket:?} does not exist there; make it, or correct its name or AWS_ENDPOINT_URL"
    )]
    NoBucket { name: String, bucket: String },
    #[error("{name} is not there; check its name, and that nothing removed it")]
    Missing { name: String },
    #[error("{name} changed while it was in use; run the same command again")]
    Changed { name: String },
    #[error(
        "{name}: the server ignores which bytes are asked for (it does not obey ranges); use an endpoint that does"
    )]
    NoRanges { name: String },
    #[error(
        "{name}: the server replaces an object also when told not to (it does not obey If-None-Match); use an endpoint that does, and \
         remove the object"
    )]
    NoConditions { name: String },
    #[error(
        "{name}: the server delivers {got} bytes of {wanted} again and again; run the same command later, or tell who runs the server"
    )]
    Short { name: String, got: u64, wanted: u64 },
    #[error(
        "{name}: the server's list of what is there does not end ({count} names so far); use another prefix, or tell who runs the server"
    )]
    EndlessList { name: String, count: usize },
    #[error(
        "{name}: the server sends more than the {most} bytes that such an answer can have; use another endpoint, or tell who runs the server"
    )]
    TooMuchSent { name: String, most: u64 },
    #[error(
        "{name}: the server's answer cannot be right ({what}); use another endpoint, or tell who runs the server"
    )]
    BadAnswer { name: String, what: String },
    #[error(
        "{name}: the server says that it has stored it, but {found}; use another endpoint, or tell who runs the server"
    )]
    NotStored { name: String, found: String },
    #[error("{name} exists already; give -O to replace it")]
    Exists { name: String },
    #[error(
        "cannot {doing} {name}, also not after several tries; check the network and AWS_ENDPOINT_URL, then run the same command again"
    )]
    Failed { doing: &'static str, name: String, source: Box<dyn std::error::Error + Send + Sync> },
    #[error("{name} has {length} bytes, more than an object can have")]
    TooLarge { name: String, length: u64 },
    #[error("stopped while {name} was sent; nothing of it is there")]
    Stopped { name: String },
    #[error("cannot {doing} {path:?}")]
    File { path: PathBuf, doing: &'static str, source: io::Error },
}

impl ObjectError {
    /// Whether what was given cannot be used (a name, credentials), rather than that something failed.
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

    /// The message with those of its causes, as far as they say more.
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

/// An address with what may be a password in it left out.
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
    /// The error for readers, whose errors travel as those of files.
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
