//! Servers that misbehave, each in its own way: the error messages, and the numbers of requests.
#![allow(clippy::unwrap_used, reason = "tests may unwrap")]

use std::{
    net::TcpListener,
    time::{Duration, Instant},
};

use crate::support::{Mode, Server, settings, source};
use corniche_tileset::{BlockingSource as _, SourceError};

/// Some whole blocks and a part of one.
const BYTES: usize = 1_000_000;
const SECRET: &str = "do-not-tell-0123456789";

fn read(server: &Server) -> Result<Vec<u8>, SourceError> {
    source(&server.url()).read(0, 100)
}

/// The errors from a server that always answers like this, at the first request and at a later one,
/// with the number of requests each time.
fn told(mode: &Mode) -> [(String, usize); 2] {
    let server = Server::start(BYTES);
    server.always(mode.clone());
    let first = read(&server).unwrap_err();
    let first_count = server.take_log().len();
    server.always(Mode::Right);
    let source = source(&server.url());
    source.read(0, 100).unwrap();
    server.take_log();
    server.always(mode.clone());
    let later = source.read(500_000, 100).unwrap_err();
    for error in [&first, &later] {
        assert!(error.to_string().contains(&server.url()), "{error}");
    }
    [(first.to_string(), first_count), (later.to_string(), server.take_log().len())]
}

/// Each fault has its own message, without retries if they cannot help.
#[test]
fn each_kind_is_named() {
    let all = 1 + settings().retries as usize;
    let cases = [
        (Mode::Status(404, ""), "no such file (404 Not Found)", 1),
        (Mode::Status(410, ""), "no such file (410 Gone)", 1),
        (Mode::Status(403, ""), "denies access (403 Forbidden)", 1),
        (Mode::Status(401, ""), "denies access (401 Unauthorized)", 1),
        (Mode::Status(418, ""), "answers 418", 1),
        (Mode::Status(304, ""), "304 Not Modified, without a Location", 1),
        (
            Mode::Status(503, ""),
            "overloaded or failing (503 Service Unavailable), even after 4 tries",
            all,
        ),
        (Mode::Status(500, ""), "overloaded or failing (500", all),
        (Mode::Status(429, ""), "overloaded or failing (429", all),
        (Mode::Status(503, "Retry-After: 3600\r\n"), "retry in 3600 seconds", 1),
        (Mode::IgnoreRanges, "ignores range requests", 1),
        (Mode::Gzip(206), "compresses the package in transit (Content-Encoding: gzip)", 1),
        (Mode::Gzip(200), "compresses the package in transit (Content-Encoding: gzip)", 1),
        (Mode::ContentRange("bytes 7-106/1000000"), "other bytes than requested: bytes 7-106", 1),
        (Mode::ContentRange("bytes 0-9/*"), "does not report the length of the file", 1),
        (Mode::ContentRange("nonsense"), "other bytes than requested: nonsense", 1),
        (Mode::Fewer(10), "bytes instead of 65536, even after 4 tries", all),
        (Mode::More(10), "more than the 65536 requested bytes", 1),
        (Mode::MoreUnsaid, "more than the 65536 requested bytes", 1),
        (Mode::CutBody(1000), "keeps breaking (4 tries)", all),
        (Mode::Cut, "keeps breaking (4 tries)", all),
        (Mode::Silent, "does not answer within 0.3 seconds, even after 4 tries", all),
        (Mode::Stuck, "does not answer within 0.3 seconds, even after 4 tries", all),
        (Mode::Dripping, "less than 1048576 bytes per second", 1),
        (Mode::DrippingHead, "does not answer within 0.3 seconds, even after 4 tries", all),
        (Mode::Noise, "does not speak HTTP", 1),
    ];
    for (mode, said, count) in cases {
        for (told, asked) in told(&mode) {
            assert!(told.contains(said), "{mode:?}: {told}");
            assert_eq!(asked, count, "{mode:?}: {told}");
        }
    }
}

/// Failures of the network or the server have another exit code.
#[test]
fn what_may_pass_is_told_from_what_stays() {
    let may_pass = |mode: Mode| {
        let server = Server::start(BYTES);
        server.always(mode);
        read(&server).unwrap_err().may_pass
    };
    for mode in [Mode::Status(503, ""), Mode::Cut, Mode::Silent, Mode::Fewer(1)] {
        assert!(may_pass(mode.clone()), "{mode:?}");
    }
    for mode in [Mode::Status(404, ""), Mode::IgnoreRanges, Mode::Gzip(206), Mode::More(1)] {
        assert!(!may_pass(mode.clone()), "{mode:?}");
    }
}

