//! Texts of single values.

pub(crate) fn parse_bytes(text: &str) -> Result<u64, String> {
    let (digits, unit) = match text.char_indices().last() {
        Some((at, 'K' | 'k')) => (&text[..at], 1 << 10),
        Some((at, 'M' | 'm')) => (&text[..at], 1 << 20),
        Some((at, 'G' | 'g')) => (&text[..at], 1 << 30),
        Some((at, 'T' | 't')) => (&text[..at], 1 << 40),
        _ => (text, 1),
    };
    let number: Option<u64> = digits.parse().ok();
    match number.and_then(|number| number.checked_mul(unit)) {
        Some(size_bytes @ 1..) => Ok(size_bytes),
        _ => Err("write it like 800K, 512M, 4G or 1T".to_owned()),
    }
}

/// The lowest and the highest of something, in this order.
pub(crate) fn parse_range(text: &str) -> Result<[f64; 2], String> {
    let ends = text
        .split_once(',')
        .and_then(|(low, high)| Some([low.trim().parse().ok()?, high.trim().parse().ok()?]));
    match ends {
        Some([low, high]) if low < high && f64::is_finite(low) && high.is_finite() => {
            Ok([low, high])
        }
        _ => Err("write the lowest and the highest like -500,9000".to_owned()),
    }
}

/// More than most graphics cards can draw; each says itself what it can.
pub(crate) fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let sides = text
        .split_once('x')
        .and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    match sides {
        Some([width @ 1..=16384, height @ 1..=16384]) => Ok([width, height]),
        Some(_) => Err("both sides must be between 1 and 16384 pixels".to_owned()),
        None => Err("write it like 1600x1200".to_owned()),
    }
}

pub(crate) fn parse_position(text: &str) -> Result<[f64; 2], String> {
    let position = text
        .split_once(',')
        .and_then(|(lon, lat)| Some([lon.trim().parse().ok()?, lat.trim().parse().ok()?]));
    match position {
        Some([lon, lat]) if (-360.0..=360.0).contains(&lon) && (-90.0..=90.0).contains(&lat) => {
            Ok([lon, lat])
        }
        Some(_) => Err("longitude must be within ±360 and latitude within ±90 degrees".to_owned()),
        None => Err("write longitude,latitude like 9.52,47.14".to_owned()),
    }
}

/// A cell, east and north: one number is a square.
pub(crate) fn parse_cell(text: &str) -> Result<[f64; 2], String> {
    let side = |text: &str| text.trim().parse::<f64>().ok();
    let sides_m = match text.split_once(',') {
        Some((east, north)) => {
            side(east).zip(side(north)).map(|(east_m, north_m)| [east_m, north_m])
        }
        None => side(text).map(|side_m| [side_m; 2]),
    };
    match sides_m {
        Some(sides_m) => check_cell(sides_m),
        None => Err("write metres like 30, or east,north like 20,30".to_owned()),
    }
}

/// Sides that can be those of a cell, east and north.
pub(crate) fn check_cell(sides_m: [f64; 2]) -> Result<[f64; 2], String> {
    match sides_m.iter().find(|side_m| !(**side_m > 0.0 && side_m.is_finite())) {
        Some(side_m) => Err(format!("a side must be a positive number of metres, not {side_m}")),
        None => Ok(sides_m),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_of_memory() {
        assert_eq!(parse_bytes("800K"), Ok(800 << 10));
        assert_eq!(parse_bytes("512M"), Ok(512 << 20));
        assert_eq!(parse_bytes("4G"), Ok(4 << 30));
        assert_eq!(parse_bytes("1T"), Ok(1 << 40));
        assert_eq!(parse_bytes("17"), Ok(17));
        for bad in ["", "0", "M", "-1M", "4P", "1.5G", "99999999999999G", "99999999T", "ä"] {
            assert!(parse_bytes(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn ranges_have_two_ends_in_order() {
        assert_eq!(parse_range("-500,9000"), Ok([-500.0, 9000.0]));
        assert_eq!(parse_range("0, 70000.5"), Ok([0.0, 70_000.5]));
        for bad in ["", "5", "5,5", "9000,-500", "a,b", "0,inf", "nan,1", "1,2,3"] {
            assert!(parse_range(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn cells_are_squares_or_rectangles() {
        assert_eq!(parse_cell("30"), Ok([30.0, 30.0]));
        assert_eq!(parse_cell("20.5, 30"), Ok([20.5, 30.0]));
        for bad in ["", "30 m", "20x30", "20,", "20,30,40"] {
            assert!(parse_cell(bad).unwrap_err().contains("20,30"), "{bad}");
        }
        for bad in ["0", "-5", "nan", "inf", "20,0", "-20,30"] {
            assert!(parse_cell(bad).unwrap_err().contains("positive number of metres"), "{bad}");
        }
    }

    #[test]
    fn sizes_and_positions() {
        assert_eq!(parse_size("640x480"), Ok([640, 480]));
        assert!(
            parse_size("640").is_err()
                && parse_size("0x5").is_err()
                && parse_size("17000x900").is_err()
        );
        assert_eq!(parse_position("-9.5, 47"), Ok([-9.5, 47.0]));
        assert!(parse_position("47").is_err() && parse_position("9,147").is_err());
    }
}
