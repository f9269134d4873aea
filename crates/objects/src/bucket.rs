//! A bucket of object storage: its objects are listed, found, read and created here.

use std::{fmt, ops::Range, sync::Arc, thread, time::Duration};

use bytes::Bytes;
use object_store::{
    Attribute, AttributeValue, Error, GetOptions, GetRange, GetResult, ObjectStore, PutMode,
    PutOptions,
    aws::{AmazonS3, S3ConditionalPut},
    path::Path as Key,
};
use tokio::runtime::{Builder, Runtime};

use crate::{
    ObjectAddress, ObjectError, Requests, StorageSettings,
    watch::{AtTheEnd, Counter, NoMachineCredentials, RangeIgnored, Refusal, Watch},
};

/// What tells apart who wrote an object: metadata with a random number.
pub(crate) const WRITER: &str = "corniche-writer";

/// Object storage as the environment describes it.
#[derive(Debug)]
pub struct Storage {
    settings: StorageSettings,
    runtime: Arc<Runtime>,
    counter: Arc<Counter>,
}

/// The objects of a bucket. All methods block, and many threads may call them at once.
#[derive(Clone)]
pub struct Bucket {
    name: String,
    /// Ends uploads only where there is nothing of that name.
    pub(crate) keeping: Arc<AmazonS3>,
    /// Ends uploads in any case.
    pub(crate) replacing: Arc<AmazonS3>,
    pub(crate) runtime: Arc<Runtime>,
    first_pause: Duration,
}

/// An object that was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Found {
    /// Its key.
    pub key: String,
    /// Its length, bytes.
    pub length: u64,
    /// Its `ETag`, which changes with its content, if the server gives one.
    pub etag: Option<String>,
}

impl Storage {
    /// Nothing is asked of the server yet.
    ///
    /// # Errors
    /// [`ObjectError::Settings`] where the runtime cannot be made.
    pub fn new(settings: StorageSettings) -> Result<Self, ObjectError> {
        // A second client in this process that chose otherwise is as good: then this does nothing.
        let _ = rustls::crypto::ring::default_provider().install_default();
        let runtime = Builder::new_multi_thread()
            .worker_threads(1)
            .thread_name("objects")
            .enable_all()
            .build()
            .map_err(|error| ObjectError::Settings { what: error.to_string() })?;
        Ok(Self { settings, runtime: Arc::new(runtime), counter: Arc::default() })
    }

    /// A bucket, which need not be there.
    ///
    /// # Errors
    /// [`ObjectError::Settings`] where the environment's variables make no sense.
    pub fn bucket(&self, name: &str) -> Result<Bucket, ObjectError> {
        let client = |at_the_end| {
            let watch = Watch { counter: Arc::clone(&self.counter), at_the_end };
            let builder = self.settings.builder(name)?.with_http_connector(watch);
            let built = builder.with_conditional_put(S3ConditionalPut::ETagMatch).build();
            built.map(Arc::new).map_err(|error| ObjectError::Settings { what: error.to_string() })
        };
        Ok(Bucket {
            name: name.to_owned(),
            keeping: client(AtTheEnd::Refuse)?,
            replacing: client(AtTheEnd::Replace)?,
            runtime: Arc::clone(&self.runtime),
            first_pause: self.settings.retries.first_pause,
        })
    }

    /// What was sent and received so far.
    #[must_use]
    pub fn requests(&self) -> Requests {
        self.counter.so_far()
    }
}

impl fmt::Debug for Bucket {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Bucket").field("name", &self.name).finish_non_exhaustive()
    }
}

impl Bucket {
    /// The address of an object in it.
    #[must_use]
    pub fn address(&self, key: &str) -> ObjectAddress {
        ObjectAddress { bucket: self.name.clone(), key: key.to_owned() }
    }

