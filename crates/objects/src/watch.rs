//! Between `object_store` and the network: what passes is counted, and five things are done that `object_store` does not do.
//!
//! - The end of an upload in parts is made conditional (`If-None-Match: *`). S3 knows that, `object_store` asks for it only when it copies.
//! - That two write one object at the same moment (409) is no answer yet: the request is made again, and then one of them was first.
//! - A refusal that no repetition can change ends at once, and with the words that S3 has for it.
//! - An answer ends with an error where it has more bytes than such an answer can have.
//! - A request that was cut off is made again also where it may have arrived: every request of this crate can be made twice.

use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, PoisonError},
};

use async_trait::async_trait;
use http_body_util::{BodyExt as _, Limited};
use object_store::{
    ClientOptions, HeaderValue,
    client::{
        HttpClient, HttpConnector, HttpError, HttpErrorKind, HttpRequest, HttpResponse,
        HttpResponseBody, HttpService, ReqwestConnector,
    },
};

/// What passed so far, by the name of the method: how many requests, and the bytes of their bodies there and back.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Requests {
    /// `GET`, `HEAD`, `PUT`, `POST`, `DELETE` and how often each was sent, repetitions included.
    pub by_method: BTreeMap<String, u64>,
    /// Bytes of bodies sent.
    pub sent_bytes: u64,
    /// Bytes of bodies received, as the answers announce them.
    pub received_bytes: u64,
}

/// Counts of one [`Storage`](crate::Storage), shared by its buckets.
#[derive(Debug, Default)]
pub(crate) struct Counter(Mutex<Requests>);

impl Counter {
    pub(crate) fn so_far(&self) -> Requests {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn change(&self, change: impl FnOnce(&mut Requests)) {
        change(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner));
    }
}

/// What an upload in parts does at its end where there is an object of that name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AtTheEnd {
    Refuse,
    Replace,
}

/// Makes HTTP clients that are watched.
#[derive(Debug)]
pub(crate) struct Watch {
    pub(crate) counter: Arc<Counter>,
    pub(crate) at_the_end: AtTheEnd,
}

impl HttpConnector for Watch {
    fn connect(&self, options: &ClientOptions) -> object_store::Result<HttpClient> {
        let inner = ReqwestConnector::default().connect(options)?;
        let Self { counter, at_the_end } = self;
        let counter = Arc::clone(counter);
        Ok(HttpClient::new(Watched { inner, counter, at_the_end: *at_the_end }))
    }
}

#[derive(Debug)]
struct Watched {
    inner: HttpClient,
    counter: Arc<Counter>,
    at_the_end: AtTheEnd,
}

/// A refusal that no repetition can change.
#[derive(Debug, thiserror::Error)]
#[error("{status} {code}: {message}")]
pub(crate) struct Refusal {
    pub(crate) status: u16,
    /// S3's word for it; empty where the answer has none.
    pub(crate) code: String,
    pub(crate) message: String,
}

/// The server sent the whole object where a part of it was asked for.
#[derive(Debug, thiserror::Error)]
#[error("the answer holds the whole object instead of the range that was asked for")]
pub(crate) struct RangeIgnored;

/// The answer has more bytes than it can have.
#[derive(Debug, thiserror::Error)]
#[error("the answer has more than {most} bytes")]
pub(crate) struct AnswerTooLarge {
    pub(crate) most: u64,
}

/// The answer says what no honest one does.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub(crate) struct BadAnswer(pub(crate) String);

/// Names of objects have 1024 bytes at most, names of uploads and pages fewer than this. `object_store` puts them into addresses of requests, and panics where
/// these are too long.
const LONGEST_NAME_BYTES: usize = 8192;

/// Refuses what is too long for a name.
pub(crate) fn check_name(of: &str, name: &str) -> Result<(), BadAnswer> {
    if name.len() <= LONGEST_NAME_BYTES {
        return Ok(());
    }
    Err(BadAnswer(format!("{of} of {} bytes", name.len())))
}

/// Whether a range of bytes ends where one can; `object_store` adds one to it.
fn is_possible(content_range: &HeaderValue) -> bool {
    let text = content_range.to_str().unwrap_or_default();
    let last = text.split_once('-').and_then(|(_, rest)| rest.split('/').next()?.parse().ok());
    last.is_none_or(|last: u64| i64::try_from(last).is_ok())
}

