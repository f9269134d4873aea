//! Browsers can open the address that `serve` prints.

use super::{counted, url};

#[test]
fn the_address_is_one_that_a_browser_opens() {
    for (named, bound, expected) in [
        ("127.0.0.1", "127.0.0.1:80", "http://127.0.0.1:80/"),
        ("::1", "[::1]:8080", "http://[::1]:8080/"),
        ("[::1]", "[::1]:8080", "http://[::1]:8080/"),
        ("localhost", "127.0.0.1:8080", "http://localhost:8080/"),
        ("0.0.0.0", "0.0.0.0:8080", "http://127.0.0.1:8080/"),
        ("::", "[::]:8080", "http://[::1]:8080/"),
    ] {
        assert_eq!(url(named, bound.parse().unwrap()), expected, "{named}");
    }
    assert_eq!([1, 2].map(|count| counted(count, "file")), ["1 file", "2 files"]);
}
