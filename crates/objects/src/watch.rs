//! A layer between `object_store` and the network: it counts the traffic and does five things that
//! `object_store` does not do.
//!
//! - It makes the completion of a multipart upload conditional (`If-None-Match: *`). S3 supports
//!   this, but `object_store` requests it only for copies.
//! - A conflict of two writers of one object (409) is not final: the request is repeated, and then
//!   one of the writers was first.
//! - An error that no retry can change is returned at once, with S3's own code and message.
//! - An answer fails if it has more bytes than this kind of answer can have.
//! - A request whose connection broke is repeated, even if the server may have received it: every
//!   request of this crate can be repeated safely.

use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex},
};

use async_trait::async_trait;
use corniche_work::locked;
use http_body_util::{BodyExt as _, Limited};
use object_store::{
    ClientOptions, HeaderValue,
    client::{
        HttpClient, HttpConnector, HttpError, HttpErrorKind, HttpRequest, HttpResponse,
        HttpResponseBody, HttpService, ReqwestConnector,
    },
};

/// The traffic so far: the number of requests per method, and the bytes of bodies in both
/// directions.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct StorageRequests {
    /// The number of requests per method (`GET`, `HEAD`, `PUT`, `POST`, `DELETE`), retries
    /// included.
    pub by_method: BTreeMap<String, u64>,
    /// Bytes of bodies sent.
    pub sent_bytes: u64,
    /// Bytes of bodies received, according to `Content-Length`.
    pub received_bytes: u64,
}

/// Counts of one [`Storage`](crate::Storage), shared by its buckets.
#[derive(Debug, Default)]
pub(crate) struct StorageCounter(Mutex<StorageRequests>);

impl StorageCounter {
    pub(crate) fn so_far(&self) -> StorageRequests {
        locked(&self.0).clone()
    }

    fn change(&self, change: impl FnOnce(&mut StorageRequests)) {
        change(&mut locked(&self.0));
    }
}

/// The action at the end of a multipart upload if an object of that name exists.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AtTheEnd {
    Refuse,
    Replace,
}

/// Creates HTTP clients with this layer.
#[derive(Debug, Clone)]
pub(crate) struct RequestWatch {
    pub(crate) counter: Arc<StorageCounter>,
    pub(crate) at_the_end: AtTheEnd,
}

impl HttpConnector for RequestWatch {
    fn connect(&self, options: &ClientOptions) -> object_store::Result<HttpClient> {
        let inner = ReqwestConnector::default().connect(options)?;
        Ok(HttpClient::new(Watched { inner, watch: self.clone() }))
    }
}

#[derive(Debug)]
struct Watched {
    inner: HttpClient,
    watch: RequestWatch,
}

/// An error that no retry can change.
#[derive(Debug, thiserror::Error)]
pub(crate) enum FinalError {
    /// A refusal of the server. The S3 error code is empty if the answer has none.
    #[error("{status} {code}: {message}")]
    Refused { status: u16, code: String, message: String },
    #[error("the answer contains the whole object instead of the requested range")]
    RangeIgnored,
    /// The answer has more bytes than the kind of answer allows.
    #[error("the answer has more than {most} bytes")]
    TooLarge { most: u64 },
    /// The answer is invalid.
    #[error("{0}")]
    BadAnswer(String),
    #[error("no credentials are set, and this machine provides none")]
    NoMachineCredentials,
}

impl From<FinalError> for HttpError {
    /// Converts the error to one that `object_store` does not retry.
    fn from(error: FinalError) -> Self {
        Self::new(HttpErrorKind::Decode, error)
    }
}

/// The limit for names of objects (at most 1024 bytes), uploads and pages. `object_store` puts them
/// into URLs of requests, and panics if they are too long.
const LONGEST_NAME_BYTES: usize = 8192;

/// Rejects names that are too long.
pub(crate) fn check_name(of: &str, name: &str) -> Result<(), FinalError> {
    if name.len() <= LONGEST_NAME_BYTES {
        return Ok(());
    }
    Err(FinalError::BadAnswer(format!("{of} of {} bytes", name.len())))
}

/// Whether the end of a byte range is possible; `object_store` adds one to it.
fn is_possible(content_range: &HeaderValue) -> bool {
    let text = content_range.to_str().unwrap_or_default();
    let last = text.split_once('-').and_then(|(_, rest)| rest.split('/').next()?.parse().ok());
    last.is_none_or(|last: u64| i64::try_from(last).is_ok())
}

/// A list has at most a thousand names of 1024 bytes, written as XML; an object that is read as a
/// whole is small.
const MOST_WHOLE_BYTES: u64 = 64 << 20;
/// The limit for all other answers, which are short texts.
const MOST_WORDS_BYTES: u64 = 1 << 20;

/// The largest number of bytes in the body of the answer to a request.
fn most_bytes(request: &HttpRequest) -> u64 {
    let range = request.headers().get("range").and_then(|range| range.to_str().ok());
    let ends = range.and_then(|range| range.strip_prefix("bytes=")?.split_once('-'));
    let length = ends.and_then(|(first, last)| {
        last.parse::<u64>().ok()?.checked_sub(first.parse().ok()?)?.checked_add(1)
    });
    match length {
        Some(length) => length.max(MOST_WORDS_BYTES),
        None if request.method().as_str() == "GET" => MOST_WHOLE_BYTES,
        None => MOST_WORDS_BYTES,
    }
}

