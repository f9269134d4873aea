//! A first line is whole, begun or not ours, wherever it is cut.

use super::*;

const MARK: &str = "corniche test ";

#[test]
fn a_line_is_ours_when_it_is_whole_and_nothing_when_it_is_cut() {
    let id = random_digits();
    assert!(is_id(&id), "{id}");
    assert_ne!(id, random_digits());
    let line = format!("{MARK}{id}\n");
    assert_eq!(marked(&line, MARK), Marked::Id(&id, ""));
    assert_eq!(marked(&format!("{line}more"), MARK), Marked::Id(&id, "more"));
    for end in 0..line.len() {
        assert_eq!(marked(&line[..end], MARK), Marked::Begun, "{:?}", &line[..end]);
    }
    let others = ["x", "\n", "corniche test \n", "corniche test 0123\n", "corniche test ../x"];
    for text in others {
        assert_eq!(marked(text, MARK), Marked::Other, "{text:?}");
    }
    // A text of the right length that is no id, whole or not.
    for text in ["0123456789abcdeg", "../../some/where"] {
        assert!(!is_id(text));
        assert_eq!(marked(&format!("{MARK}{text}"), MARK), Marked::Other, "{text:?}");
        assert_eq!(marked(&format!("{MARK}{text}\n"), MARK), Marked::Other, "{text:?}");
    }
}
