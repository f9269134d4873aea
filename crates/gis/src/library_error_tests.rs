//! The error gives advice if GDAL and PROJ do not.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use super::*;

#[test]
fn tables_of_another_proj_are_told_with_the_variable_that_names_them() {
    let said = "proj_create_from_database: /usr/share/proj/proj.db contains DATABASE.LAYOUT.VERSION.MINOR = 2 whereas a number >= 6 is expected.";
    let with = |set: &'static [&str]| {
        let variable = move |name: &str| set.contains(&name).then(|| "/usr/share/proj".to_owned());
        with_advice(said.to_owned(), variable)
    };
    assert_eq!(with(&[]), said);
    for (set, named) in [(&["PROJ_LIB"][..], "PROJ_LIB"), (&["PROJ_LIB", "PROJ_DATA"], "PROJ_DATA")]
    {
        let told = with(set);
        let words = format!("; {named} is set to \"/usr/share/proj\": unset it");
        assert!(told.starts_with(said) && told.contains(&words), "{told}");
    }
}

#[test]
fn a_server_without_an_answer_is_told_with_what_names_certificates() {
    let with = |code: u16| {
        with_advice(format!("HTTP response code on https://localhost/a.tif: {code}"), |_| None)
    };
    assert!(with(0).contains("certificate is not trusted (set SSL_CERT_FILE"), "{}", with(0));
    assert!(with(404).ends_with(": 404"), "{}", with(404));
    // The reason of curl, if GDAL reports it first.
    forget();
    hear(CplErrType::Failure, "CURL error: certificate verification failed");
    hear(CplErrType::Failure, "HTTP response code on https://localhost/a.tif: 0");
    let said = last_words().unwrap();
    assert!(said.starts_with("CURL error: certificate verification failed; the server"), "{said}");
    hear(CplErrType::Failure, "HTTP response code on https://localhost/a.tif: 404");
    assert!(last_words().unwrap().ends_with(": 404"));
    forget();
}
