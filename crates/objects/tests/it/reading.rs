//! Objects are read by ranges, whatever the server does in between, and errors are reported.
#![allow(clippy::unwrap_used, reason = "tests may unwrap")]

use std::io::{Read as _, Seek as _, SeekFrom};

use crate::support::{
    RETRIES, SECRET, bucket,
    server::{Fault, Server, first},
    settings, storage, told,
};
use corniche_objects::{ObjectError, ObjectReader, Storage};
use corniche_testing::Random;

fn content(bytes: usize) -> Vec<u8> {
    let mut random = Random::new(7);
    (0..bytes).map(|_| random.bits() as u8).collect()
}

#[test]
fn objects_are_listed_found_and_read_by_ranges() {
    let server = Server::start();
    let bucket = bucket(&server);
    let bytes = content(100_000);
    server.put("utah/a", bytes.clone());
    server.put("utah/b/c", "deep");
    let (found, folders) = bucket.list("utah").unwrap();
    assert_eq!(folders, ["utah/b"]);
    assert_eq!(found.len(), 1);
    assert_eq!((found[0].key.as_str(), found[0].length), ("utah/a", 100_000));
    let etag = found[0].etag.as_deref();
    assert_eq!(bucket.find("utah/a").unwrap().as_ref(), Some(&found[0]));
    assert_eq!(bucket.find("utah/x").unwrap(), None);
    assert_eq!(bucket.get("utah/b/c").unwrap().as_deref(), Some(&b"deep"[..]));
    assert_eq!(bucket.get("utah/x").unwrap(), None);
    for range in [0..1, 500..700, 99_999..100_000, 0..100_000, 5..5] {
        let read = bucket.read("utah/a", etag, range.clone()).unwrap();
        assert_eq!(read, bytes[range.start as usize..range.end as usize]);
    }
    assert_eq!(
        server.take_log().iter().filter(|line| line.starts_with("GET maps/utah/a")).count(),
        4
    );
}

/// A request that fails temporarily is not noticed.
#[test]
fn what_fails_for_a_moment_is_tried_again() {
    let bytes = content(300_000);
    for (what, fault) in [
        ("503", Fault::Error(503, "SlowDown", "Please reduce your request rate.")),
        ("500", Fault::Error(500, "InternalError", "We encountered an internal error.")),
        ("429", Fault::Error(429, "TooManyRequests", "Slow down.")),
        ("cut before the answer", Fault::Cut),
        ("cut in the answer", Fault::CutBody(70_000)),
        ("fewer bytes than asked for", Fault::Short),
    ] {
        let server = Server::start();
        server.put("a", bytes.clone());
        let bucket = bucket(&server);
        let etag = bucket.find("a").unwrap().unwrap().etag;
        server.break_with(first(2, fault, |request| request.method == "GET"));
        let read = bucket.read("a", etag.as_deref(), 1000..299_000);
        assert_eq!(read.unwrap(), bytes[1000..299_000], "{what}");
        let gets = server.take_log().iter().filter(|line| line.starts_with("GET")).count();
        assert!(gets >= 3, "{what}: {gets} requests");
    }
}

#[test]
fn a_server_that_asks_for_patience_for_ever_ends_in_an_error_that_says_so() {
    let server = Server::start();
    server.put("a", "content");
    let bucket = bucket(&server);
    server.break_with(|_| Some(Fault::Error(503, "SlowDown", "Please reduce your request rate.")));
    let error = bucket.read("a", None, 0..7).unwrap_err();
    let message = told(&error);
    assert!(matches!(error, ObjectError::Failed { .. }) && !error.is_unusable(), "{message}");
    for part in ["cannot read s3://maps/a", "SlowDown", "run the same command again"] {
        assert!(message.contains(part), "{message}");
    }
    assert_eq!(server.take_log().len(), RETRIES + 1);
    server.break_with(|_| Some(Fault::Cut));
    let message = told(&bucket.list("").unwrap_err());
    assert!(message.contains("cannot list s3://maps"), "{message}");
    assert_eq!(server.take_log().len(), RETRIES + 1);
}

