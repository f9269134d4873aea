//! The text of a failure: its causes, each once, and those after advice in brackets.

use super::*;

#[test]
fn causes_after_advice_are_in_brackets() {
    for (words, wanted) in [
        (["cannot open a", "no answer", "refused"], "cannot open a: no answer: refused"),
        (["a is corrupt; get it", "bad block", "short"], "a is corrupt; get it (bad block: short)"),
        (
            ["cannot open a", "it is corrupt; get it", "bad"],
            "cannot open a: it is corrupt; get it (bad)",
        ),
        (["cannot open a: refused", "refused", "refused"], "cannot open a: refused"),
    ] {
        let [error, cause, last] = words;
        let error = anyhow::anyhow!(last).context(cause).context(error);
        assert_eq!(CommandFailure::new(ExitCode::Failed, error).to_string(), wanted);
    }
}

#[test]
fn a_package_that_cannot_be_opened_is_named_once() {
    let source = SourceError {
        name: "a.pmtiles".to_owned(),
        offset: 0,
        length: 0,
        reason: "no such file".to_owned(),
        may_pass: false,
    };
    let error = OpenError::File { path: "a.pmtiles".into(), source: Box::new(source.into()) };
    let said = CommandFailure::from(error).to_string();
    assert_eq!(said, "cannot open \"a.pmtiles\": no such file");
}
