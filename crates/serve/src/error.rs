//! Errors that keep packages from being served.

use std::{io, net::SocketAddr};

use thiserror::Error;

/// Why nothing can be served.
#[derive(Debug, Error)]
pub enum ServeError {
    /// The name or number of the place to listen at means nothing here.
    #[error(
        "there is no address {host}; give one of this machine, such as 127.0.0.1, ::1 or 0.0.0.0 (all of them)"
    )]
    NoAddress {
        /// The name as it was given.
        host: String,
        /// What the system says.
        source: io::Error,
    },
    /// Another program has the port.
    #[error(
        "port {port} of {host} is in use by another program; give another one, or 0 for one that is free"
    )]
    InUse {
        /// The name as it was given.
        host: String,
        /// The port.
        port: u16,
    },
    /// The system does not let this program listen there.
    #[error("cannot listen at port {port} of {host}")]
    Listen {
        /// The name as it was given.
        host: String,
        /// The port.
        port: u16,
        /// What the system says.
        source: io::Error,
    },
    /// The threads of the server cannot be started.
    #[error("cannot start to serve at {address}")]
    Start {
        /// The address at which it should have listened.
        address: SocketAddr,
        /// What the system says.
        source: io::Error,
    },
}
