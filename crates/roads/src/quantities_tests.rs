//! Widths, speeds and lanes are read with their units, and no text crashes a reader.

use proptest::prelude::*;

use super::*;

#[test]
fn lanes_are_a_count() {
    let number = |text| lanes(text).map(NonZeroU8::get);
    assert_eq!([number("1"), number("2"), number("255")], [Some(1), Some(2), Some(255)]);
    for text in ["", "0", "-1", "+2", "1.5", "2;3", "256", "two", "2 ", "1e1"] {
        assert_eq!(number(text), None, "{text:?}");
    }
}

/// These are the examples of the wiki, and numbers that are not widths.
#[test]
fn widths_are_in_metres_or_in_their_unit() {
    for (text, mm) in [
        ("2", 2000),
        ("2.5", 2500),
        ("12 m", 12_000),
        ("12m", 12_000),
        ("0.6 km", 600_000),
        ("350 cm", 3500),
        ("900 mm", 900),
        ("0.1 mi", 160_934),
        ("10 ft", 3048),
        ("12'", 3658),
        ("12'6\"", 3810),
        ("12' 6\"", 3810),
        ("0'3\"", 76),
        ("30\"", 762),
        ("0.001", 1),
        ("1000", 1_000_000),
    ] {
        assert_eq!(width_mm(text).map(NonZeroU32::get), Some(mm), "{text:?}");
    }
    for text in [
        "",
        "0",
        "0.0",
        "-3",
        "+3",
        "3,5",
        "2-3",
        "2;3",
        "~3",
        "3.5.1",
        ".5",
        "3.",
        "narrow",
        "inf",
        "NaN",
        "1e2",
        "0.0004",
        "1000.1",
        "2 mi",
        "12'6",
        "12'x\"",
        "'",
        "\"",
        "m",
        "3 yd",
        "99999999999999999999999",
    ] {
        assert_eq!(width_mm(text), None, "{text:?}");
    }
}

#[test]
fn speeds_are_numbers_with_units_or_words() {
    for (text, kept) in [
        ("50", "50"),
        ("050", "50"),
        ("50 km/h", "50"),
        ("50kph", "50"),
        ("30 mph", "30 mph"),
        ("30mph", "30 mph"),
        ("10 knots", "10 knots"),
        ("7.5", "7.5"),
        ("none", "none"),
        ("walk", "walk"),
        ("CH:urban", "CH:urban"),
        ("50; 80", "50; 80"),
        ("99999", "99999"),
        ("", ""),
    ] {
        assert_eq!(max_speed(text), kept, "{text:?}");
    }
}

proptest! {
    /// No text crashes a reader, and values in a package are read unchanged again.
    #[test]
    fn any_text_can_be_read(text in ".{0,20}", odd in "[0-9.'\" mftk/hp]{0,10}") {
        for text in [&text, &odd] {
            lanes(text);
            let _ = width_mm(text);
            let speed = max_speed(text);
            prop_assert_eq!(max_speed(&speed), speed);
        }
    }

    /// Metres and millimetres give the same width.
    #[test]
    fn a_width_in_millimetres_comes_back(mm in 1_u32..=1_000_000) {
        let metres = format!("{}.{:03}", mm / 1000, mm % 1000);
        prop_assert_eq!(width_mm(&metres).map(NonZeroU32::get), Some(mm));
        prop_assert_eq!(width_mm(&format!("{mm} mm")).map(NonZeroU32::get), Some(mm));
    }
}
