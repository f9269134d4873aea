//! Which part of a file a request asks for, and on which conditions (RFC 9110, *HTTP Semantics*, 2022, sections 13 and 14).

use std::ops::RangeInclusive;

use http_range_header::{RangeInvalid, RangeUnsatisfiableError, parse_range_header};
use hyper::{
    HeaderMap, Method,
    header::{HeaderName, IF_MATCH, IF_NONE_MATCH, IF_RANGE, RANGE},
};

/// What of a file is to be sent.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// All of it.
    Whole,
    /// These bytes.
    Part(RangeInclusive<u64>),
    /// Nothing: the client has this version.
    Unchanged,
    /// Nothing: the client wants another version.
    Changed,
    /// Nothing: it has no such bytes, or they are not said as they must be.
    NoSuchBytes,
}

impl Wanted {
    /// What is wanted of a file with so many bytes and this `ETag`, which is a strong one.
    ///
    /// Several ranges in one request are answered by the whole file, and dates as conditions are not known: no answer of ours has one.
    pub(crate) fn of(method: &Method, headers: &HeaderMap, length_bytes: u64, tag: &str) -> Self {
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
        // A range is for GET alone, and for the version that it was meant for.
        let is_of_this = text(IF_RANGE).is_none_or(|version| version == tag);
        let range = text(RANGE).filter(|_| *method == Method::GET && is_of_this);
        range.map_or(Self::Whole, |range| Self::of_range(range, length_bytes))
    }

    fn of_range(range: &str, length_bytes: u64) -> Self {
        let ranges = match parse_range_header(range) {
            Ok(ranges) => ranges,
            // Another unit than bytes is not looked at.
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

/// Whether a version that is only said to be much the same (`W/"…"`) is the same.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Weak {
    IsSame,
    Differs,
}

/// Whether a list of versions names this one. Our tags have no commas.
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
