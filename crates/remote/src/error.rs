//! Errors of reading from a web server, and which of them may pass.

use std::time::Duration;

use corniche_tileset::SourceError;

/// Why a text that begins like an address is none that can be read.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum AddressError {
    #[error(
        "packages are read from files and by http:// and https://, not by {scheme}://; give an address that begins so, or fetch the \
         package to a file"
    )]
    Scheme { scheme: String },
    #[error("{shown} is no address: {reason}; write it like https://example.org/map.pmtiles")]
    NoAddress { shown: String, reason: String },
    #[error("{shown}: leave out what follows #, or write it as %23 if it is part of the name")]
    Fragment { shown: String },
}

/// Why a server did not give the bytes of a package. The message goes on after the address.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum HttpError {
    #[error("the server has no such file ({status}); check the address")]
    Missing { status: String },
    #[error(
        "the server refuses access ({status}); check the address, and whether it needs a signature, or a user name and a password \
         (https://USER:PASSWORD@…)"
    )]
    Refused { status: String },
    #[error("the server answers {status}; check the address")]
    Status { status: String },
    #[error(
        "the server is too busy or broken ({status}), also after {tries} tries; run the same command later"
    )]
    Busy { status: String, tries: u32 },
    #[error(
        "the server asks to come back in {seconds} seconds ({status}); run the same command then"
    )]
    ComeBack { status: String, seconds: u64 },
    #[error(
        "the server ignores which bytes are asked for: it sends the whole file, because it knows no range requests; fetch the \
         package to a file, or put it on a server that knows them"
    )]
    NoRanges,
    #[error(
        "the server compresses the package on its way (Content-Encoding: {encoding}), so that its ranges are not those of the file; \
         switch compression off for this file on the server, or fetch the package to a file"
    )]
    Encoded { encoding: String },
    #[error(
        "the server sends other bytes than asked for: {got} in place of {asked}; fetch the package to a file, or tell who runs the \
         server"
    )]
    OtherRange { asked: String, got: String },
    #[error(
        "the server does not tell how long the file is (Content-Range: {got}); fetch the package to a file, or tell who runs the \
         server"
    )]
    NoLength { got: String },
    #[error(
        "the server sends {got} bytes of {asked}, also after {tries} tries; run the same command later, or tell who runs the server"
    )]
    Short { asked: u64, got: u64, tries: u32 },
    #[error(
        "the server sends more than the {asked} bytes that were asked for; fetch the package to a file, or tell who runs the server"
    )]
    More { asked: u64 },
    #[error(
        "the package changed on the server while it was read ({what}); run the same command again"
    )]
    Changed { what: String },
    #[error(
        "the server redirects in a circle (to {to} again); correct the address, or tell who runs the server"
    )]
    Circle { to: String },
    #[error(
        "the server redirects more than {most} times; correct the address, or tell who runs the server"
    )]
    TooManyRedirections { most: usize },
    #[error(
        "the server redirects from https:// to {to}, which nothing protects; give that address yourself if that is fine"
    )]
    Unprotected { to: String },
    #[error("the server redirects to nowhere that can be read ({why}); correct the address")]
    BadRedirection { why: String },
    #[error(
        "nobody listens there (connection refused); check host and port, and that the server runs"
    )]
    NobodyListens,
    #[error(
        "no host of this name is known ({reason}); check the address, the network and proxies (HTTPS_PROXY)"
    )]
    UnknownHost { reason: String },
    #[error(
        "no protected connection comes about: {reason}; check the address and the server's certificate (SSL_CERT_FILE names further \
         authorities to trust)"
    )]
    Tls { reason: String },
    #[error(
        "no connection comes about: {reason}; check the address, the network and proxies (HTTPS_PROXY)"
    )]
    NoConnection { reason: String },
    #[error("the server does not answer within {} seconds, also after {tries} tries; run the same command later", .within.as_secs_f64())]
    Timeout { within: Duration, tries: u32 },
    #[error(
        "the server is slower than {least} bytes a second, so that an answer takes longer than {:.1} seconds; run the same command later, or \
         fetch the package to a file",
        .within.as_secs_f64()
    )]
    TooSlow { within: Duration, least: u64 },
    #[error(
        "the connection breaks off again and again ({tries} tries): {reason}; run the same command later"
    )]
    BrokenOff { reason: String, tries: u32 },
    #[error(
        "what answers there speaks no HTTP ({reason}); check the address, and whether it begins with http:// or https://"
    )]
    NoHttp { reason: String },
    #[error("there are only {length} bytes")]
    Beyond { length: u64 },
    #[error("requests cannot be made: {what}")]
    Setup { what: String },
}

impl HttpError {
    /// Whether nothing is known to be wrong with address, server or package: the same may succeed later.
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

    /// Whether it is worth while to try again at once.
    pub(crate) fn is_momentary(&self) -> bool {
        self.may_pass()
            && !matches!(self, Self::Changed { .. } | Self::ComeBack { .. } | Self::TooSlow { .. })
    }

    /// Whether there was not even a connection. At the first request that is most likely a wrong address.
    pub(crate) fn is_before_connection(&self) -> bool {
        matches!(self, Self::NobodyListens | Self::UnknownHost { .. } | Self::NoConnection { .. })
    }

    /// The same after so many tries.
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

    /// The error as one of a source: of a read, or of opening where `length` is 0.
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
