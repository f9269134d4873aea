//! A bucket of object storage: lists, finds, reads and creates its objects.

use std::{
    collections::{BTreeMap, BTreeSet},
    fmt,
    ops::Range,
    sync::Arc,
    thread,
    time::{Duration, Instant},
};

use bytes::Bytes;
use object_store::{
    Attribute, AttributeValue, Error, GetOptions, GetRange, GetResult, HeaderValue, ObjectStore,
    PutMode, PutOptions,
    aws::{AmazonS3, S3ConditionalPut},
    list::{PaginatedListOptions, PaginatedListStore as _},
    path::Path as Key,
};
use tokio::runtime::{Builder, Runtime};

use crate::{
    ObjectAddress, ObjectError, StorageRequests, StorageSettings,
    watch::{AtTheEnd, FinalError, RequestWatch, StorageCounter, check_name},
};

/// The largest number of listed names directly below a prefix: many times the number of parts of
/// the largest plan.
const MOST_LISTED: usize = 100_000;
/// The largest number of consecutive pages without a new name, which some servers send while they
/// search.
const MOST_EMPTY_PAGES: u32 = 8;
/// The largest number of answers to one list request; a server sends a thousand names in each.
const MOST_PAGES: usize = 1_000;
/// The time limit of a listing.
const LIST_WITHIN: Duration = Duration::from_mins(10);

/// The metadata field that identifies the writer of an object, a random number.
pub(crate) const WRITER: &str = "corniche-writer";

/// Object storage as configured by the environment.
#[derive(Debug)]
pub struct Storage {
    settings: StorageSettings,
    runtime: Arc<Runtime>,
    counter: Arc<StorageCounter>,
}

/// The objects of a bucket. All methods block, and many threads may call them at once.
#[derive(Clone)]
pub struct Bucket {
    name: String,
    /// Completes uploads only if no object of that name exists.
    pub(crate) keeping: Arc<AmazonS3>,
    /// Completes uploads in any case.
    pub(crate) replacing: Arc<AmazonS3>,
    pub(crate) runtime: Arc<Runtime>,
    pub(crate) first_pause: Duration,
}

/// A listed or requested object.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ObjectInfo {
    /// The key of the object.
    pub key: String,
    /// The length of the object, bytes.
    pub length: u64,
    /// The `ETag` of the object, which changes with its content, if the server sends one.
    pub etag: Option<String>,
}

impl Storage {
    /// Creates the storage without any request to the server.
    ///
    /// # Errors
    /// [`ObjectError::Settings`] if the runtime cannot be created.
    pub fn new(settings: StorageSettings) -> Result<Self, ObjectError> {
        // If a second client in this process has chosen another provider, it works as well: then
        // this call does nothing.
        let _ = rustls::crypto::ring::default_provider().install_default();
        let runtime = Builder::new_multi_thread()
            .worker_threads(1)
            .thread_name("objects")
            .enable_all()
            .build()
            .map_err(|error| ObjectError::Settings { what: error.to_string() })?;
        Ok(Self { settings, runtime: Arc::new(runtime), counter: Arc::default() })
    }

    /// Returns a bucket, which need not exist.
    ///
    /// # Errors
    /// [`ObjectError::Settings`] if the environment variables are invalid.
    pub fn bucket(&self, name: &str) -> Result<Bucket, ObjectError> {
        let client = |at_the_end| {
            let watch = RequestWatch { counter: Arc::clone(&self.counter), at_the_end };
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

    /// The counts of requests and bytes so far.
    #[must_use]
    pub fn requests(&self) -> StorageRequests {
        self.counter.so_far()
    }
}

impl fmt::Debug for Bucket {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Bucket").field("name", &self.name).finish_non_exhaustive()
    }
}

impl Bucket {
    /// The address of an object in the bucket.
    #[must_use]
    pub fn address(&self, key: &str) -> ObjectAddress {
        ObjectAddress { bucket: self.name.clone(), key: key.to_owned() }
    }

