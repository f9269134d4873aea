use clap::Parser as _;

use super::*;
use crate::args::{Arguments, Command};

#[test]
fn one_flight_may_be_taken_with_several_methods() {
    let line = "corniche fly a -o b --roads none,geo --roads sv,sv-no-caps --lod full,culled,lod";
    let Command::Fly(args) = Arguments::try_parse_from(line.split(' ')).unwrap().command else {
        panic!("{line} is a flight");
    };
    assert_eq!(args.drawing.roads, [Roads::None, Roads::Geo, Roads::Sv, Roads::SvNoCaps]);
    assert_eq!(args.drawing.lod, [Lod::Full, Lod::Culled, Lod::Adaptive]);
    let both = "corniche fly a -o b --frames 3 --step 0.1";
    assert!(Arguments::try_parse_from(both.split(' ')).is_err());
}

#[test]
fn samples_are_one_to_four_along_each_side() {
    for (samples, fits) in [("0", false), ("1", true), ("4", true), ("5", false)] {
        for command in ["render", "fly"] {
            let line = ["corniche", command, "a", "-o", "b", "--supersampling", samples];
            assert_eq!(Arguments::try_parse_from(line).is_ok(), fits, "{command} {samples}");
        }
    }
}
