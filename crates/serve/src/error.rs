//! Errors that keep packages from being served.

use std::{io, net::SocketAddr};

use thiserror::Error;

/// The reason why nothing can be served.
#[derive(Debug, Error)]
pub enum ServeError {
    /// The name or IP address to listen at does not belong to this machine.
    #[error(
        "{host} is not an address of this machine; use one such as 127.0.0.1, ::1 or 0.0.0.0 (all addresses)"
    )]
    NoAddress {
        /// The name as given.
        host: String,
        /// The system's error.
        source: io::Error,
    },
    /// Another program has the port.
    #[error(
        "port {port} of {host} is in use by another program; use another port, or 0 for a free one"
    )]
    InUse {
        /// The name as given.
        host: String,
        /// The port.
        port: u16,
    },
    /// The system does not allow this program to listen there.
    #[error("cannot listen at port {port} of {host}")]
    Listen {
        /// The name as given.
        host: String,
        /// The port.
        port: u16,
        /// The system's error.
        source: io::Error,
    },
    /// The threads of the server cannot be started.
    #[error("cannot start the server at {address}")]
    Start {
        /// The address for listening.
        address: SocketAddr,
        /// The system's error.
        source: io::Error,
    },
}
