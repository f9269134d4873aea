//! Titles: which language is shown, and which texts are rejected.

use super::*;

fn by_language(titles: &[(&str, &str)]) -> Titles {
    let owned = titles.iter().map(|&(language, title)| (language.to_owned(), title.to_owned()));
    Titles::ByLanguage(owned.collect())
}

#[test]
fn the_first_language_with_a_title_is_shown() {
    let titles = by_language(&[("de", "Bahnen"), ("en", "Railways"), ("fr", "Voies")]);
    assert_eq!(titles.title(&["fr", "de"]), Some("Voies"));
    assert_eq!(titles.title(&["it", "de"]), Some("Bahnen"));
    assert_eq!(titles.title(&["de-CH"]), Some("Bahnen"));
    assert_eq!(titles.title(&["it"]), Some("Railways"));
    assert_eq!(by_language(&[("sl", "Železnice")]).title(&["it"]), Some("Železnice"));
    assert_eq!(Titles::English("Railways".to_owned()).title(&["de"]), Some("Railways"));
    assert_eq!(Titles::Missing.title(&["de"]), None);
}

#[test]
fn texts_that_cannot_be_shown_are_rejected() {
    let long = "x".repeat(81);
    let unseen =
        ["\n", "\u{7}", "\u{ad}", "\u{200b}", "\u{2028}", "\u{202e}", "\u{2066}", "\u{feff}"];
    let unseen = unseen.map(|one| format!("a{one}b"));
    let texts = ["", " a", "\u{200d}", &long].into_iter().chain(unseen.iter().map(String::as_str));
    for title in texts {
        let error = Titles::English(title.to_owned()).check().unwrap_err();
        assert!(error.contains("is not a title"), "{error}");
        assert_eq!(by_language(&[("en", title)]).check(), Err(error));
    }
    for language in ["", "e", "EN", "e n", "en-", "en_GB", "deutsch-oesterreichisch"] {
        let error = by_language(&[(language, "a")]).check().unwrap_err();
        assert!(error.contains("is not a language tag"), "{error}");
    }
    assert!(by_language(&[]).check().unwrap_err().contains("got 0"));
    let good = [
        ("en", "Sand"),
        ("pt-BR", "Areia"),
        ("zh-Hant", "沙"),
        ("ar", "رمل"),
        ("fa", "می\u{200c}رود"),
    ];
    assert_eq!(by_language(&good).check(), Ok(()));
}
