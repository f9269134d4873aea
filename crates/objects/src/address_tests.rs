//! Addresses of objects are distinguished from file names, and invalid ones are rejected.

use super::*;

fn parsed(text: &str) -> Option<(String, String)> {
    ObjectAddress::parse(text).unwrap().map(|address| (address.bucket, address.key))
}

#[test]
fn addresses_are_told_from_names_of_files() {
    for (text, bucket, key) in [
        ("s3://maps/utah/build", "maps", "utah/build"),
        ("s3://maps/utah/build/", "maps", "utah/build"),
        ("s3://maps", "maps", ""),
        ("s3://my.bucket-1/a b/ö.pmtiles", "my.bucket-1", "a b/ö.pmtiles"),
    ] {
        assert_eq!(parsed(text), Some((bucket.to_owned(), key.to_owned())), "{text}");
    }
    for text in ["work", "/data/build", "./s3://maps", "S3:/maps", "https://example.org/x"] {
        assert_eq!(parsed(text), None, "{text}");
    }
}

#[test]
fn what_begins_as_an_address_and_is_none_is_refused() {
    for text in [
        "s3://",
        "s3:///build",
        "s3://maps//build",
        "s3://maps/../build",
        "s3://maps/a?b",
        "s3://maps/a#b",
        "s3://key:secret@maps/build",
    ] {
        let error = ObjectAddress::parse(text).unwrap_err().to_string();
        assert!(error.contains("s3://BUCKET/NAME"), "{error}");
    }
}

#[test]
fn an_address_is_written_as_it_is_read() {
    for text in ["s3://maps", "s3://maps/utah", "s3://maps/utah/build.pmtiles"] {
        assert_eq!(ObjectAddress::parse(text).unwrap().unwrap().to_string(), text);
    }
}