/// A retry cannot help here, so there is none.
#[test]
fn a_refusal_is_told_at_once_with_what_to_do() {
    for (status, code, advice) in [
        (403, "SignatureDoesNotMatch", "AWS_SECRET_ACCESS_KEY"),
        (403, "InvalidAccessKeyId", "AWS_ACCESS_KEY_ID"),
        (403, "AccessDenied", "their permissions"),
        (400, "ExpiredToken", "AWS_SESSION_TOKEN"),
        (400, "AuthorizationHeaderMalformed", "AWS_REGION"),
        (501, "NotImplemented", "lacks a required feature"),
    ] {
        let server = Server::start();
        server.put("a", "content");
        let bucket = bucket(&server);
        server.break_with(move |_| Some(Fault::Error(status, code, "The words of the server.")));
        for error in [
            bucket.read("a", None, 0..7).map(drop).unwrap_err(),
            bucket.get("a").map(drop).unwrap_err(),
            bucket.list("").map(drop).unwrap_err(),
            bucket.create("a", vec![1]).map(drop).unwrap_err(),
        ] {
            let message = told(&error);
            assert!(error.is_unusable(), "{message}");
            for part in ["s3://maps", code, "The words of the server.", advice] {
                assert!(message.contains(part), "{part}: {message}");
            }
        }
        // The answer to this request has no text.
        let message = told(&bucket.find("a").unwrap_err());
        assert!(message.contains(&status.to_string()), "{message}");
        assert_eq!(server.take_log().len(), 5, "{code}");
    }
}

#[test]
fn a_bucket_that_is_elsewhere_or_nowhere_is_told() {
    let server = Server::start();
    let other = storage(&server).bucket("mops").unwrap();
    for error in [
        other.list("utah").map(drop).unwrap_err(),
        other.get("utah/store").map(drop).unwrap_err(),
        other.create("utah/store", vec![1]).map(drop).unwrap_err(),
    ] {
        let message = told(&error);
        assert!(matches!(error, ObjectError::NoBucket { .. }), "{message}");
        assert!(message.contains("s3://mops/utah") && message.contains("\"mops\""), "{message}");
    }
    server.break_with(|_| Some(Fault::Redirect));
    let message = told(&bucket(&server).get("a").unwrap_err());
    assert!(message.contains("eu-west-9") && message.contains("AWS_REGION"), "{message}");
}

#[test]
fn a_server_that_ignores_ranges_is_refused() {
    let server = Server::start();
    server.put("a", content(50_000));
    server.break_with(|_| Some(Fault::Ignore("range")));
    let error = bucket(&server).read("a", None, 10..20).unwrap_err();
    assert!(matches!(error, ObjectError::NoRanges { .. }), "{}", told(&error));
    assert_eq!(server.take_log().len(), 1);
}

#[test]
fn an_object_that_changes_is_noticed_even_where_the_server_does_not_know_conditions() {
    let server = Server::start();
    server.put("a", content(50_000));
    let bucket = bucket(&server);
    let etag = bucket.find("a").unwrap().unwrap().etag;
    server.put("a", content(50_000));
    let read = || bucket.read("a", etag.as_deref(), 10..20).unwrap_err();
    let error = read();
    assert!(matches!(error, ObjectError::Changed { .. }), "{}", told(&error));
    server.break_with(|_| Some(Fault::Ignore("if-match")));
    let error = read();
    assert!(matches!(error, ObjectError::Changed { .. }), "{}", told(&error));
    assert!(told(&error).contains("s3://maps/a changed"), "{}", told(&error));
}

#[test]
fn an_answer_that_is_always_too_short_is_an_error() {
    let server = Server::start();
    server.put("a", content(5000));
    server.break_with(|_| Some(Fault::Short));
    let error = bucket(&server).read("a", None, 0..5000).unwrap_err();
    assert!(
        matches!(error, ObjectError::Short { got: 4999, wanted: 5000, .. }),
        "{}",
        told(&error)
    );
}

