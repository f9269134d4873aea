//! Answers requests for served files.

use std::{io, sync::Arc};

use bytes::Bytes;
use hyper::{
    HeaderMap, Method, Request, Response, StatusCode, Version,
    header::{
        ACCEPT_RANGES, ACCESS_CONTROL_ALLOW_HEADERS, ACCESS_CONTROL_ALLOW_METHODS,
        ACCESS_CONTROL_ALLOW_ORIGIN, ACCESS_CONTROL_EXPOSE_HEADERS, ACCESS_CONTROL_MAX_AGE, ALLOW,
        CACHE_CONTROL, CONTENT_ENCODING, CONTENT_LENGTH, CONTENT_RANGE, CONTENT_SECURITY_POLICY,
        CONTENT_TYPE, ETAG, HOST, HeaderName, HeaderValue, VARY, X_CONTENT_TYPE_OPTIONS,
    },
};
use tokio::fs::File;

use crate::{
    body::{Body, of_bytes, of_file},
    conditions::RequestedRange,
    host::Hosts,
    media_type::media_type,
    on_disk::{self, OpenedFile},
    packed,
    refusal::{METHODS, ServeRefusal},
    routes::{FileContent, Readers, Routes, ServedRoute},
};

/// The served files, and the clients that may read them.
#[derive(Debug)]
pub(crate) struct Site {
    pub(crate) routes: Routes,
    pub(crate) hosts: Hosts,
}

impl Site {
    /// The answer to a request, whose body is ignored.
    pub(crate) async fn answer<B>(&self, request: &Request<B>) -> Response<Body> {
        if let Err(refusal) = self.check_host(request) {
            return finished(refusal.answer(), Readers::OwnPages);
        }
        let Some((path, route)) = self.routes.find(request.uri().path()) else {
            // A page that requests a missing file gets this error, whatever its origin.
            return finished(ServeRefusal::Unknown.answer(), Readers::AnyPage);
        };
        let answered = match *request.method() {
            Method::GET | Method::HEAD => send(request, path, route).await,
            Method::OPTIONS => Ok(methods(route.readers)),
            _ => Err(ServeRefusal::Method),
        };
        finished(answered.unwrap_or_else(|refusal| refusal.answer()), route.readers)
    }

    fn check_host<B>(&self, request: &Request<B>) -> Result<(), ServeRefusal> {
        let named = request.headers().get_all(HOST);
        if named.iter().next().is_none() && request.version() == Version::HTTP_11 {
            return Err(ServeRefusal::NoHost);
        }
        // A request may have a whole URL instead of a path; then its host counts.
        let in_address = request.uri().authority().map(|authority| Ok(authority.as_str()));
        let hosts = named.iter().map(HeaderValue::to_str).chain(in_address);
        for host in hosts {
            if !host.is_ok_and(|host| self.hosts.allow(host)) {
                return Err(ServeRefusal::OtherHost);
            }
        }
        Ok(())
    }
}

