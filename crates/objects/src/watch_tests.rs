//! The message of a server's answer is found and shortened.

use super::*;

#[test]
fn the_words_of_an_answer_are_found_and_kept_short() {
    let xml = "<?xml version=\"1.0\"?><Error><Code>SlowDown</Code>\n<Message>Please reduce\n  your request rate.</Message></Error>";
    assert_eq!(element(xml, "Code"), "SlowDown");
    assert_eq!(element(xml, "Message"), "Please reduce your request rate.");
    for odd in ["", "<Code>", "</Code><Code>", "<html>502</html>"] {
        assert_eq!(element(odd, "Code"), "", "{odd}");
    }
    let long = format!("<Message>{}</Message>", "ö".repeat(5000));
    assert_eq!(element(&long, "Message").chars().count(), 200);
}

#[test]
fn ranges_end_where_objects_can() {
    let is = |text: &str| is_possible(&HeaderValue::from_str(text).unwrap());
    assert!(is("bytes 0-47/100") && is("bytes */100") && is("what is this"));
    assert!(!is("bytes 0-18446744073709551615/5"));
}
