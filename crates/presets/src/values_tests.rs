//! Sizes, ranges and cells are parsed or rejected.

use super::*;

#[test]
fn sizes_of_memory_are_read_or_refused() {
    assert_eq!(parse_bytes("800K"), Ok(800 << 10));
    assert_eq!(parse_bytes("512M"), Ok(512 << 20));
    assert_eq!(parse_bytes("4G"), Ok(4 << 30));
    assert_eq!(parse_bytes("1T"), Ok(1 << 40));
    assert_eq!(parse_bytes("17"), Ok(17));
    let bad = [
        "",
        "0",
        "M",
        "-1M",
        "4X",
        "1.5.5G",
        "1,5G",
        "0.0001K",
        "99999999999999G",
        "99999999T",
        "ä",
        "∞G",
    ];
    for bad in bad {
        assert!(parse_bytes(bad).is_err(), "{bad}");
    }
}

/// Sizes are read as by `dd` and GNU's other tools, whole or not, in any case, with or without a
/// space.
#[test]
fn sizes_have_binary_and_decimal_units() {
    for (text, size_bytes) in [
        ("512MiB", 512 << 20),
        ("64MB", 64_000_000),
        ("0.5G", 1 << 29),
        ("1.5 GiB", 3 << 29),
        ("0.25gb", 250_000_000),
        ("10kB", 10_000),
        ("10k", 10_240),
        ("3 m", 3 << 20),
        ("17B", 17),
        ("2P", 2 << 50),
    ] {
        assert_eq!(parse_bytes(text), Ok(size_bytes), "{text}");
    }
}

#[test]
fn ranges_have_two_ends_in_order() {
    assert_eq!(parse_range("-500,9000"), Ok([-500.0, 9000.0]));
    assert_eq!(parse_range("0, 70000.5"), Ok([0.0, 70_000.5]));
    for bad in ["", "5", "5,5", "9000,-500", "a,b", "0,inf", "nan,1", "1,2,3", "-1e308,1e308"] {
        assert!(parse_range(bad).is_err(), "{bad}");
    }
}

#[test]
fn cells_are_squares_or_rectangles() {
    assert_eq!(parse_cell("30"), Ok(Cell::from(30.0)));
    assert_eq!(parse_cell("20.5, 30"), Ok(Cell::from([20.5, 30.0])));
    for bad in ["", "30 m", "20x30", "20,", "20,30,40"] {
        assert!(parse_cell(bad).unwrap_err().contains("20,30"), "{bad}");
    }
    for bad in ["0", "-5", "nan", "inf", "20,0", "-20,30"] {
        assert!(parse_cell(bad).unwrap_err().contains("positive number of metres"), "{bad}");
    }
}
