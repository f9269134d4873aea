//! Range requests and conditional requests (RFC 9110, *HTTP Semantics*, 2022, sections 13 and
//! 14).

use std::ops::RangeInclusive;

use http_range_header::{RangeInvalid, RangeUnsatisfiableError, parse_range_header};
use hyper::{
    HeaderMap, Method,
    header::{HeaderName, IF_MATCH, IF_NONE_MATCH, IF_RANGE, RANGE},
};

/// The part of a file to send.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum RequestedRange {
    /// The whole file.
    Whole,
    /// These bytes.
    Part(RangeInclusive<u64>),
    /// Nothing: the client already has this version.
    Unchanged,
    /// Nothing: the client requests another version.
    Changed,
    /// Nothing: the file has no such bytes, or the range is invalid.
    NoSuchBytes,
}

impl RequestedRange {
    /// The part of a file of this length and this `ETag`, which must be a strong one, that a
    /// request asks for.
    ///
    /// A request for several ranges is answered with the whole file. Conditions with dates are
    /// ignored, because our answers have no dates.
    pub(crate) fn from_request(
        method: &Method,
        headers: &HeaderMap,
        length_bytes: u64,
        tag: &str,
    ) -> Self {
        let text = |name: HeaderName| headers.get(name)?.to_str().ok();
        if headers.contains_key(IF_MATCH)
            && !headers
                .get_all(IF_MATCH)
                .iter()
                .any(|list| names(list.to_str().ok(), tag, Weak::Differs))
        {
            return Self::Changed;
        }
        if headers
            .get_all(IF_NONE_MATCH)
            .iter()
            .any(|list| names(list.to_str().ok(), tag, Weak::IsSame))
        {
            return Self::Unchanged;
        }
        // A range applies only to GET, and only to the version that the client expects.
        let is_of_this = text(IF_RANGE).is_none_or(|version| version == tag);
        let range = text(RANGE).filter(|_| *method == Method::GET && is_of_this);
        range.map_or(Self::Whole, |range| Self::of_range(range, length_bytes))
    }

    fn of_range(range: &str, length_bytes: u64) -> Self {
        let ranges = match parse_range_header(range) {
            Ok(ranges) => ranges,
            // Other units than bytes are ignored.
            Err(RangeUnsatisfiableError::Invalid(RangeInvalid::DoesNotStartWithToken)) => {
                return Self::Whole;
            }
            Err(_) => return Self::NoSuchBytes,
        };
        match ranges.validate(length_bytes) {
            Ok(valid) if valid.len() == 1 => Self::Part(valid[0].clone()),
            Ok(_) => Self::Whole,
            Err(_) => Self::NoSuchBytes,
        }
    }
}

/// Whether a weak tag (`W/"…"`) matches.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Weak {
    IsSame,
    Differs,
}

/// Whether a list of tags contains this one. Our tags have no commas.
fn names(list: Option<&str>, tag: &str, weak: Weak) -> bool {
    list.unwrap_or_default().split(',').map(str::trim).any(|named| {
        named == "*"
            || named == tag
            || (weak == Weak::IsSame && named.strip_prefix("W/").is_some_and(|named| named == tag))
    })
}

#[cfg(test)]
#[path = "conditions_tests.rs"]
mod tests;
