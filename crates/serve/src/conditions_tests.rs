//! Ranges and conditions of requests are interpreted as in the standard.

use hyper::{HeaderMap, Method, header::HeaderName};

use super::RequestedRange;

const TAG: &str = "\"one\"";

fn wanted(method: &Method, headers: &[(&str, &str)], length_bytes: u64) -> RequestedRange {
    let headers: HeaderMap = headers
        .iter()
        .map(|(name, value)| (name.parse::<HeaderName>().unwrap(), value.parse().unwrap()))
        .collect();
    RequestedRange::from_request(method, &headers, length_bytes, TAG)
}

#[test]
fn ranges_are_those_of_the_standard() {
    use RequestedRange::{NoSuchBytes, Part, Whole};
    for (range, length, expected) in [
        ("bytes=0-0", 10, Part(0..=0)),
        ("bytes=2-5", 10, Part(2..=5)),
        ("bytes=2-", 10, Part(2..=9)),
        ("bytes=-3", 10, Part(7..=9)),
        ("bytes=-30", 10, Part(0..=9)),
        ("bytes=9-99", 10, Part(9..=9)),
        ("BYTES=2-5", 10, Part(2..=5)),
        ("bytes=0-18446744073709551615", 10, Part(0..=9)),
        ("bytes=10-", 10, NoSuchBytes),
        ("bytes=10-12", 10, NoSuchBytes),
        ("bytes=-0", 10, NoSuchBytes),
        ("bytes=0-0", 0, NoSuchBytes),
        ("bytes=5-2", 10, NoSuchBytes),
        ("bytes=a-b", 10, NoSuchBytes),
        ("bytes=", 10, NoSuchBytes),
        ("bytes=1-2,4-5", 10, Whole),
        ("lines=1-2", 10, Whole),
    ] {
        assert_eq!(
            wanted(&Method::GET, &[("range", range)], length),
            expected,
            "{range} of {length}"
        );
    }
    assert_eq!(wanted(&Method::HEAD, &[("range", "bytes=2-5")], 10), Whole);
    assert_eq!(wanted(&Method::GET, &[], 10), Whole);
}

#[test]
fn conditions_hold_for_one_version() {
    use RequestedRange::{Changed, Part, Unchanged, Whole};
    let range = ("range", "bytes=2-5");
    for (condition, expected) in [
        (("if-range", TAG), Part(2..=5)),
        (("if-range", "\"two\""), Whole),
        // A weak tag is not sufficient for a range.
        (("if-range", "W/\"one\""), Whole),
        (("if-range", "Sun, 22 Nov 2026 10:00:00 GMT"), Whole),
        (("if-none-match", TAG), Unchanged),
        (("if-none-match", "\"two\", W/\"one\""), Unchanged),
        (("if-none-match", "*"), Unchanged),
        (("if-none-match", "\"two\""), Part(2..=5)),
        (("if-match", TAG), Part(2..=5)),
        (("if-match", "\"two\",\"one\""), Part(2..=5)),
        (("if-match", "*"), Part(2..=5)),
        (("if-match", "\"two\""), Changed),
        (("if-match", "W/\"one\""), Changed),
    ] {
        assert_eq!(wanted(&Method::GET, &[range, condition], 10), expected, "{condition:?}");
    }
}