    /// The objects and the folders directly beneath a prefix (`PREFIX/…`; an empty one is the bucket), by their keys.
    ///
    /// # Errors
    /// See [`ObjectError`].
    pub fn list(&self, prefix: &str) -> Result<(Vec<Found>, Vec<String>), ObjectError> {
        let failed = |error| self.explain(prefix, "list", error);
        let path = Self::path(prefix).map_err(failed)?;
        let listed = self.runtime.block_on(self.keeping.list_with_delimiter(Some(&path)));
        let listed = listed.map_err(failed)?;
        let found = listed.objects.into_iter().map(|object| Found {
            key: object.location.to_string(),
            length: object.size,
            etag: object.e_tag,
        });
        let folders = listed.common_prefixes.into_iter().map(|path| path.to_string());
        let (mut found, mut folders): (Vec<_>, Vec<_>) = (found.collect(), folders.collect());
        found.sort_by(|a, b| a.key.cmp(&b.key));
        folders.sort();
        Ok((found, folders))
    }

    /// An object's length and `ETag`; `None` if it is not there.
    ///
    /// # Errors
    /// See [`ObjectError`].
    pub fn find(&self, key: &str) -> Result<Option<Found>, ObjectError> {
        Ok(self.look(key)?.map(|(found, _)| found))
    }

    /// The same, and who wrote it.
    pub(crate) fn look(&self, key: &str) -> Result<Option<(Found, Option<String>)>, ObjectError> {
        let failed = |error| self.explain(key, "look for", error);
        let path = Self::path(key).map_err(failed)?;
        let options = GetOptions { head: true, ..GetOptions::default() };
        match self.runtime.block_on(self.keeping.get_opts(&path, options)) {
            Err(Error::NotFound { .. }) => Ok(None),
            Err(error) => Err(failed(error)),
            Ok(GetResult { meta, attributes, .. }) => {
                let writer = attributes.get(&Attribute::Metadata(WRITER.into()));
                let writer = writer.map(|writer| writer.to_string());
                let found = Found { key: key.to_owned(), length: meta.size, etag: meta.e_tag };
                Ok(Some((found, writer)))
            }
        }
    }

    /// A whole object, which is small; `None` if it is not there.
    ///
    /// # Errors
    /// See [`ObjectError`].
    pub fn get(&self, key: &str) -> Result<Option<Vec<u8>>, ObjectError> {
        let failed = |error| self.explain(key, "read", error);
        let path = Self::path(key).map_err(failed)?;
        let got = self.runtime.block_on(async {
            let got = self.keeping.get_opts(&path, GetOptions::default()).await?;
            let wanted = got.meta.size;
            Ok((wanted, got.bytes().await?))
        });
        match got {
            Ok((wanted, bytes)) if bytes.len() as u64 == wanted => Ok(Some(bytes.to_vec())),
            Ok((wanted, bytes)) => Err(self.short(key, bytes.len(), wanted)),
            Err(Error::NotFound { .. }) => Ok(None),
            Err(error) => Err(failed(error)),
        }
    }

    /// Bytes of an object that is still the one that had this `ETag`.
    ///
    /// # Errors
    /// [`ObjectError::Changed`] if it is another now; see [`ObjectError`].
    pub fn read(
        &self,
        key: &str,
        etag: Option<&str>,
        range: Range<u64>,
    ) -> Result<Bytes, ObjectError> {
        /// How often a server may say that this is all, when it is not.
        const TRIES: u32 = 4;
        let wanted = range.end.saturating_sub(range.start);
        if wanted == 0 {
            return Ok(Bytes::new());
        }
        let failed = |error| self.explain(key, "read", error);
        let path = Self::path(key).map_err(failed)?;
        let mut got = 0;
        for pause in 0..TRIES {
            if pause > 0 {
                thread::sleep(self.first_pause * (1 << pause));
            }
            let options = GetOptions {
                range: Some(GetRange::Bounded(range.clone())),
                if_match: etag.map(str::to_owned),
                ..GetOptions::default()
            };
            let read = self.runtime.block_on(async {
                let got = self.keeping.get_opts(&path, options).await?;
                let etag = got.meta.e_tag.clone();
                Ok((etag, got.bytes().await?))
            });
            let (now, bytes) = read.map_err(failed)?;
            // Not every server knows the condition.
            if let (Some(then), Some(now)) = (etag, now)
                && then != now
            {
                return Err(ObjectError::Changed { name: self.address(key).to_string() });
            }
            if bytes.len() as u64 == wanted {
                return Ok(bytes);
            }
            got = bytes.len();
        }
        Err(self.short(key, got, wanted))
    }

