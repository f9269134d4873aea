//! Scripts in a page get the hashes that browsers compute, and Base64 matches the examples of RFC
//! 4648.

use super::*;

#[test]
fn bytes_become_the_texts_of_the_rfc() {
    for (bytes, text) in [
        ("", ""),
        ("f", "Zg=="),
        ("fo", "Zm8="),
        ("foo", "Zm9v"),
        ("foob", "Zm9vYg=="),
        ("fooba", "Zm9vYmE="),
        ("foobar", "Zm9vYmFy"),
    ] {
        assert_eq!(base64(bytes.as_bytes()), text);
    }
}

/// The hash is that of the example in CSP Level 3, section 8.4 (`alert('Hello, world.');`).
#[test]
fn scripts_in_a_page_may_run_and_no_others() {
    let page =
        b"<script type=module src=\"a.js\"></script><p><script>alert('Hello, world.');</script>";
    let policy = policy(page);
    let scripts = "script-src 'self' 'wasm-unsafe-eval' 'sha256-qznLcsROx4GACP2dm0UCKCzCG+HiZ1guq6ZZDob/Tng=';";
    assert!(policy.contains(scripts), "{policy}");
    // A package of another server may have its still image there.
    assert!(policy.contains("img-src * data: blob:;"), "{policy}");
    assert!(!policy.contains("frame-ancestors"), "{policy}");
    assert_eq!(own_scripts("<script>a\r\nb\rc</script>"), ["a\nb\nc"]);
    assert_eq!(own_scripts("<script>never ends"), [""; 0]);
}