#[test]
fn what_fails_for_a_moment_is_tried_again_and_comes_whole() {
    let server = Server::start(BYTES);
    let moments = [
        Mode::Status(503, ""),
        Mode::Status(429, "Retry-After: 0\r\n"),
        Mode::CutBody(1000),
        Mode::Cut,
        Mode::Fewer(10),
        Mode::Silent,
        Mode::Stuck,
    ];
    let file = server.state().bytes.clone();
    for mode in moments {
        let source = source(&server.url());
        server.next([mode.clone()]);
        assert_eq!(source.read(0, 100).unwrap(), file[..100], "{mode:?}");
        server.next([mode.clone(), mode.clone(), mode.clone()]);
        assert_eq!(source.read(300_000, 70_000).unwrap(), file[300_000..370_000], "{mode:?}");
        assert_eq!(source.requests().count, 6, "{mode:?}");
        assert_eq!(server.take_log().len(), 6);
    }
}

#[test]
fn a_server_that_asks_for_patience_gets_it() {
    let server = Server::start(BYTES);
    server.next([Mode::Status(503, "Retry-After: 1\r\n")]);
    let begun = Instant::now();
    read(&server).unwrap();
    assert!(begun.elapsed() >= Duration::from_secs(1));
}

#[test]
fn a_file_that_changes_is_never_mixed() {
    type Change = Box<dyn Fn(&Server)>;
    let length = |bytes: usize| move |server: &Server| server.state().bytes.truncate(bytes);
    let version = |version: &'static str| {
        move |server: &Server| version.clone_into(&mut server.state().version)
    };
    let changes: [(Change, &str); 6] = [
        (Box::new(version("ETag: \"two\"\r\n")), "its ETag was \"one\", now \"two\""),
        (Box::new(version("ETag: W/\"one\"\r\n")), "now W/\"one\""),
        (Box::new(version("")), "now none"),
        (Box::new(length(BYTES - 1)), "it had 1000000 bytes, now 999999"),
        (Box::new(length(400_000)), "it had 1000000 bytes, now 400000"),
        (Box::new(length(0)), "it had 1000000 bytes, now 0"),
    ];
    for (change, said) in changes {
        let server = Server::start(BYTES);
        let source = source(&server.url());
        source.read(0, 100).unwrap();
        change(&server);
        server.take_log();
        let error = source.read(500_000, 100).unwrap_err();
        let told = error.to_string();
        assert!(told.contains(said) && told.contains("run the same command again"), "{told}");
        assert!(error.may_pass);
        assert_eq!(server.take_log().len(), 1, "another try cannot help");
        // The cached bytes are still of the first version, and no bytes of another version arrive.
        assert!(source.read(0, 100).is_ok());
        assert!(source.read(900_000, 100).is_err());
        assert!(server.take_log().is_empty(), "it is known");
    }
    // Without an `ETag`, the date identifies the version.
    let server = Server::start(BYTES);
    server.state().version = "Last-Modified: Monday\r\n".to_owned();
    let source = source(&server.url());
    source.read(0, 100).unwrap();
    server.state().version = "Last-Modified: Tuesday\r\n".to_owned();
    let told = source.read(500_000, 100).unwrap_err().to_string();
    assert!(told.contains("its date was Monday, now Tuesday"), "{told}");
}

#[test]
fn redirections_are_followed_once_and_then_known() {
    let server = Server::start(BYTES);
    let other = Server::start(BYTES);
    server.always(Mode::Redirect(format!("{}?signature=1", other.url())));
    let source = source(&server.url());
    source.read(0, 100).unwrap();
    source.read(500_000, 100).unwrap();
    assert_eq!((server.take_log().len(), other.take_log().len()), (1, 2));
    // The target of the redirection was valid for a while only.
    other.next([Mode::Status(403, "")]);
    source.read(900_000, 100).unwrap();
    assert_eq!((server.take_log().len(), other.take_log().len()), (1, 2));
    // The target is permanently gone.
    other.always(Mode::Status(403, ""));
    let told = source.read(200_000, 100).unwrap_err().to_string();
    assert!(told.contains("denies access"), "{told}");
}