    /// Writes a small object unless there is one of that name. Returns whether it was written.
    ///
    /// # Errors
    /// See [`ObjectError`].
    pub fn create(&self, key: &str, bytes: Vec<u8>) -> Result<bool, ObjectError> {
        let failed = |error| self.explain(key, "write", error);
        let path = Self::path(key).map_err(failed)?;
        let options = PutOptions::from(PutMode::Create);
        match self.runtime.block_on(self.keeping.put_opts(&path, bytes.into(), options)) {
            Ok(_) => Ok(true),
            Err(Error::AlreadyExists { .. }) => Ok(false),
            Err(error) => Err(failed(error)),
        }
    }

    pub(crate) fn path(key: &str) -> Result<Key, Error> {
        Ok(Key::parse(key)?)
    }

    pub(crate) fn writer(value: &str) -> (Attribute, AttributeValue) {
        (Attribute::Metadata(WRITER.into()), value.to_owned().into())
    }

    fn short(&self, key: &str, got: usize, wanted: u64) -> ObjectError {
        ObjectError::Short { name: self.address(key).to_string(), got: got as u64, wanted }
    }

    /// What an error of the library means for an object.
    pub(crate) fn explain(&self, key: &str, doing: &'static str, error: Error) -> ObjectError {
        let name = self.address(key).to_string();
        let mut cause: Option<&(dyn std::error::Error + 'static)> = Some(&error);
        while let Some(found) = cause {
            if let Some(refusal) = found.downcast_ref::<Refusal>() {
                return self.refused(name, refusal);
            }
            if found.is::<RangeIgnored>() {
                return ObjectError::NoRanges { name };
            }
            if found.is::<NoMachineCredentials>() {
                return ObjectError::NoCredentials { name };
            }
            cause = found.source();
        }
        match error {
            Error::NotFound { .. } => ObjectError::Missing { name },
            Error::Precondition { .. } => ObjectError::Changed { name },
            Error::AlreadyExists { .. } => ObjectError::Exists { name },
            error => ObjectError::Failed { doing, name, source: Box::new(error) },
        }
    }

    fn refused(&self, name: String, refusal: &Refusal) -> ObjectError {
        let advice = match (refusal.code.as_str(), refusal.status) {
            ("NoSuchBucket", _) => {
                return ObjectError::NoBucket { name, bucket: self.name.clone() };
            }
            ("InvalidAccessKeyId" | "SignatureDoesNotMatch", _) => {
                "check AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY, and that they belong to this endpoint"
            }
            ("ExpiredToken" | "InvalidToken" | "TokenRefreshRequired", _) => {
                "the credentials have expired or belong to another session; get new ones (AWS_SESSION_TOKEN)"
            }
            ("RequestTimeTooSkewed", _) => "set the clock of this machine",
            ("AuthorizationHeaderMalformed" | "PermanentRedirect", _) | (_, 300..=399) => {
                "set AWS_REGION to the region of the bucket, and AWS_ENDPOINT_URL to its endpoint"
            }
            (_, 401 | 403) => {
                "check the credentials (AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY) and what they permit: listing, reading and writing"
            }
            (_, 405 | 501) => {
                "this endpoint cannot do what is needed (docs/long-builds.md says what that is)"
            }
            _ => "correct the name or the settings (AWS_REGION, AWS_ENDPOINT_URL, credentials)",
        };
        ObjectError::Refused { name, why: refusal.to_string(), advice }
    }
}
