//! The client for web servers: its connections, its thread and its rule for redirections.

use std::{sync::Arc, time::Duration};

use corniche_tileset::{FilePackage, OpenError};
use reqwest::{
    Client, Url,
    header::{ACCEPT_ENCODING, HeaderMap, HeaderValue},
    redirect::{Attempt, Policy},
};
use tokio::runtime::{Builder, Runtime};

use crate::{
    HttpAddress, HttpError, HttpSettings, HttpSource, PackagePlace, address::shown, range::Ranges,
};

/// The largest number of redirections.
const MOST_REDIRECTIONS: usize = 10;

/// The client for web servers: connections, which are kept open for a while, and a thread that
/// waits for the network.
#[derive(Debug, Clone)]
pub struct Web {
    client: Client,
    runtime: Arc<Runtime>,
    settings: HttpSettings,
}

impl Web {
    /// Creates the client without any request. Proxies are taken from the environment
    /// (`HTTP_PROXY`, `HTTPS_PROXY`, `NO_PROXY`).
    ///
    /// # Errors
    /// [`HttpError::Setup`].
    pub fn new(settings: HttpSettings) -> Result<Self, HttpError> {
        // If a second client in this process has chosen another provider, it works as well: then
        // this call does nothing.
        let _ = rustls::crypto::ring::default_provider().install_default();
        let setup = |error: &dyn std::fmt::Display| HttpError::Setup { what: error.to_string() };
        let runtime = Builder::new_multi_thread()
            .worker_threads(1)
            .thread_name("web")
            .enable_all()
            .build()
            .map_err(|error| setup(&error))?;
        let mut headers = HeaderMap::new();
        // Compression is off, because ranges must be those of the file itself.
        headers.insert(ACCEPT_ENCODING, HeaderValue::from_static("identity"));
        let HttpSettings { connect_timeout, idle_timeout, .. } = settings;
        let client = Client::builder()
            .user_agent(concat!("corniche/", env!("CARGO_PKG_VERSION")))
            .default_headers(headers)
            .no_gzip()
            .no_brotli()
            .no_zstd()
            .no_deflate()
            .connect_timeout(connect_timeout)
            .read_timeout(idle_timeout)
            .pool_idle_timeout(Duration::from_secs(30))
            .redirect(Policy::custom(follow))
            .build()
            .map_err(|error| setup(&error))?;
        Ok(Self { client, runtime: Arc::new(runtime), settings })
    }

    /// Returns the bytes at an address, without any request to the server.
    #[must_use]
    pub fn source(&self, address: &HttpAddress) -> HttpSource {
        let Self { client, runtime, settings } = self.clone();
        HttpSource::new(Ranges::new(client, runtime, settings, address.clone()))
    }

    /// Opens the package at a place.
    ///
    /// # Errors
    /// The errors of [`FilePackage::open`].
    pub fn open(&self, place: &PackagePlace) -> Result<FilePackage, OpenError> {
        match place {
            PackagePlace::File(path) => FilePackage::open(path),
            PackagePlace::Address(address) => FilePackage::of_source(
                place.name(),
                place.file_name(),
                Arc::new(self.source(address)),
            ),
        }
    }
}

/// Decides whether a redirection is followed.
fn follow(attempt: Attempt<'_>) -> reqwest::redirect::Action {
    let to = attempt.url();
    let is_http = |url: &Url| url.scheme() == "http";
    let refusal = if attempt.previous().contains(to) {
        HttpError::Circle { to: shown(to) }
    } else if attempt.previous().len() > MOST_REDIRECTIONS {
        HttpError::TooManyRedirections { most: MOST_REDIRECTIONS }
    } else if is_http(to) && attempt.previous().last().is_some_and(|from| !is_http(from)) {
        HttpError::Unprotected { to: shown(to) }
    } else {
        return attempt.follow();
    };
    attempt.error(refusal)
}
