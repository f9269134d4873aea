//! The names under which the server is asked.
//!
//! A page from elsewhere may make its own name lead to 127.0.0.1 once it is loaded (DNS rebinding); a browser then takes this server for
//! the page's own, and lets the page read all of it. Such a request says the page's name in `Host`. An address of numbers, and
//! `localhost`, cannot be such a name.

use std::net::{IpAddr, SocketAddr};

use hyper::http::uri::Authority;

/// The names that are answered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Hosts {
    /// All: the server is open to the network, where it may be asked by any name.
    Any,
    /// Addresses of numbers, `localhost`, and the one that was named.
    Local {
        /// The name in lower case; a number, too, if that was given.
        named: String,
    },
}

impl Hosts {
    /// The names of a server that was told to listen at `named`, which turned out to be `bound`.
    pub(crate) fn of(named: &str, bound: SocketAddr) -> Self {
        if bound.ip().is_loopback() {
            Self::Local { named: named.to_lowercase() }
        } else {
            Self::Any
        }
    }

    /// Whether a request to this host, with or without a port, is answered.
    pub(crate) fn allow(&self, host: &str) -> bool {
        let Self::Local { named } = self else { return true };
        let Ok(authority) = host.parse::<Authority>() else { return false };
        let host = authority.host().to_lowercase();
        let number =
            host.strip_prefix('[').and_then(|host| host.strip_suffix(']')).unwrap_or(&host);
        host == "localhost" || host == *named || number.parse::<IpAddr>().is_ok()
    }
}

#[cfg(test)]
#[path = "host_tests.rs"]
mod tests;
