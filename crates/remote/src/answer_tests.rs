//! Answers of servers are accepted only if they have the requested range and version.

use reqwest::header::HeaderValue;

use super::*;

fn checked(
    status: u16,
    headers: &[(HeaderName, &'static str)],
    asked: Range<u64>,
) -> Result<(Version, Range<u64>), HttpError> {
    let pairs = headers.iter().map(|(name, value)| (name.clone(), HeaderValue::from_static(value)));
    check(StatusCode::from_u16(status).unwrap(), &pairs.collect(), &asked)
}

#[test]
fn a_range_is_taken_as_it_was_asked_for_and_no_other() {
    let range = |value| checked(206, &[(CONTENT_RANGE, value)], 100..200);
    assert_eq!(range("bytes 100-199/1000").unwrap().1, 100..200);
    // The end of the range is the end of the file.
    assert_eq!(range("bytes 100-149/150").unwrap().1, 100..150);
    for wrong in [
        "bytes 0-99/1000",
        "bytes 100-198/1000",
        "bytes 100-200/1000",
        "bytes 100-199/150",
        "bytes 100-18446744073709551615/1000",
        "bytes 199-100/1000",
        "bytes -100-199/1000",
        "bytes 100/1000",
        "100-199/1000",
        "",
    ] {
        let error = range(wrong).unwrap_err();
        assert!(matches!(&error, HttpError::OtherRange { got, .. } if got == wrong), "{error}");
    }
    assert!(matches!(checked(206, &[], 0..9), Err(HttpError::OtherRange { .. })));
    assert!(matches!(range("bytes 100-199/*"), Err(HttpError::NoLength { .. })));
}

#[test]
fn nothing_is_a_range_too() {
    let empty = checked(416, &[(CONTENT_RANGE, "bytes */0")], 0..100).unwrap();
    assert_eq!((empty.0.length, empty.1), (0, 0..0));
    for odd in ["bytes */1000", "bytes 0-1/0", "odd"] {
        let odd = checked(416, &[(CONTENT_RANGE, odd)], 0..100);
        assert!(matches!(odd, Err(HttpError::Status { .. })));
    }
}

#[test]
fn compression_is_told_before_what_follows_from_it() {
    for (status, encoding) in [(200, "gzip"), (206, "br")] {
        let headers = [(CONTENT_ENCODING, encoding), (CONTENT_RANGE, "bytes 0-9/10")];
        let error = checked(status, &headers, 0..10).unwrap_err();
        assert_eq!(error, HttpError::Encoded { encoding: encoding.to_owned() });
    }
    let headers = [(CONTENT_ENCODING, "Identity"), (CONTENT_RANGE, "bytes 0-9/10")];
    assert!(checked(206, &headers, 0..10).is_ok());
}

#[test]
fn a_version_is_told_by_etag_else_by_date_and_always_by_length() {
    let version = |headers: &[(HeaderName, &'static str)], range| {
        let headers = [headers, &[(CONTENT_RANGE, range)]].concat();
        checked(206, &headers, 0..10).unwrap().0
    };
    let long = "bytes 0-9/20";
    let is_same = |one: &Version, other: &Version| one.check_same(other).is_ok();
    let strong = version(&[(ETAG, "\"a\""), (LAST_MODIFIED, "Monday")], long);
    assert!(is_same(&strong, &version(&[(ETAG, "\"a\""), (LAST_MODIFIED, "Tuesday")], long)));
    assert!(!is_same(&strong, &version(&[(ETAG, "\"b\""), (LAST_MODIFIED, "Monday")], long)));
    assert!(!is_same(&strong, &version(&[], long)));
    assert!(!is_same(&strong, &version(&[(ETAG, "\"a\"")], "bytes 0-9/21")));
    let weak = version(&[(ETAG, "W/\"a\"")], long);
    assert!(is_same(&weak, &weak) && !is_same(&weak, &strong));
    let dated = version(&[(LAST_MODIFIED, "Monday")], long);
    assert!(is_same(&dated, &dated));
    assert!(!is_same(&dated, &version(&[(LAST_MODIFIED, "Tuesday")], long)));
    assert!(is_same(&version(&[], long), &version(&[], long)));
}

#[test]
fn seconds_to_wait_are_understood() {
    let wait = |value| {
        retry_after(&HeaderMap::from_iter([(RETRY_AFTER, HeaderValue::from_static(value))]))
    };
    assert_eq!(wait("3"), Some(Duration::from_secs(3)));
    assert_eq!(wait("Mon, 23 Nov 2026 10:00:00 GMT"), None);
    assert_eq!(retry_after(&HeaderMap::new()), None);
}
