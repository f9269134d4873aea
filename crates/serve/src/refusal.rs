//! Answers that say, in words, why a file is not sent.

use hyper::{
    Response, StatusCode,
    header::{ALLOW, CONTENT_RANGE, CONTENT_TYPE, HeaderName, HeaderValue},
};

use crate::body::{Body, of_bytes};

/// The methods that are answered.
pub(crate) const METHODS: &str = "GET, HEAD, OPTIONS";

/// Why a file is not sent.
#[derive(Debug)]
pub(crate) enum Refusal {
    /// The request does not say which host it asks.
    NoHost,
    /// The request is meant for a host that is not this one.
    OtherHost,
    /// Nothing is served at the path.
    Unknown,
    /// The file on disk is gone.
    Gone {
        /// Its path in the table.
        path: String,
    },
    /// The file on disk cannot be read.
    Unreadable {
        /// Its path in the table.
        path: String,
        /// What the system says.
        reason: String,
    },
    /// The method changes things.
    Method,
    /// The client wants a version that is not there any more.
    Changed,
    /// The file has no such bytes.
    NoSuchBytes {
        /// How many bytes the file has.
        length_bytes: u64,
    },
}

impl Refusal {
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

    /// Words for whoever reads the answer. What the request said is not repeated.
    fn text(&self) -> String {
        match self {
            Self::NoHost => "The request has no Host header, which HTTP/1.1 requires.".to_owned(),
            Self::OtherHost => {
                "This server answers to numbers (127.0.0.1), to localhost and to the name that it was given with --address, and the \
                 request is for another name. Open the address that the server printed when it started."
                    .to_owned()
            }
            Self::Unknown => {
                "Nothing is served at this path. The page is at /, and the packages are listed in /packages.json.".to_owned()
            }
            Self::Gone { path } => format!(
                "{path} was there when the server started, and its file is gone now. Put it back, or start the server again with the \
                 files that are to be shown."
            ),
            Self::Unreadable { path, reason } => format!("The file of {path} cannot be read: {reason}."),
            Self::Method => format!("This server only reads files: {METHODS}."),
            Self::Changed => "The file has changed: it is not the version that was asked for. Load it again.".to_owned(),
            Self::NoSuchBytes { length_bytes } => {
                format!("The file has no such bytes: it has {length_bytes}.")
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