#[test]
fn a_reader_reads_what_a_file_would_hold() {
    let server = Server::start();
    let bytes = content(9_000_001);
    server.put("extract", bytes.clone());
    let open = |etag: Option<&str>| ObjectReader::open(bucket(&server), "extract", etag);
    let mut reader = open(None).unwrap();
    let mut all = Vec::new();
    reader.read_to_end(&mut all).unwrap();
    assert!(all == bytes);
    // One request of 4 MiB, and one for the length.
    assert_eq!(server.take_log().len(), 4);
    let mut random = Random::new(3);
    for _ in 0..50 {
        let from = random.below(9_000_000) as u64;
        let length = 1 + random.below((9_000_001 - from).min(3000) as i64) as usize;
        let back = from as i64 - 9_000_001;
        let at =
            reader.seek(if back % 2 == 0 { SeekFrom::Start(from) } else { SeekFrom::End(back) });
        assert_eq!(at.unwrap(), from);
        let mut piece = vec![0; length];
        reader.read_exact(&mut piece).unwrap();
        assert!(piece == bytes[from as usize..][..length]);
    }
    assert_eq!(reader.seek(SeekFrom::Start(10_000_000)).unwrap(), 10_000_000);
    assert_eq!(reader.read(&mut [0; 10]).unwrap(), 0);
    assert!(reader.seek(SeekFrom::Current(-10_000_001)).is_err());
    // The object has changed before this reader has read anything.
    let mut reader = open(None).unwrap();
    server.put("extract", bytes);
    reader.seek(SeekFrom::Start(5_000_000)).unwrap();
    let error = reader.read_exact(&mut [0; 10]).unwrap_err();
    assert!(error.to_string().contains("s3://maps/extract changed"), "{error}");
    let error = open(Some("\"00000001\"")).unwrap_err();
    assert!(matches!(error, ObjectError::Changed { .. }), "{}", told(&error));
}

#[test]
fn settings_that_make_no_sense_are_told_without_secrets() {
    let server = Server::start();
    let with = |name: &str, value: &str| {
        let mut settings = settings(&server);
        settings.variables.push((name.to_owned(), value.to_owned()));
        Storage::new(settings).unwrap().bucket("maps").map(drop)
    };
    let endpoint = format!("http://user:{SECRET}@127.0.0.1:1");
    for (name, value) in [
        ("AWS_ENDPOINT_URL", endpoint.as_str()),
        ("AWS_ENDPOINT_URL", "127.0.0.1:9000"),
        ("AWS_SKIP_SIGNATURE", "perhaps"),
    ] {
        let error = with(name, value).unwrap_err();
        assert!(matches!(error, ObjectError::Settings { .. }), "{}", told(&error));
    }
    assert!(with("AWS_PROFILE", "other").is_ok(), "a variable that only others know");
}

/// A cloud machine provides credentials; nothing listens at this address.
#[test]
fn without_credentials_the_variables_that_hold_them_are_named() {
    let server = Server::start();
    let mut settings = settings(&server);
    settings.variables.retain(|(name, _)| !name.contains("KEY"));
    let nobody = "http://169.254.0.1:9".to_owned();
    settings.variables.push(("AWS_METADATA_ENDPOINT".to_owned(), nobody));
    let bucket = Storage::new(settings.clone()).unwrap().bucket("maps").unwrap();
    let error = bucket.get("a").unwrap_err();
    let message = told(&error);
    assert!(matches!(error, ObjectError::NoCredentials { .. }), "{message}");
    assert!(message.contains("s3://maps/a") && message.contains("AWS_ACCESS_KEY_ID"), "{message}");
    assert_eq!(server.take_log(), [""; 0], "nothing is asked without credentials");
    // A public bucket needs no credentials.
    server.put("a", "content");
    settings.variables.push(("AWS_SKIP_SIGNATURE".to_owned(), "true".to_owned()));
    let bucket = Storage::new(settings).unwrap().bucket("maps").unwrap();
    assert_eq!(bucket.get("a").unwrap().as_deref(), Some(&b"content"[..]));
}