#[test]
fn redirections_that_lead_nowhere_are_named() {
    let server = Server::start(BYTES);
    let told = |to: String| {
        server.always(Mode::Redirect(to));
        let told = read(&server).unwrap_err().to_string();
        assert!(!told.contains(SECRET), "{told}");
        (told, server.take_log().len())
    };
    let (circle, count) = told(format!("{}?{SECRET}", server.url()));
    assert!(circle.contains("in a loop (to http://127.0.0.1:"), "{circle}");
    assert_eq!(count, 2);
    assert!(told("ftp://maps.example/x".to_owned()).0.contains("sends an invalid redirect"));
    // A loop of two addresses.
    let other = Server::start(BYTES);
    other.always(Mode::Redirect(server.url()));
    assert!(told(other.url()).0.contains("in a loop"));
    // Endless new addresses.
    server.next((0..20).map(|k| Mode::Redirect(format!("/place-{k}"))));
    let error = read(&server).unwrap_err().to_string();
    assert!(error.contains("more than 10 times"), "{error}");
}

#[test]
fn a_host_that_is_not_there_is_told_at_once() {
    let begun = Instant::now();
    let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let told = source(&format!("http://127.0.0.1:{port}/x")).length().unwrap_err();
    assert!(told.reason.contains("no server answers there") && told.may_pass, "{told}");
    let told = source("http://no-such-host.invalid/x").length().unwrap_err();
    assert!(told.reason.contains("host name cannot be resolved"), "{told}");
    assert!(begun.elapsed() < Duration::from_secs(10), "it is no matter of patience");
}

/// A server that goes away for a while in the middle of the work is waited for.
#[test]
fn a_server_that_goes_away_later_is_asked_again() {
    let server = Server::start(BYTES);
    let source = source(&server.url());
    source.read(0, 100).unwrap();
    server.next([Mode::Cut, Mode::Cut]);
    assert!(source.read(500_000, 100).is_ok());
}

/// A caller that reads a thousand tiles anyway does not wait a thousand times.
#[test]
fn a_server_that_stays_away_is_not_waited_for_again() {
    let server = Server::start(BYTES);
    let source = source(&server.url());
    source.read(0, 100).unwrap();
    server.take_log();
    server.always(Mode::Status(503, ""));
    let asked = || {
        assert!(source.read(500_000, 100).is_err());
        server.take_log().len()
    };
    assert_eq!([asked(), asked(), asked()], [4, 1, 1]);
    server.always(Mode::Right);
    source.read(500_000, 100).unwrap();
    server.take_log();
    server.next([Mode::Cut, Mode::Cut]);
    source.read(900_000, 100).unwrap();
}

#[test]
fn user_name_and_password_reach_their_server_alone_and_are_not_told() {
    let server = Server::start(BYTES);
    let url = |server: &Server| format!("http://me:{SECRET}@{}/x?key={SECRET}", server.host);
    let with_secret = source(&url(&server));
    with_secret.read(0, 100).unwrap();
    let asked = &server.take_log()[0];
    assert_eq!(asked.target, format!("/x?key={SECRET}"));
    assert!(asked.authorization.as_ref().unwrap().starts_with("Basic "));
    assert_eq!(asked.encoding, "identity");
    // To another address on the same server the credentials are sent along, even once it is known.
    server.next([Mode::Redirect("/elsewhere".to_owned())]);
    let redirected = source(&url(&server));
    redirected.read(0, 100).unwrap();
    redirected.read(500_000, 100).unwrap();
    let asked = server.take_log();
    assert_eq!(asked.len(), 3);
    assert!(asked.iter().all(|asked| asked.authorization.is_some()), "{asked:?}");
    // To another server they are not sent.
    let other = Server::start(BYTES);
    server.next([Mode::Redirect(other.url())]);
    let elsewhere = source(&url(&server));
    elsewhere.read(0, 100).unwrap();
    elsewhere.read(500_000, 100).unwrap();
    assert!(other.take_log().iter().all(|asked| asked.authorization.is_none()));
    for mode in [Mode::Status(404, ""), Mode::IgnoreRanges, Mode::Cut, Mode::Redirect(url(&server))]
    {
        server.always(mode);
        let error = source(&url(&server)).read(0, 100).unwrap_err();
        assert!(!format!("{error} {error:?}").contains(SECRET), "{error}");
    }
    assert!(!format!("{elsewhere:?}").contains(SECRET), "{elsewhere:?}");
}
