//! Sizes and positions on the command line are parsed or rejected.

use super::*;

#[test]
fn sizes_and_positions_are_read_or_refused() {
    assert_eq!(parse_size("640x480"), Ok([640, 480]));
    assert!(
        parse_size("640").is_err()
            && parse_size("0x5").is_err()
            && parse_size("17000x900").is_err()
    );
    assert_eq!(parse_position("-9.5, 47"), Ok([-9.5, 47.0]));
    assert!(parse_position("47").is_err() && parse_position("9,147").is_err());
}
