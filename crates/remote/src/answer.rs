//! The head of an HTTP answer, before its body is read.

use std::{ops::Range, time::Duration};

use reqwest::{
    StatusCode,
    header::{
        CONTENT_ENCODING, CONTENT_RANGE, ETAG, HeaderMap, HeaderName, LAST_MODIFIED, RETRY_AFTER,
    },
};

use crate::HttpError;

/// The version of the file in an answer, which must be the same in all answers.
///
/// A weak `ETag` is compared like a strong one: it changes at the latest with a significant change
/// of the content. It is not sent to the server, which must not use it for ranges (RFC 9110,
/// section 13.1.5).
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Version {
    pub(crate) length: u64,
    etag: Option<String>,
    /// The modification date; only used if there is no `ETag`.
    modified: Option<String>,
}

impl Version {
    fn from_headers(headers: &HeaderMap, length: u64) -> Self {
        let etag = text(headers, &ETAG);
        let modified = if etag.is_none() { text(headers, &LAST_MODIFIED) } else { None };
        Self { length, etag, modified }
    }

    /// Fails if the version `now` differs from this one.
    pub(crate) fn check_same(&self, now: &Self) -> Result<(), HttpError> {
        let told = |value: &Option<String>| value.clone().unwrap_or_else(|| "none".to_owned());
        let what = if self.length != now.length {
            format!("it had {} bytes, now {}", self.length, now.length)
        } else if self.etag != now.etag {
            format!("its ETag was {}, now {}", told(&self.etag), told(&now.etag))
        } else if self.modified != now.modified {
            format!("its date was {}, now {}", told(&self.modified), told(&now.modified))
        } else {
            return Ok(());
        };
        Err(HttpError::Changed { what })
    }
}

/// Checks the head of an answer to a range request. Returns the version of the file, and the range
/// of the file that the body contains.
///
/// `asked` may end beyond the file.
pub(crate) fn check(
    status: StatusCode,
    headers: &HeaderMap,
    asked: &Range<u64>,
) -> Result<(Version, Range<u64>), HttpError> {
    let told = || {
        let reason = status.canonical_reason().unwrap_or_default();
        format!("{} {reason}", status.as_u16()).trim_end().to_owned()
    };
    // This check comes first, because compression explains other oddities.
    if status.is_success()
        && let Some(encoding) = text(headers, &CONTENT_ENCODING)
        && !encoding.eq_ignore_ascii_case("identity")
    {
        return Err(HttpError::Encoded { encoding });
    }
    match status.as_u16() {
        206 => {}
        200 => return Err(HttpError::NoRanges),
        404 | 410 => return Err(HttpError::Missing { status: told() }),
        401 | 403 | 407 => return Err(HttpError::Refused { status: told() }),
        408 | 425 | 429 | 500 | 502..=504 => {
            return Err(HttpError::Busy { status: told(), tries: 1 });
        }
        // The file has no bytes in this range: it is empty, or has become shorter.
        416 => {
            let length = text(headers, &CONTENT_RANGE)
                .and_then(|range| range.strip_prefix("bytes */")?.parse().ok());
            let Some(length) = length.filter(|&length| length <= asked.start) else {
                return Err(HttpError::Status { status: told() });
            };
            return Ok((Version::from_headers(headers, length), asked.start..asked.start));
        }
        300..=399 => {
            let why = format!("{}, without a Location", told());
            return Err(HttpError::BadRedirection { why });
        }
        _ => return Err(HttpError::Status { status: told() }),
    }
    let said = text(headers, &CONTENT_RANGE).unwrap_or_else(|| "no Content-Range".to_owned());
    let asked_text = || format!("bytes {}-{}", asked.start, asked.end.saturating_sub(1));
    let other = || HttpError::OtherRange { asked: asked_text(), got: said.clone() };
    let (range, length) =
        said.strip_prefix("bytes ").and_then(|rest| rest.split_once('/')).ok_or_else(other)?;
    if length == "*" {
        return Err(HttpError::NoLength { got: said });
    }
    let (first, last) = range.split_once('-').ok_or_else(other)?;
    let number = |text: &str| text.trim().parse::<u64>().map_err(|_| other());
    let (first, last, length) = (number(first)?, number(last)?, number(length)?);
    let end = asked.end.min(length);
    if first != asked.start || last.checked_add(1) != Some(end) {
        return Err(other());
    }
    Ok((Version::from_headers(headers, length), first..end))
}

/// The time that a server asks to wait (`Retry-After`). Dates are not supported; then the default
/// pause applies.
pub(crate) fn retry_after(headers: &HeaderMap) -> Option<Duration> {
    text(headers, &RETRY_AFTER)?.trim().parse().ok().map(Duration::from_secs)
}

fn text(headers: &HeaderMap, name: &HeaderName) -> Option<String> {
    /// A longer text would fill a message.
    const LONGEST: usize = 200;
    let value = headers.get(name)?;
    let text = String::from_utf8_lossy(value.as_bytes());
    Some(text.chars().take(LONGEST).collect())
}

#[cfg(test)]
#[path = "answer_tests.rs"]
mod tests;
