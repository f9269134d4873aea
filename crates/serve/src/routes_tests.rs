//! Only the paths in the table are found, and tags distinguish contents.

use bytes::Bytes;

use super::{FileContent, Readers, Routes};

fn found<'a>(routes: &'a Routes, path: &str) -> Option<&'a str> {
    routes.find(path).map(|(path, _)| path)
}

/// A path is a key in the table: no other spelling leads to another file.
#[test]
fn only_what_is_in_the_table_is_found() {
    let mut routes = Routes::default();
    for path in
        ["index.html", "examples/index.html", "examples/fly.html", "packages/Zürich 1%.pmtiles"]
    {
        routes.add(path, FileContent::Memory(Bytes::from_static(b"x")), Readers::AnyPage);
    }
    for (asked, path) in [
        ("/", "index.html"),
        ("/index.html", "index.html"),
        ("/examples/", "examples/index.html"),
        ("/examples/fly.html", "examples/fly.html"),
        ("/examples%2Ffly.html", "examples/fly.html"),
        ("/packages/Z%C3%BCrich%201%25.pmtiles", "packages/Zürich 1%.pmtiles"),
    ] {
        assert_eq!(found(&routes, asked), Some(path), "{asked}");
    }
    for asked in [
        "",
        "*",
        "index.html",
        "//index.html",
        "/INDEX.HTML",
        "/examples",
        "/packages/",
        "/./index.html",
        "/examples/../index.html",
        "/../../etc/passwd",
        "/%2e%2e/%2e%2e/etc/passwd",
        "/..%2findex.html",
        "/..\\index.html",
        "/index.html%00",
        "/%ff",
        "/packages/Z%C3%BCrich%201%.pmtile",
    ] {
        assert_eq!(found(&routes, asked), None, "{asked}");
    }
}

#[test]
fn tags_tell_contents_apart_and_a_later_file_replaces_an_earlier_one() {
    let mut routes = Routes::default();
    let tag = |routes: &Routes| routes.find("/a").unwrap().1.tag_in_memory.clone();
    routes.add("a", FileContent::Memory(Bytes::from_static(b"one")), Readers::AnyPage);
    let one = tag(&routes);
    routes.add("a", FileContent::Memory(Bytes::from_static(b"two")), Readers::AnyPage);
    assert_ne!(tag(&routes), one);
    routes.add("a", FileContent::Memory(Bytes::from_static(b"one")), Readers::OwnPages);
    assert_eq!(tag(&routes), one);
    assert!(one.len() == 34 && one.starts_with('"') && one.ends_with('"'), "{one}");
}
