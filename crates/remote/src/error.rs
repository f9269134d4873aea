//! Errors of reading from a web server, and whether they are temporary.

use std::time::Duration;

use corniche_tileset::SourceError;

/// The reason why a text that begins like an address cannot be used.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum AddressError {
    #[error(
        "packages are read from files and over http:// and https://, not over {scheme}://; pass an http:// or https:// address, or download the package to a file"
    )]
    Scheme { scheme: String },
    #[error(
        "{shown} is not a valid address: {reason}; write it like https://example.org/map.pmtiles"
    )]
    NoAddress { shown: String, reason: String },
    #[error("{shown}: omit the part after #, or write # as %23 if it is part of the name")]
    Fragment { shown: String },
}

/// The reason why a server did not send the bytes of a package. The message follows the address.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum HttpError {
    #[error("the server has no such file ({status}); check the address")]
    Missing { status: String },
    #[error(
        "the server denies access ({status}); check the address, and whether it needs a signature, \
         or a user name and a password (https://USER:PASSWORD@…)"
    )]
    Refused { status: String },
    #[error("the server answers {status}; check the address")]
    Status { status: String },
    #[error(
        "the server is overloaded or failing ({status}), even after {tries} tries; run the same \
         command later"
    )]
    Busy { status: String, tries: u32 },
    #[error("the server asks to retry in {seconds} seconds ({status}); run the same command then")]
    ComeBack { status: String, seconds: u64 },
    #[error(
        "the server ignores range requests and sends the whole file; download the package to a \
         file, or put it on a server that supports range requests"
    )]
    NoRanges,
    #[error(
        "the server compresses the package in transit (Content-Encoding: {encoding}), so that its \
         ranges are not those of the file; switch compression off for this file on the server, or \
         download the package to a file"
    )]
    Encoded { encoding: String },
    #[error(
        "the server sends other bytes than requested: {got} instead of {asked}; download the \
         package to a file, or report it to the server's operator"
    )]
    OtherRange { asked: String, got: String },
    #[error(
        "the server does not report the length of the file (Content-Range: {got}); download the \
         package to a file, or report it to the server's operator"
    )]
    NoLength { got: String },
    #[error(
        "the server sends {got} bytes instead of {asked}, even after {tries} tries; run the same \
         command later, or report it to the server's operator"
    )]
    Short { asked: u64, got: u64, tries: u32 },
    #[error(
        "the server sends more than the {asked} requested bytes; download the package to a file, \
         or report it to the server's operator"
    )]
    More { asked: u64 },
    #[error(
        "the package changed on the server while it was being read ({what}); run the same command \
         again"
    )]
    Changed { what: String },
    #[error(
        "the server redirects in a loop (to {to} again); correct the address, or report it to the \
         server's operator"
    )]
    Circle { to: String },
    #[error(
        "the server redirects more than {most} times; correct the address, or report it to the \
         server's operator"
    )]
    TooManyRedirections { most: usize },
    #[error(
        "the server redirects from https:// to {to}, which is not encrypted; pass that address yourself if you accept this"
    )]
    Unprotected { to: String },
    #[error("the server sends an invalid redirect ({why}); correct the address")]
    BadRedirection { why: String },
    #[error(
        "no server answers there (connection refused); check the host, the port, and whether the server is running"
    )]
    NobodyListens,
    #[error(
        "the host name cannot be resolved ({reason}); check the address, the network and proxies \
         (HTTPS_PROXY)"
    )]
    UnknownHost { reason: String },
    #[error(
        "the TLS connection failed: {reason}; check the address and the server's certificate \
         (SSL_CERT_FILE names further authorities to trust)"
    )]
    Tls { reason: String },
    #[error(
        "the connection failed: {reason}; check the address, the network and proxies (HTTPS_PROXY)"
    )]
    NoConnection { reason: String },
    #[error("the server does not answer within {} seconds, even after {tries} tries; run the same command later", .within.as_secs_f64())]
    Timeout { within: Duration, tries: u32 },
    #[error(
        "the server sends less than {least} bytes per second, so that an answer takes longer than \
         {:.1} seconds; run the same command later, or download the package to a file",
        .within.as_secs_f64()
    )]
    TooSlow { within: Duration, least: u64 },
    #[error("the connection keeps breaking ({tries} tries): {reason}; run the same command later")]
    BrokenOff { reason: String, tries: u32 },
    #[error(
        "the server does not speak HTTP ({reason}); check the address, and whether it begins with http:// or https://"
    )]
    NoHttp { reason: String },
    #[error("there are only {length} bytes")]
    Beyond { length: u64 },
    #[error("cannot send requests: {what}")]
    Setup { what: String },
}

impl HttpError {
    /// Whether address, server and package may all be correct, so that the same request may succeed
    /// later.
    #[must_use]
    pub fn may_pass(&self) -> bool {
        matches!(
            self,
            Self::Busy { .. }
                | Self::ComeBack { .. }
                | Self::Short { .. }
                | Self::Changed { .. }
                | Self::NobodyListens
                | Self::UnknownHost { .. }
                | Self::NoConnection { .. }
                | Self::Timeout { .. }
                | Self::TooSlow { .. }
                | Self::BrokenOff { .. }
        )
    }

    /// Whether an immediate retry is worthwhile.
    pub(crate) fn is_momentary(&self) -> bool {
        self.may_pass()
            && !matches!(self, Self::Changed { .. } | Self::ComeBack { .. } | Self::TooSlow { .. })
    }

    /// Whether the connection could not even be established. For the first request, the likeliest
    /// cause is a wrong address.
    pub(crate) fn is_before_connection(&self) -> bool {
        matches!(self, Self::NobodyListens | Self::UnknownHost { .. } | Self::NoConnection { .. })
    }

    /// The same error after this many tries.
    pub(crate) fn after(mut self, count: u32) -> Self {
        match &mut self {
            Self::Busy { tries, .. }
            | Self::Short { tries, .. }
            | Self::Timeout { tries, .. }
            | Self::BrokenOff { tries, .. } => *tries = count,
            _ => {}
        }
        self
    }

    /// Converts the error to an error of a source: of a read, or of opening if `length` is 0.
    pub(crate) fn of_source(&self, name: &str, offset: u64, length: usize) -> SourceError {
        SourceError {
            name: name.to_owned(),
            offset,
            length,
            reason: self.to_string(),
            may_pass: self.may_pass(),
        }
    }
}