/// Adds the headers of all answers.
fn finished(mut answer: Response<Body>, readers: Readers) -> Response<Body> {
    let headers = answer.headers_mut();
    headers.insert(X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    // A browser may cache the answer, but must revalidate it each time.
    headers.insert(CACHE_CONTROL, HeaderValue::from_static("no-cache"));
    if readers == Readers::AnyPage {
        headers.insert(ACCESS_CONTROL_ALLOW_ORIGIN, HeaderValue::from_static("*"));
        let readable = "ETag, Content-Range, Content-Length, Accept-Ranges";
        headers.insert(ACCESS_CONTROL_EXPOSE_HEADERS, HeaderValue::from_static(readable));
    }
    answer
}

/// The allowed methods and headers: the answer to a preflight request of a browser for a page of
/// another server.
fn methods(readers: Readers) -> Response<Body> {
    let mut answer = Response::new(of_bytes(Bytes::new()));
    *answer.status_mut() = StatusCode::NO_CONTENT;
    let headers = answer.headers_mut();
    headers.insert(ALLOW, HeaderValue::from_static(METHODS));
    if readers == Readers::AnyPage {
        let conditions = "Range, If-Range, If-Match, If-None-Match";
        headers.insert(ACCESS_CONTROL_ALLOW_METHODS, HeaderValue::from_static(METHODS));
        headers.insert(ACCESS_CONTROL_ALLOW_HEADERS, HeaderValue::from_static(conditions));
        headers.insert(ACCESS_CONTROL_MAX_AGE, HeaderValue::from_static("86400"));
    }
    answer
}

/// A file as it is now.
struct Opened {
    length_bytes: u64,
    tag: String,
    is_packed: bool,
    source: Source,
}

enum Source {
    Memory(Bytes),
    Disk(File),
}

async fn send<B>(
    request: &Request<B>,
    path: &str,
    route: &ServedRoute,
) -> Result<Response<Body>, ServeRefusal> {
    let unreadable = |error: io::Error| match error.kind() {
        io::ErrorKind::NotFound => ServeRefusal::Gone { path: path.to_owned() },
        _ => ServeRefusal::Unreadable { path: path.to_owned(), reason: error.to_string() },
    };
    let opened = open(request.headers(), route).await.map_err(unreadable)?;
    let Opened { length_bytes, tag, is_packed, source } = opened;
    let wanted =
        RequestedRange::from_request(request.method(), request.headers(), length_bytes, &tag);
    let mut headers = HeaderMap::new();
    let mut set = |name: HeaderName, value: &str| {
        // Numbers and our own tags are always valid header values.
        if let Ok(value) = value.parse() {
            headers.insert(name, value);
        }
    };
    set(ETAG, &tag);
    set(ACCEPT_RANGES, "bytes");
    let (status, range) = match wanted {
        RequestedRange::Changed => return Err(ServeRefusal::Changed),
        RequestedRange::NoSuchBytes => return Err(ServeRefusal::NoSuchBytes { length_bytes }),
        RequestedRange::Unchanged => (StatusCode::NOT_MODIFIED, None),
        RequestedRange::Whole => (StatusCode::OK, length_bytes.checked_sub(1).map(|last| 0..=last)),
        RequestedRange::Part(range) => {
            set(CONTENT_RANGE, &format!("bytes {}-{}/{length_bytes}", range.start(), range.end()));
            (StatusCode::PARTIAL_CONTENT, Some(range))
        }
    };
    if status != StatusCode::NOT_MODIFIED {
        if is_packed {
            set(CONTENT_ENCODING, "br");
        }
        set(CONTENT_TYPE, media_type(path));
        if let Some(policy) = &route.policy {
            set(CONTENT_SECURITY_POLICY, policy);
        }
        let sent = range.as_ref().map_or(0, |range| range.end() - range.start() + 1);
        set(CONTENT_LENGTH, &sent.to_string());
    }
    let body = match (range, source) {
        (Some(range), source) if *request.method() == Method::GET => match source {
            Source::Memory(bytes) => {
                of_bytes(bytes.slice(*range.start() as usize..=*range.end() as usize))
            }
            Source::Disk(file) => of_file(file, &range).await.map_err(unreadable)?,
        },
        _ => of_bytes(Bytes::new()),
    };
    if route.packed.is_some() {
        headers.insert(VARY, packed::VARIES_BY);
    }
    let mut answer = Response::new(body);
    *answer.status_mut() = status;
    *answer.headers_mut() = headers;
    Ok(answer)
}

async fn open(headers: &HeaderMap, route: &ServedRoute) -> io::Result<Opened> {
    match &route.content {
        FileContent::Memory(bytes) => {
            let packed = match route.packed.clone().filter(|_| packed::is_wanted(headers)) {
                Some(way) => {
                    let bytes = bytes.clone();
                    let packed = tokio::task::spawn_blocking(move || way.compressed(&bytes));
                    packed.await.map_err(io::Error::other)?
                }
                None => None,
            };
            let (tag, is_packed) = (&route.tag_in_memory, packed.is_some());
            let tag = if is_packed { packed::tag_of(tag) } else { tag.clone() };
            let bytes = packed.unwrap_or_else(|| bytes.clone());
            let length_bytes = bytes.len() as u64;
            Ok(Opened { length_bytes, tag, is_packed, source: Source::Memory(bytes) })
        }
        FileContent::Disk(on_disk) => {
            let (on_disk, known) = (Arc::clone(on_disk), Arc::clone(&route.known));
            let opened = tokio::task::spawn_blocking(move || on_disk::open(&*on_disk, &known));
            let OpenedFile { file, length_bytes, tag } =
                opened.await.map_err(io::Error::other)??;
            let source = Source::Disk(File::from_std(file));
            Ok(Opened { length_bytes, tag, is_packed: false, source })
        }
    }
}
