//! Requests one range of a file, checks the answer, and retries.

use std::{
    error::Error,
    io,
    ops::Range,
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::{Duration, Instant},
};

use bytes::{Bytes, BytesMut};
use reqwest::{Client, Url, header::RANGE};
use tokio::{runtime::Runtime, time::timeout};

use crate::{
    HttpAddress, HttpError, HttpSettings,
    answer::{self, Version},
    requests::ServerRequests,
};

/// The ranges of one file on a web server.
#[derive(Debug)]
pub(crate) struct Ranges {
    client: Client,
    runtime: Arc<Runtime>,
    settings: HttpSettings,
    pub(crate) address: HttpAddress,
    /// The target of redirections, so that each range takes one request. A target may be valid for
    /// minutes only.
    redirected: Mutex<Option<Url>>,
    /// Whether all tries of the last request failed. Until a request succeeds, each has only one
    /// try, since waiting did not help.
    is_down: AtomicBool,
    counter: Mutex<ServerRequests>,
}

/// A failed request, and the time that the server asks to wait.
struct Failed {
    error: HttpError,
    wait: Option<Duration>,
}

impl From<HttpError> for Failed {
    fn from(error: HttpError) -> Self {
        Self { error, wait: None }
    }
}

impl Ranges {
    pub(crate) fn new(
        client: Client,
        runtime: Arc<Runtime>,
        settings: HttpSettings,
        address: HttpAddress,
    ) -> Self {
        let (redirected, is_down) = (Mutex::default(), AtomicBool::new(false));
        let counter = Mutex::default();
        Self { client, runtime, settings, address, redirected, is_down, counter }
    }

    /// The traffic so far.
    pub(crate) fn requests(&self) -> MutexGuard<'_, ServerRequests> {
        self.counter.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the bytes of the file in `asked` up to its end, and their version, which must be
    /// `known` if that is given.
    pub(crate) fn get(
        &self,
        asked: &Range<u64>,
        known: Option<&Version>,
    ) -> Result<(Version, Bytes), HttpError> {
        let HttpSettings { retries, mut first_pause, longest_pause, .. } = self.settings;
        let pause = &mut first_pause;
        let mut tries = 0;
        loop {
            let redirected = self.redirected().clone();
            let url = redirected.as_ref().unwrap_or(&self.address.url);
            let got = self.runtime.block_on(self.in_time(url, asked, known));
            let Failed { error, wait } = match got {
                Ok(got) => {
                    self.is_down.store(false, Ordering::Relaxed);
                    return Ok(got);
                }
                Err(failed) => failed,
            };
            let is_denied = matches!(
                error,
                HttpError::Missing { .. } | HttpError::Refused { .. } | HttpError::Status { .. }
            );
            tries += 1;
            // The target of a redirection may have expired or be down, and the address itself may
            // lead elsewhere by now.
            if redirected.is_some() {
                *self.redirected() = None;
                if is_denied && tries <= retries.max(1) {
                    continue;
                }
            }
            let is_wrong_address = known.is_none() && error.is_before_connection();
            if !error.is_momentary() || is_wrong_address {
                return Err(error);
            }
            if tries > retries || self.is_down.load(Ordering::Relaxed) {
                self.is_down.store(true, Ordering::Relaxed);
                return Err(error.after(tries));
            }
            if let (Some(wait), HttpError::Busy { status, .. }) = (wait, &error)
                && wait > longest_pause
            {
                let status = status.clone();
                return Err(HttpError::ComeBack { status, seconds: wait.as_secs() });
            }
            thread::sleep(wait.unwrap_or_default().max(*pause));
            *pause *= 2;
        }
    }

    fn redirected(&self) -> MutexGuard<'_, Option<Url>> {
        self.redirected.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Does the same as `once`, with a time limit for slow servers.
    async fn in_time(
        &self,
        url: &Url,
        asked: &Range<u64>,
        known: Option<&Version>,
    ) -> Result<(Version, Bytes), Failed> {
        let limit = self.settings.longest(asked.end.saturating_sub(asked.start));
        timeout(limit, self.once(url, asked, known)).await.unwrap_or_else(|_| {
            let least = self.settings.least_bytes_per_second;
            Err(HttpError::TooSlow { within: limit, least }.into())
        })
    }

