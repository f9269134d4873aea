//! Numbers with units in tags, against values of the OSM wiki's page on units.

use super::*;

#[test]
fn numbers_are_converted_to_the_unit() {
    let cases = [
        (TagUnit::Metre, "12", 12.0),
        (TagUnit::Metre, " 12.5 m ", 12.5),
        (TagUnit::Metre, "-3.5", -3.5),
        (TagUnit::Metre, "1000 ft", 304.8),
        (TagUnit::Metre, "12'6\"", 3.81),
        (TagUnit::Metre, "7'", 2.1336),
        (TagUnit::Millimetre, "1435", 1435.0),
        (TagUnit::Millimetre, "1.435 m", 1435.0),
        (TagUnit::Foot, "100 m", 328.083_989_501_312_3),
        (TagUnit::KilometrePerHour, "30 mph", 48.28032),
        (TagUnit::KilometrePerHour, "50 kmh", 50.0),
        (TagUnit::Volt, "110 kV", 110_000.0),
        (TagUnit::Count, "7", 7.0),
        (TagUnit::Percent, "15%", 15.0),
    ];
    for (unit, tagged, number) in cases {
        let read = unit.number(tagged).unwrap();
        assert!(
            (read - number).abs() < 1e-9 * number.abs(),
            "{tagged} in {}: {read}",
            unit.symbol()
        );
    }
}

#[test]
fn other_texts_are_no_numbers() {
    let cases = [
        (TagUnit::Count, "12,345 (2019)"),
        (TagUnit::Count, "12,5"),
        (TagUnit::Count, "1e5"),
        (TagUnit::Count, "inf"),
        (TagUnit::Count, "NaN"),
        (TagUnit::Count, ""),
        (TagUnit::Count, "-"),
        (TagUnit::Count, "--1"),
        (TagUnit::Count, "5 m"),
        (TagUnit::Count, "10000000000000000"),
        (TagUnit::Metre, "5 kg"),
        (TagUnit::Metre, "5;6"),
        (TagUnit::Metre, "5-6"),
        (TagUnit::Metre, "12'6"),
        (TagUnit::Volt, "12'6\""),
        (TagUnit::KilometrePerHour, "5 m"),
    ];
    for (unit, tagged) in cases {
        assert_eq!(unit.number(tagged), None, "{tagged:?} in {:?}", unit.symbol());
    }
}

#[test]
fn symbols_are_those_of_tables() {
    for unit in TagUnit::ALL {
        let text = serde_json::to_string(&unit).unwrap();
        assert_eq!(text, format!("{:?}", unit.symbol()));
        assert_eq!(serde_json::from_str::<TagUnit>(&text).unwrap(), unit);
    }
}