    /// Lists the keys of the objects and folders directly below a prefix (`PREFIX/…`; an empty one
    /// lists the bucket).
    ///
    /// # Errors
    /// See [`ObjectError`].
    pub fn list(&self, prefix: &str) -> Result<(Vec<ObjectInfo>, Vec<String>), ObjectError> {
        let (path, failed) = self.object(prefix, "list")?;
        let prefix = if prefix.is_empty() { String::new() } else { format!("{path}/") };
        let (mut found, mut folders) = (BTreeMap::new(), BTreeSet::new());
        let begun = Instant::now();
        let (mut page_token, mut without_names) = (None, 0);
        for _ in 0..MOST_PAGES {
            let options = PaginatedListOptions {
                delimiter: Some("/".into()),
                page_token: page_token.clone(),
                ..PaginatedListOptions::default()
            };
            let page = self.keeping.list_paginated(Some(prefix.as_str()), options);
            let page = self.runtime.block_on(page).map_err(failed)?;
            let names = page.result.objects.iter().map(|object| object.location.as_ref());
            let token = page.page_token.as_deref().map(|token| ("the name of a page", token));
            for (of, name) in names.map(|name| ("the name of an object", name)).chain(token) {
                check_name(of, name).map_err(|bad| self.explain_final(&prefix, &bad))?;
            }
            let before = found.len() + folders.len();
            found.extend(page.result.objects.into_iter().filter_map(|object| {
                let (key, length) = (object.location.to_string(), object.size);
                // A tag that no request can contain is ignored.
                let etag = object.e_tag.filter(|etag| HeaderValue::from_str(etag).is_ok());
                // Programs that show folders create an object for the prefix itself.
                let is_beneath = key.len() > prefix.trim_end_matches('/').len();
                is_beneath.then(|| (key.clone(), ObjectInfo { key, length, etag }))
            }));
            folders.extend(page.result.common_prefixes.iter().map(ToString::to_string));
            if page.page_token.is_none() {
                return Ok((found.into_values().collect(), folders.into_iter().collect()));
            }
            let count = found.len() + folders.len();
            without_names = if count == before { without_names + 1 } else { 0 };
            let is_stuck = page.page_token == page_token || without_names > MOST_EMPTY_PAGES;
            if is_stuck || count > MOST_LISTED || begun.elapsed() > LIST_WITHIN {
                break;
            }
            page_token = page.page_token;
        }
        let (name, count) = (self.address(&prefix).to_string(), found.len() + folders.len());
        Err(ObjectError::EndlessList { name, count })
    }

    /// Returns an object's length and `ETag`; `None` if it does not exist.
    ///
    /// # Errors
    /// See [`ObjectError`].
    pub fn find(&self, key: &str) -> Result<Option<ObjectInfo>, ObjectError> {
        Ok(self.look(key)?.map(|(found, _)| found))
    }

    /// Returns an object's length and `ETag`, and its writer.
    pub(crate) fn look(
        &self,
        key: &str,
    ) -> Result<Option<(ObjectInfo, Option<String>)>, ObjectError> {
        let (path, failed) = self.object(key, "look for")?;
        let options = GetOptions { head: true, ..GetOptions::default() };
        match self.runtime.block_on(self.keeping.get_opts(&path, options)) {
            Err(Error::NotFound { .. }) => Ok(None),
            Err(error) => Err(failed(error)),
            Ok(GetResult { meta, attributes, .. }) => {
                let writer = attributes.get(&Attribute::Metadata(WRITER.into()));
                let writer = writer.map(|writer| writer.to_string());
                let found = ObjectInfo { key: key.to_owned(), length: meta.size, etag: meta.e_tag };
                Ok(Some((found, writer)))
            }
        }
    }