    async fn once(
        &self,
        url: &Url,
        asked: &Range<u64>,
        known: Option<&Version>,
    ) -> Result<(Version, Bytes), Failed> {
        let begun = Instant::now();
        let explain = |error: reqwest::Error| self.explain(error);
        let range = format!("bytes={}-{}", asked.start, asked.end.saturating_sub(1));
        self.requests().count += 1;
        let request = self.client.get(url.clone()).header(RANGE, range);
        let mut response = request.send().await.map_err(explain)?;
        let (version, range) = answer::check(response.status(), response.headers(), asked)
            .map_err(|error| Failed { error, wait: answer::retry_after(response.headers()) })?;
        // The check comes before the body: no more bytes of another version are read.
        known.map_or(Ok(()), |known| known.check_same(&version))?;
        let length = (range.end - range.start) as usize;
        if length == 0 {
            // The file has no bytes there. A server may send a text with this status.
            return Ok((version, Bytes::new()));
        }
        let said = response.content_length();
        let mut body = BytesMut::with_capacity(length);
        while body.len() < length {
            // The limit depends on the bytes received so far, not on those to come: a large answer
            // that drips ends as soon as a small one.
            let within = self.settings.longest(body.len() as u64);
            let least = self.settings.least_bytes_per_second;
            let left = within.saturating_sub(begun.elapsed());
            let chunk = timeout(left, response.chunk()).await;
            let chunk = chunk.map_err(|_| HttpError::TooSlow { within, least })?;
            let Some(chunk) = chunk.map_err(explain)? else { break };
            self.requests().received_bytes += chunk.len() as u64;
            body.extend_from_slice(&chunk);
        }
        // A body that is longer than expected is an error, whether or not its header says so.
        let is_more = match said {
            Some(said) => said > length as u64,
            None => response.chunk().await.map_err(explain)?.is_some_and(|more| !more.is_empty()),
        };
        let asked = range.end - range.start;
        if body.len() > length || is_more {
            return Err(HttpError::More { asked }.into());
        }
        if body.len() < length {
            return Err(HttpError::Short { asked, got: body.len() as u64, tries: 1 }.into());
        }
        // The library removes user name and password from the address that it reports.
        let came_from = self.with_credentials(response.url().clone());
        if came_from != *url {
            *self.redirected() = Some(came_from);
        }
        Ok((version, body.freeze()))
    }

    /// The target of a redirection, with user name and password if it is on the same server.
    fn with_credentials(&self, mut to: Url) -> Url {
        let own = &self.address.url;
        if to.origin() == own.origin() {
            // These calls fail only for addresses without a host.
            let _ = to.set_username(own.username());
            let _ = to.set_password(own.password());
        }
        to
    }

    /// Translates an error of the library.
    fn explain(&self, error: reqwest::Error) -> HttpError {
        // The address would show secrets.
        let error = error.without_url();
        let HttpSettings { connect_timeout, idle_timeout, .. } = self.settings;
        // The innermost cause says most.
        let reason = causes(&error).last().map(ToString::to_string).unwrap_or_default();
        if error.is_redirect() {
            let refused = find::<HttpError>(&error).cloned();
            return refused.unwrap_or(HttpError::BadRedirection { why: reason });
        }
        // For example a scheme other than HTTP in a redirection; our own addresses were checked.
        if error.is_builder() {
            return HttpError::BadRedirection { why: reason };
        }
        if error.is_timeout() {
            let within = if error.is_connect() { connect_timeout } else { idle_timeout };
            return HttpError::Timeout { within, tries: 1 };
        }
        if let Some(tls) = tls_error(&error) {
            return HttpError::Tls { reason: tls.to_string() };
        }
        if find::<hyper::Error>(&error).is_some_and(hyper::Error::is_parse) {
            return HttpError::NoHttp { reason };
        }
        if !error.is_connect() {
            return HttpError::BrokenOff { reason, tries: 1 };
        }
        let kinds = causes(&error).filter_map(|cause| cause.downcast_ref::<io::Error>());
        if kinds.map(io::Error::kind).any(|kind| kind == io::ErrorKind::ConnectionRefused) {
            return HttpError::NobodyListens;
        }
        // The library has no kind for this error.
        let is_of_name = causes(&error).any(|cause| cause.to_string().contains("dns error"));
        if is_of_name {
            HttpError::UnknownHost { reason }
        } else {
            HttpError::NoConnection { reason }
        }
    }
}

fn causes<'a>(error: &'a (dyn Error + 'static)) -> impl Iterator<Item = &'a (dyn Error + 'static)> {
    std::iter::successors(Some(error), |&error: &&'a (dyn Error + 'static)| error.source())
}

fn find<'a, T: Error + 'static>(error: &'a (dyn Error + 'static)) -> Option<&'a T> {
    causes(error).find_map(<dyn Error>::downcast_ref)
}

/// The error of TLS. It may be wrapped in I/O errors, which do not return what they wrap as their
/// source.
fn tls_error<'a>(error: &'a (dyn Error + 'static)) -> Option<&'a rustls::Error> {
    let wrapped = |cause: &'a (dyn Error + 'static)| -> Option<&'a (dyn Error + 'static)> {
        let inner = cause.downcast_ref::<io::Error>()?.get_ref()?;
        Some(inner)
    };
    causes(error).find_map(|cause| cause.downcast_ref().or_else(|| tls_error(wrapped(cause)?)))
}
