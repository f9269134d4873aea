//! The variable `BROWSER` is interpreted as by other programs, and a browser outlives the server.

use super::*;

const URL: &str = "http://127.0.0.1:8080/";

#[test]
fn commands_of_the_variable_are_read_as_other_programs_read_them() {
    let cases: [(&str, &[&[&str]]); 9] = [
        ("", &[]),
        (" : ", &[]),
        ("firefox", &[&["firefox", URL]]),
        ("firefox %s", &[&["firefox", URL]]),
        ("x --new-window", &[&["x", "--new-window", URL]]),
        ("x --app=%s --y", &[&["x", "--app=http://127.0.0.1:8080/", "--y"]]),
        ("a:b %s", &[&["a", URL], &["b", URL]]),
        ("a %s &", &[&["a", URL]]),
        ("a 100%%s", &[&["a", "100%s", URL]]),
    ];
    for (named, expected) in cases {
        assert_eq!(named_commands(named, URL, &|_| false), expected, "{named}");
    }
}

#[test]
fn a_program_whose_path_has_spaces_is_one_word() {
    let named = named_commands("/My Apps/browser:b c", URL, &|name| name.starts_with("/My Apps/"));
    assert_eq!(named, [vec!["/My Apps/browser", URL], vec!["b", "c", URL]]);
}

#[test]
#[cfg(unix)]
fn a_command_that_fails_or_is_not_there_is_no_browser() {
    let starts_words =
        |words: &[&str]| starts(&words.iter().map(ToString::to_string).collect::<Vec<_>>());
    assert!(!starts_words(&["/no/such/browser", URL]));
    assert!(!starts_words(&["false", URL]));
    assert!(starts_words(&["true", URL]));
    assert!(!starts(&[]));
}

/// Ctrl-C in a terminal is sent to the whole foreground process group.
#[test]
#[cfg(target_os = "linux")]
fn a_browser_is_in_a_group_of_its_own() {
    let place = tempfile::tempdir().unwrap();
    let told = place.path().join("told");
    // The fifth field is the id of the process group.
    let code =
        format!("read -r _ _ _ _ group _ < /proc/$$/stat; echo $$ $group > '{}'", told.display());
    assert!(starts(&["sh".to_owned(), "-c".to_owned(), code]));
    let told = std::fs::read_to_string(told).unwrap();
    let (process, group) = told.trim().split_once(' ').unwrap();
    assert_eq!(process, group);
}