/// A list has a thousand names of 1024 bytes at most, written as XML; a whole object that is read at once is small.
const MOST_WHOLE_BYTES: u64 = 64 << 20;
/// All else has some words.
const MOST_WORDS_BYTES: u64 = 1 << 20;

/// The most bytes that the body of an answer can have.
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

/// The body of an answer, which fails beyond so many bytes.
fn bounded(body: HttpResponseBody, most: u64) -> HttpResponseBody {
    let limited = Limited::new(body, usize::try_from(most).unwrap_or(usize::MAX));
    HttpResponseBody::new(limited.map_err(move |error| match error.downcast() {
        Ok(error) => *error,
        Err(_) => HttpError::new(HttpErrorKind::Decode, AnswerTooLarge { most }),
    }))
}

/// This machine gives no credentials.
#[derive(Debug, thiserror::Error)]
#[error("no credentials are set, and this machine gives none")]
pub(crate) struct NoMachineCredentials;

#[async_trait]
impl HttpService for Watched {
    async fn call(&self, mut request: HttpRequest) -> Result<HttpResponse, HttpError> {
        let method = request.method().clone();
        // Where machines of a cloud ask for credentials. Elsewhere nobody answers, however often one asks.
        let is_metadata = request.uri().host().is_some_and(|host| host.starts_with("169.254."));
        let has_range = request.headers().contains_key("range");
        let is_end_of_upload = method.as_str() == "POST"
            && request.uri().query().is_some_and(|query| query.contains("uploadId="));
        if is_end_of_upload && self.at_the_end == AtTheEnd::Refuse {
            // Only headers that begin with x-amz- must be signed.
            request.headers_mut().insert("if-none-match", HeaderValue::from_static("*"));
        }
        let most = most_bytes(&request);
        let sent_bytes = request.body().content_length() as u64;
        self.counter.change(|counts| {
            *counts.by_method.entry(method.as_str().to_owned()).or_default() += 1;
            counts.sent_bytes += sent_bytes;
        });
        let response = self.inner.execute(request).await.map_err(|error| {
            let kind = error.kind();
            match kind {
                HttpErrorKind::Connect | HttpErrorKind::Timeout if is_metadata => {
                    HttpError::new(HttpErrorKind::Unknown, NoMachineCredentials)
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
            self.counter.change(|counts| counts.received_bytes += received.unwrap_or_default());
        }
        if received.is_some_and(|length| length > most) && method.as_str() != "HEAD" {
            return Err(HttpError::new(HttpErrorKind::Decode, AnswerTooLarge { most }));
        }
        if response.headers().get("content-range").is_some_and(|range| !is_possible(range)) {
            let bad = BadAnswer("a range that ends beyond any object".to_owned());
            return Err(HttpError::new(HttpErrorKind::Decode, bad));
        }
        let response = response.map(|body| bounded(body, most));
        let status = response.status();
        if has_range && status.as_u16() == 200 {
            return Err(HttpError::new(HttpErrorKind::Decode, RangeIgnored));
        }
        if status.is_success() || status.as_u16() == 304 {
            return Ok(response);
        }
        // One that asks for patience has credentials.
        if is_metadata && status.is_client_error() && status.as_u16() != 429 {
            return Err(HttpError::new(HttpErrorKind::Decode, NoMachineCredentials));
        }
        let (mut parts, body) = response.into_parts();
        // S3: "ConditionalRequestConflict", "OperationAborted"; `object_store` would take it for an object that is there.
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
        // With a request that took too long, the server asks to send it again.
        if is_final && code != "RequestTimeout" {
            let message = match parts.headers.get("x-amz-bucket-region") {
                Some(region) if status.is_redirection() || status.as_u16() == 400 => {
                    format!("the bucket is in the region {}", region.to_str().unwrap_or("?"))
                }
                _ if message.is_empty() => status.canonical_reason().unwrap_or_default().to_owned(),
                _ => message,
            };
            let refusal = Refusal { status: status.as_u16(), code, message };
            return Err(HttpError::new(HttpErrorKind::Decode, refusal));
        }
        // Short, so that it fits a message.
        let told = if code.is_empty() { String::new() } else { format!("{code}: {message}") };
        Ok(HttpResponse::from_parts(parts, HttpResponseBody::from(told)))
    }
}

/// The text of the first element of this name, on one line and not too long; empty if there is none.
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