/// The body of an answer, which fails beyond this many bytes.
fn bounded(body: HttpResponseBody, most: u64) -> HttpResponseBody {
    let limited = Limited::new(body, usize::try_from(most).unwrap_or(usize::MAX));
    HttpResponseBody::new(limited.map_err(move |error| match error.downcast() {
        Ok(error) => *error,
        Err(_) => FinalError::TooLarge { most }.into(),
    }))
}

#[async_trait]
impl HttpService for Watched {
    async fn call(&self, mut request: HttpRequest) -> Result<HttpResponse, HttpError> {
        let RequestWatch { counter, at_the_end } = &self.watch;
        let method = request.method().clone();
        // The addresses where cloud machines request credentials. Elsewhere nothing answers,
        // however often one asks.
        let is_metadata = request.uri().host().is_some_and(|host| host.starts_with("169.254."));
        let has_range = request.headers().contains_key("range");
        let is_end_of_upload = method.as_str() == "POST"
            && request.uri().query().is_some_and(|query| query.contains("uploadId="));
        if is_end_of_upload && *at_the_end == AtTheEnd::Refuse {
            // Only headers that begin with x-amz- must be signed.
            request.headers_mut().insert("if-none-match", HeaderValue::from_static("*"));
        }
        let most = most_bytes(&request);
        let sent_bytes = request.body().content_length() as u64;
        counter.change(|counts| {
            *counts.by_method.entry(method.as_str().to_owned()).or_default() += 1;
            counts.sent_bytes += sent_bytes;
        });
        let response = self.inner.execute(request).await.map_err(|error| {
            let kind = error.kind();
            match kind {
                HttpErrorKind::Connect | HttpErrorKind::Timeout if is_metadata => {
                    HttpError::new(HttpErrorKind::Unknown, FinalError::NoMachineCredentials)
                }
                HttpErrorKind::Interrupted | HttpErrorKind::Timeout | HttpErrorKind::Unknown => {
                    HttpError::new(HttpErrorKind::Request, error)
                }
                _ => error,
            }
        })?;
        let received = response.headers().get("content-length");
        let received = received.and_then(|length| length.to_str().ok()?.parse::<u64>().ok());
        if method.as_str() != "HEAD" {
            counter.change(|counts| counts.received_bytes += received.unwrap_or_default());
        }
        if received.is_some_and(|length| length > most) && method.as_str() != "HEAD" {
            return Err(FinalError::TooLarge { most }.into());
        }
        if response.headers().get("content-range").is_some_and(|range| !is_possible(range)) {
            let what = "a range that ends beyond any object".to_owned();
            return Err(FinalError::BadAnswer(what).into());
        }
        let response = response.map(|body| bounded(body, most));
        let status = response.status();
        if has_range && status.as_u16() == 200 {
            return Err(FinalError::RangeIgnored.into());
        }
        if status.is_success() || status.as_u16() == 304 {
            return Ok(response);
        }
        // A server that throttles requests does have credentials.
        if is_metadata && status.is_client_error() && status.as_u16() != 429 {
            return Err(FinalError::NoMachineCredentials.into());
        }
        let (mut parts, body) = response.into_parts();
        // With these S3 codes ("ConditionalRequestConflict", "OperationAborted"), `object_store`
        // would assume an existing object.
        if status.as_u16() == 409
            && (method.as_str() == "PUT" || is_end_of_upload)
            && let Ok(busy) = 503.try_into()
        {
            parts.status = busy;
        }
        let body = body.bytes().await.unwrap_or_default();
        let body = String::from_utf8_lossy(&body);
        let code = element(&body, "Code");
        let message = element(&body, "Message");
        let is_final = match status.as_u16() {
            300..=399 | 400 | 401 | 403 | 405 | 411 | 501 => true,
            404 => code == "NoSuchBucket",
            _ => false,
        };
        // With this status, the server asks for the slow request to be sent again.
        if is_final && code != "RequestTimeout" {
            let message = match parts.headers.get("x-amz-bucket-region") {
                Some(region) if status.is_redirection() || status.as_u16() == 400 => {
                    format!("the bucket is in the region {}", region.to_str().unwrap_or("?"))
                }
                _ if message.is_empty() => status.canonical_reason().unwrap_or_default().to_owned(),
                _ => message,
            };
            let status = status.as_u16();
            return Err(FinalError::Refused { status, code, message }.into());
        }
        // The text is short, so that it fits a message.
        let told = if code.is_empty() { String::new() } else { format!("{code}: {message}") };
        Ok(HttpResponse::from_parts(parts, HttpResponseBody::from(told)))
    }
}

/// The text of the first element of this name, on one line and shortened; empty if there is none.
fn element(xml: &str, name: &str) -> String {
    const LONGEST: usize = 200;
    let inside = xml
        .split_once(&format!("<{name}>"))
        .and_then(|(_, rest)| rest.split_once(&format!("</{name}>")))
        .map_or("", |(text, _)| text);
    let words: Vec<&str> = inside.split_whitespace().collect();
    words.join(" ").chars().take(LONGEST).collect()
}

#[cfg(test)]
#[path = "watch_tests.rs"]
mod tests;
