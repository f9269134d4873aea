//! Commands that draw have the same options with the same defaults, or explain the difference.

use clap::Parser as _;

use super::*;
use crate::args::{Arguments, CliCommand};

#[test]
fn one_flight_may_be_taken_with_several_methods() {
    let line = "corniche fly a -o b --roads none,geo --roads sv,sv-no-caps --lod full,culled,lod";
    let CliCommand::Fly(args) = Arguments::try_parse_from(line.split(' ')).unwrap().command else {
        panic!("{line} is a flight");
    };
    assert_eq!(args.drawing.roads, [Roads::None, Roads::Geo, Roads::Sv, Roads::SvNoCaps]);
    assert_eq!(args.drawing.lod, [Detail::Full, Detail::Culled, Detail::Adaptive]);
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

/// Options that `render`, `fly` and `view` share have the same default; if there is a reason for
/// another one, the help text explains it.
#[test]
fn commands_that_draw_have_the_same_defaults_or_say_why_not() {
    use clap::CommandFactory as _;
    use std::collections::BTreeMap;

    // Option, command, its default, and a word of the explanation.
    let others = [
        ("size", "view", "1280x800", "fits on a screen"),
        ("supersampling", "fly", "1", "compared with published figures"),
        // The default is chosen when the window knows its adapter.
        ("supersampling", "view", "", "without a GPU"),
        ("roads", "view", "", "without a GPU"),
    ];
    let program = Arguments::command();
    let mut shared: BTreeMap<String, Vec<(&str, String, String)>> = BTreeMap::new();
    for command in ["render", "fly", "view"] {
        let options = program.find_subcommand(command).unwrap().get_arguments();
        for option in options.filter(|option| option.get_long().is_some()) {
            let values = option.get_default_values().iter().map(|value| value.to_string_lossy());
            let default = values.collect::<Vec<_>>().join(",");
            let help = option.get_help().map(ToString::to_string).unwrap_or_default();
            let name = option.get_long().unwrap().to_owned();
            shared.entry(name).or_default().push((command, default, help));
        }
    }
    shared.retain(|_, commands| commands.len() > 1);
    for name in [
        "roads",
        "style",
        "caps",
        "width-growth",
        "outline",
        "cap-test",
        "size",
        "look-at",
        "distance",
        "heading",
        "pitch",
        "screen-space-error",
        "exaggeration",
        "supersampling",
        "gpu-memory",
        "upload-per-frame",
    ] {
        assert!(shared.contains_key(name), "{name}: {:?}", shared.keys());
    }
    let mut explained = 0;
    for (name, commands) in &shared {
        let (_, usual, _) = &commands[0];
        for (command, default, help) in &commands[1..] {
            let other = others.iter().find(|(option, of, ..)| option == name && of == command);
            match other {
                Some((_, _, expected, reason)) => {
                    assert_eq!(default, expected, "{command} --{name}");
                    assert!(help.contains(reason), "{command} --{name}: {help}");
                    explained += 1;
                }
                None => assert_eq!(default, usual, "{command} --{name}"),
            }
        }
    }
    assert_eq!(explained, others.len());
}
