//! Error answers, with the reason why a file is not sent.

use hyper::{
    Response, StatusCode,
    header::{ALLOW, CONTENT_RANGE, CONTENT_TYPE, HeaderName, HeaderValue},
};

use crate::body::{Body, of_bytes};

/// The supported methods.
pub(crate) const METHODS: &str = "GET, HEAD, OPTIONS";

/// The reason why a file is not sent.
#[derive(Debug)]
pub(crate) enum ServeRefusal {
    /// The request has no host.
    NoHost,
    /// The request is for another host.
    OtherHost,
    /// Nothing is served at the path.
    Unknown,
    /// The file on disk is missing.
    Gone {
        /// The path in the table.
        path: String,
    },
    /// The file on disk cannot be read.
    Unreadable {
        /// The path in the table.
        path: String,
        /// The system's error.
        reason: String,
    },
    /// The method changes things.
    Method,
    /// The client requests a version that no longer exists.
    Changed,
    /// The file has no such bytes.
    NoSuchBytes {
        /// The length of the file.
        length_bytes: u64,
    },
}

impl ServeRefusal {
    fn status(&self) -> StatusCode {
        match self {
            Self::NoHost => StatusCode::BAD_REQUEST,
            Self::OtherHost => StatusCode::FORBIDDEN,
            Self::Unknown | Self::Gone { .. } => StatusCode::NOT_FOUND,
            Self::Unreadable { .. } => StatusCode::INTERNAL_SERVER_ERROR,
            Self::Method => StatusCode::METHOD_NOT_ALLOWED,
            Self::Changed => StatusCode::PRECONDITION_FAILED,
            Self::NoSuchBytes { .. } => StatusCode::RANGE_NOT_SATISFIABLE,
        }
    }

    /// The text for readers of the answer. It never repeats parts of the request.
    fn text(&self) -> String {
        match self {
            Self::NoHost => "The request has no Host header, which HTTP/1.1 requires.".to_owned(),
            Self::OtherHost => {
                "This server responds to IP addresses (127.0.0.1), to localhost and to the name in --address, but the \
                 request is for another name. Open the address that the server printed when it started."
                    .to_owned()
            }
            Self::Unknown => {
                "Nothing is served at this path. The page is at /, and the packages are listed in /packages.json.".to_owned()
            }
            Self::Gone { path } => format!(
                "The file of {path} existed when the server started, but is missing now. Restore it, or restart the server with the \
                 files to serve."
            ),
            Self::Unreadable { path, reason } => format!("The file of {path} cannot be read: {reason}."),
            Self::Method => format!("The method is not supported. This server only reads files: {METHODS}."),
            Self::Changed => "The file has changed since the requested version. Load it again.".to_owned(),
            Self::NoSuchBytes { length_bytes } => {
                format!("The requested range is outside the file, which has {length_bytes} bytes.")
            }
        }
    }

    pub(crate) fn answer(&self) -> Response<Body> {
        let mut answer = Response::new(of_bytes(format!("{}\n", self.text())));
        *answer.status_mut() = self.status();
        let mut set =
            |name: HeaderName, value: HeaderValue| answer.headers_mut().insert(name, value);
        set(CONTENT_TYPE, HeaderValue::from_static("text/plain; charset=utf-8"));
        match self {
            Self::Method => {
                set(ALLOW, HeaderValue::from_static(METHODS));
            }
            Self::NoSuchBytes { length_bytes } => {
                if let Ok(range) = format!("bytes */{length_bytes}").parse() {
                    set(CONTENT_RANGE, range);
                }
            }
            _ => {}
        }
        answer
    }
}
