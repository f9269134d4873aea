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
        // Whether a list of tags contains this one. Our tags have no commas.
        let names = |name: HeaderName, is_weak_same: bool| {
            let lists = headers.get_all(name).into_iter().filter_map(|list| list.to_str().ok());
            lists.flat_map(|list| list.split(',')).map(str::trim).any(|named| {
                let weak = named.strip_prefix("W/").filter(|_| is_weak_same);
                named == "*" || weak.unwrap_or(named) == tag
            })
        };
        if headers.contains_key(IF_MATCH) && !names(IF_MATCH, false) {
            return Self::Changed;
        }
        if names(IF_NONE_MATCH, true) {
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

#[cfg(test)]
#[path = "conditions_tests.rs"]
mod tests;
