//! No secret of an address is left in a text, and other texts are unchanged.

use super::*;

#[test]
fn user_names_passwords_and_signatures_are_hidden() {
    for (text, shown) in [
        ("redirecting to 'http://me:tell-nobody@h/x'", "redirecting to 'http://…@h/x'"),
        ("http:/me:tell-nobody@h/x: no such file", "http:/…@h/x: no such file"),
        ("\"  http://me:tell-nobody@h/x\"", "\"  http://…@h/x\""),
        ("http//me:tell-nobody@h", "http//…@h"),
        (
            "pooling idle connection for (\"http\", me:tell-nobody@h:80)",
            "pooling idle connection for (\"http\", …@h:80)",
        ),
        ("me:tell-nobody@h/x: no such file", "…@h/x: no such file"),
        ("http:me:tell-nobody@h", "http:…@h"),
        ("http:\\\\me:tell-nobody@h", "http:\\\\…@h"),
        ("/vsicurl/HTTPS://me:tell-nobody@h/x", "/vsicurl/HTTPS://…@h/x"),
        ("https://tell-nobody@h", "https://…@h"),
        ("http://me:tell@nobody@h:80/a@b", "http://…@h:80/a@b"),
        ("http://me:tell/nobody@h/x", "http://…@h/x"),
        ("https://h/x?tell-nobody#a and https://h?tell-nobody", "https://h/x?… and https://h?…"),
        (r#"{"a":"see \"http://h?tell-nobody\""}"#, r#"{"a":"see \"http://h?…\""}"#),
        ("[\"ftp://a:tell-nobody@h\", \"s3://tell:nobody@b\"]", "[\"ftp://…@h\", \"s3://…@b\"]"),
        ("http://me:tell'nobody@h/x", "http://…@h/x"),
        ("argument 'http://me:tell nobody@h/x' found", "argument 'http://…@h/x' found"),
        ("http://me:tell\"no<bo>dy`@h and a@b", "http://…@h and a@b"),
        ("http://me:tell/no body@h/x", "http://…@h/x"),
        (
            "cannot read http://me:12 nobody@h/x: no such file",
            "cannot read http://…@h/x: no such file",
        ),
        ("http://me:12 34 56@h", "http://…@h"),
        ("http://a.b:12 34@h/x", "http://…@h/x"),
        ("http://a.b:12 34@h.org", "http://…@h.org"),
        ("http://a.b:12 nobody@h.org/x", "http://…@h.org/x"),
        ("http://a.b:12 nobody@h.org:80", "http://…@h.org:80"),
        ("http://a.b:12 nobody@h", "http://…@h"),
        ("value 'http://a.b:12 nobody@h.org' for", "value 'http://…@h.org' for"),
        ("http://me:tell no@body@h/x", "http://…@h/x"),
        ("http://me:tell:/nobody@h/x", "http://…@h/x"),
        ("http://me:tell://nobody@h/x", "http://…@h/x"),
        (r#"{"a":"http://me:tell\"nobody@h/x","b":"c@d"}"#, r#"{"a":"http://…@h/x","b":"c@d"}"#),
        ("https://a/x,https://me:tell-nobody@b/y", "https://a/x,https://…@b/y"),
        ("https://a:80,https://me:tell-nobody@b/y", "https://a:80,https://…@b/y"),
        ("https://a/http://me:tell'nobody@h?x", "https://a/http://…@h?…"),
        ("http://me:tell-nobody@a/http://b:c@d/e", "http://…@a/http://…@d/e"),
        ("https://a/x?tell,http://me:nobody@b/y", "https://a/x?…"),
        ("http/me:tell-nobody@h", "http/…@h"),
        ("user01:2345@example.org and me:tell@[::1]", "…@example.org and …@[::1]"),
    ] {
        assert_eq!(without_secrets(text), shown);
        assert_eq!(without_secrets(shown), shown, "it changes again");
    }
}

#[test]
fn other_texts_stay_as_they_are() {
    for text in [
        "",
        "wrote C:\\maps\\me@home\\x.pmtiles",
        "serves http://127.0.0.1:8000/ and http://[::1]:80/a@b",
        "is it at https://h/x?",
        "me@h, at 12:30 @ noon, C: @a, / and : and ?a=b",
        "https://h:x/y: no port",
        "http://h.org:80 <me@h.org> and http://h.org:80 (or 'me@h.org')",
        "http://127.0.0.1:8000 me@h.org, http://h.org:80 me@h.org and http://localhost:80 me@h.org",
        "http://minio:9000 does not answer; if it should, write to me@h.org",
        "/srv/http/me@site/x.pmtiles and http/me@site/x.pmtiles",
        "2026-01-01T12:30@home.gpx, 12:30:05.5Z@home.gpx and walk_9:30@home.gpx",
        "mailto:me@h.org",
        "ubuntu:22.04@sha256:1c9e2a and ubuntu:22.04@sha256:12345678",
        "http://h: ask me@h.org",
        "(http://h:80), ask me@h.org",
        r#"{"a":"http://h:x","b":"me@h.org"}"#,
        "http://h:x\nme@h.org",
        "https://proxy/https://h/a@b",
    ] {
        assert_eq!(without_secrets(text), text);
    }
}
