//! The host names to which the server responds.
//!
//! A web page may point its own domain name to 127.0.0.1 after it is loaded (DNS rebinding). A
//! browser then treats this server as the page's own, and lets the page read everything. Such a
//! request has the page's domain name in its `Host` header. IP addresses and `localhost` cannot be
//! such names.

use std::net::{IpAddr, SocketAddr};

use hyper::http::uri::Authority;

/// The accepted host names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Hosts {
    /// All names: the server is open to the network, where clients may use any name for it.
    Any,
    /// IP addresses, `localhost`, and the given name.
    Local {
        /// The name in lower case; it may also be an IP address.
        named: String,
    },
}

impl Hosts {
    /// The accepted names of a server that was told to listen at `named`, which was resolved to
    /// `bound`.
    pub(crate) fn from_names(named: &str, bound: SocketAddr) -> Self {
        if bound.ip().is_loopback() {
            Self::Local { named: named.to_lowercase() }
        } else {
            Self::Any
        }
    }

    /// Whether requests to this host, with or without a port, are accepted.
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