/// A page of a list: keys, and the token of the next page.
fn page(keys: impl Iterator<Item = usize>, token: Option<usize>) -> String {
    let entry = |key| {
        format!(
            "<Contents><Key>store/{key}</Key><LastModified>2026-11-22T10:00:00Z</LastModified><ETag>&quot;1&quot;</ETag><Size>1</Size></Contents>"
        )
    };
    let next = token.map_or_else(
        || "<IsTruncated>false</IsTruncated>".to_owned(),
        |token| format!("<IsTruncated>true</IsTruncated><NextContinuationToken>{token}</NextContinuationToken>"),
    );
    format!("<ListBucketResult>{next}{}</ListBucketResult>", keys.map(entry).collect::<String>())
}

/// Names and tags that no request can contain end in an error, or are ignored.
#[test]
fn answers_that_no_request_can_be_made_with_are_refused() {
    let server = Server::start();
    let bucket = bucket(&server);
    let long = "x".repeat(70_000);
    let sound = page(1..2, None);
    for (part, other, said) in [
        ("<Key>store/1", format!("<Key>store/{long}"), "the name of an object"),
        (
            "<IsTruncated>false</IsTruncated>",
            format!(
                "<IsTruncated>true</IsTruncated><NextContinuationToken>{long}</NextContinuationToken>"
            ),
            "the name of a page",
        ),
    ] {
        let says = sound.replace(part, &other);
        server.break_with(move |_| Some(Fault::Says(says.clone())));
        let told = told(&bucket.list("store").unwrap_err());
        assert!(told.contains("sends an invalid answer") && told.contains(said), "{told}");
    }
    for tag in ["a&#13;&#10;b", "a&#127;"] {
        let says = sound.replace("&quot;1&quot;", tag);
        server.break_with(move |_| Some(Fault::Says(says.clone())));
        assert_eq!(bucket.list("store").unwrap().0[0].etag, None);
    }
}

/// A list of many pages is read to its end; an endless list ends in an error, and so does an answer
/// of gigabytes.
#[test]
fn lists_that_do_not_end_are_given_up() {
    let server = Server::start();
    let bucket = bucket(&server);
    let pages = |page_of: fn(usize) -> String| {
        let mut number = 0;
        server.break_with(move |_| {
            number += 1;
            Some(Fault::Says(page_of(number - 1)))
        });
    };
    pages(|n| page(100 * n..100 * (n + 1), (n < 9).then_some(n)));
    assert_eq!(bucket.list("store").unwrap().0.len(), 1000);
    let endless: [fn(usize) -> String; 5] = [
        // The cases are: one token, with new names and without; new tokens with the same names,
        // with none, and with new ones.
        |n| page(100 * n..100 * (n + 1), Some(7)),
        |_| page(0..3, Some(7)),
        |n| page(0..3, Some(n)),
        |n| page(0..0, Some(n)),
        |n| page(1000 * n..1000 * (n + 1), Some(n)),
    ];
    for page_of in endless {
        pages(page_of);
        server.take_log();
        let told = told(&bucket.list("store").unwrap_err());
        assert!(told.contains("does not end"), "{told}");
        assert!(server.take_log().len() <= 102);
    }
    for is_claimed in [true, false] {
        server.break_with(move |_| Some(Fault::Zeros { bytes: 3 << 30, is_claimed }));
        let listed = told(&bucket.list("store").unwrap_err());
        assert!(listed.contains("sends more than"), "{listed}");
        let got = told(&bucket.get("store").unwrap_err());
        // An object whose length is unknown is not read at all.
        assert!(
            got.contains(if is_claimed { "sends more than" } else { "Content-Length" }),
            "{got}"
        );
    }
}
