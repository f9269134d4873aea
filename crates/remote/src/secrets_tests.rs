//! No secret of an address is left in a text, and other texts stay as they are.

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
    ] {
        assert_eq!(without_secrets(text), text);
    }
}