    /// Returns a whole small object; `None` if it does not exist.
    ///
    /// # Errors
    /// See [`ObjectError`].
    pub fn get(&self, key: &str) -> Result<Option<Vec<u8>>, ObjectError> {
        let (path, failed) = self.object(key, "read")?;
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

    /// Reads bytes of an object that still has this `ETag`.
    ///
    /// # Errors
    /// [`ObjectError::Changed`] if the object has changed; see [`ObjectError`].
    pub fn read(
        &self,
        key: &str,
        etag: Option<&str>,
        range: Range<u64>,
    ) -> Result<Bytes, ObjectError> {
        /// The number of tries until a server sends all bytes.
        const TRIES: u32 = 4;
        let wanted = range.end.saturating_sub(range.start);
        if wanted == 0 {
            return Ok(Bytes::new());
        }
        let (path, failed) = self.object(key, "read")?;
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
            // Not every server supports the condition.
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

    /// Writes a small object unless one of that name exists. Returns whether it was written.
    ///
    /// # Errors
    /// See [`ObjectError`].
    pub fn create(&self, key: &str, bytes: Vec<u8>) -> Result<bool, ObjectError> {
        let (path, failed) = self.object(key, "write")?;
        let options = PutOptions::from(PutMode::Create);
        match self.runtime.block_on(self.keeping.put_opts(&path, bytes.into(), options)) {
            Ok(_) => Ok(true),
            Err(Error::AlreadyExists { .. }) => Ok(false),
            Err(error) => Err(failed(error)),
        }
    }

    /// The library's path of an object, and the translation of its errors for this operation.
    pub(crate) fn object<'a>(
        &'a self,
        key: &'a str,
        doing: &'static str,
    ) -> Result<(Key, impl Fn(Error) -> ObjectError + Copy + 'a), ObjectError> {
        let explain = move |error| self.explain(key, doing, error);
        Ok((Key::parse(key).map_err(|error| explain(error.into()))?, explain))
    }

    pub(crate) fn writer(value: &str) -> (Attribute, AttributeValue) {
        (Attribute::Metadata(WRITER.into()), value.to_owned().into())
    }

    pub(crate) fn missing(&self, key: &str) -> ObjectError {
        ObjectError::Missing { name: self.address(key).to_string() }
    }

    fn short(&self, key: &str, got: usize, wanted: u64) -> ObjectError {
        ObjectError::Short { name: self.address(key).to_string(), got: got as u64, wanted }
    }

    /// Translates an error of the library for an object.
    pub(crate) fn explain(&self, key: &str, doing: &'static str, error: Error) -> ObjectError {
        let mut cause: Option<&(dyn std::error::Error + 'static)> = Some(&error);
        while let Some(found) = cause {
            if let Some(found) = found.downcast_ref() {
                return self.explain_final(key, found);
            }
            cause = found.source();
        }
        let name = self.address(key).to_string();
        match error {
            Error::NotFound { .. } => ObjectError::Missing { name },
            Error::Precondition { .. } => ObjectError::Changed { name },
            Error::AlreadyExists { .. } => ObjectError::Exists { name },
            error => ObjectError::Failed { doing, name, source: Box::new(error) },
        }
    }

    fn explain_final(&self, key: &str, error: &FinalError) -> ObjectError {
        let name = self.address(key).to_string();
        let (code, status) = match error {
            FinalError::Refused { code, status, .. } => (code.as_str(), *status),
            FinalError::RangeIgnored => return ObjectError::NoRanges { name },
            FinalError::TooLarge { most } => return ObjectError::TooMuchSent { name, most: *most },
            FinalError::BadAnswer(what) => {
                return ObjectError::BadAnswer { name, what: what.clone() };
            }
            FinalError::NoMachineCredentials => return ObjectError::NoCredentials { name },
        };
        let advice = match (code, status) {
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
                "check the credentials (AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY) and their \
                 permissions: listing, reading and writing are needed"
            }
            (_, 405 | 501) => {
                "this endpoint lacks a required feature; docs/long-builds.md lists what is needed"
            }
            _ => "correct the name or the settings (AWS_REGION, AWS_ENDPOINT_URL, credentials)",
        };
        ObjectError::Refused { name, why: error.to_string(), advice }
    }
}
