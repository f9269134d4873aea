use super::*;

#[test]
fn the_command_line_is_consistent() {
    use clap::CommandFactory as _;
    Arguments::command().debug_assert();
}

#[test]
fn options_of_later_issues_are_rejected() {
    let line = "corniche build --dem a.tif -o b --photo x.tif";
    assert!(Arguments::try_parse_from(line.split(' ')).is_err(), "{line}");
}

#[test]
fn the_options_of_resumed_builds_and_plans_are_understood() {
    let parse = |line: &str| Arguments::try_parse_from(line.split(' '));
    let Ok(Arguments { command: Command::Build(args) }) =
        parse("corniche build --dem a.tif -o b --resume --tmp c --force")
    else {
        panic!("it is no build");
    };
    assert!(args.resume && args.work.force && !args.overwrite);
    assert_eq!(args.work.resources.tmp, Some("c".into()));
    for line in ["--json", "-o plan.json -O", "--osm b.osm.pbf --max-error 5 --threads 3"] {
        assert!(parse(&format!("corniche plan --dem a.tif {line}")).is_ok(), "{line}");
    }
    // What a plan does not depend on is no option of it.
    for line in ["--resume", "--quiet", "-O", "--defects a.csv"] {
        assert!(parse(&format!("corniche plan --dem a.tif {line}")).is_err(), "{line}");
    }
}
