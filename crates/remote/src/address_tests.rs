//! Addresses on web servers are distinguished from file names, and secrets are not shown.

use super::*;

#[test]
fn addresses_are_told_from_names_of_files() {
    for (text, shown, name) in [
        ("http://maps.example/a/li.pmtiles", "http://maps.example/a/li.pmtiles", "li.pmtiles"),
        (
            "HTTPS://Maps.Example:8443/li.pmtiles",
            "https://maps.example:8443/li.pmtiles",
            "li.pmtiles",
        ),
        ("http://127.0.0.1:8000", "http://127.0.0.1:8000/", "http://127.0.0.1:8000/"),
        ("https://maps.example/a b/", "https://maps.example/a%20b/", "a%20b"),
        ("http://[::1]/x", "http://[::1]/x", "x"),
    ] {
        let address = HttpAddress::parse(text).unwrap().unwrap();
        assert_eq!((address.to_string().as_str(), address.file_name()), (shown, name));
    }
    for text in ["li.pmtiles", "/a/b", "./http://x", "1://x", "C:/maps/x", "http:/x", "a b://x"] {
        assert_eq!(HttpAddress::parse(text).unwrap(), None, "{text}");
    }
}

#[test]
fn what_begins_as_an_address_and_cannot_be_read_is_refused() {
    for (text, said) in [
        ("s3://maps/li.pmtiles", "not over s3://"),
        ("ftp://maps.example/li.pmtiles", "not over ftp://"),
        ("http://", "empty host"),
        ("http://maps.example:port/x", "invalid port"),
        ("https://maps.example/x#part", "%23"),
    ] {
        let error = HttpAddress::parse(text).unwrap_err().to_string();
        assert!(error.contains(said), "{text}: {error}");
    }
}

/// Messages, lists and images show the address.
#[test]
fn secrets_are_not_shown() {
    for text in [
        "https://me:tell-nobody@maps.example/li.pmtiles?signature=tell-nobody",
        "https://tell-nobody@maps.example/li.pmtiles",
    ] {
        let address = HttpAddress::parse(text).unwrap().unwrap();
        for shown in [address.to_string(), format!("{address:?}"), address.file_name().to_owned()] {
            assert!(!shown.contains("tell-nobody") && !shown.contains('@'), "{shown}");
            assert!(shown.contains("li.pmtiles"), "{shown}");
        }
        assert!(address.url.as_str().contains("tell-nobody"), "the server is told");
    }
    let refused = [
        "https://me:tell-nobody@maps.example:x/li.pmtiles",
        "https://me:tell-nobody@maps.example/x?tell-nobody#tell-nobody",
        "s3://me:tell-nobody@maps/x",
    ];
    for text in refused {
        let error = HttpAddress::parse(text).unwrap_err();
        assert!(!format!("{error} {error:?}").contains("tell-nobody"), "{error}");
    }
}
