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
    let Ok(Arguments { command: Command::Build(args), .. }) =
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
    for line in ["--resume", "-O", "--defects a.csv"] {
        assert!(parse(&format!("corniche plan --dem a.tif {line}")).is_err(), "{line}");
    }
}

/// `-q`, `-v` and `--log-format` are options of every command, before its name and behind it.
#[test]
fn every_command_takes_the_options_of_messages() {
    use clap::CommandFactory as _;
    let parse = |line: String| Arguments::try_parse_from(line.split_whitespace());
    let names: Vec<String> = Arguments::command()
        .get_subcommands()
        .map(|command| command.get_name().to_owned())
        .collect();
    assert!(names.len() >= 12, "{names:?}");
    let rest = |name: &str| match name {
        "build" => "--dem a.tif -o b.pmtiles",
        "plan" => "--dem a.tif",
        "jobs" => "p.json --slots 2",
        "part" => "p.json --store s --step top",
        "merge" => "p.json --store s -o b.pmtiles",
        "tile" => "a.pmtiles 0/0/0",
        "export" => "roads a.pmtiles -o a.gpkg",
        "render" => "a.pmtiles -o a.png",
        "fly" => "a.pmtiles -o a.csv",
        "completions" => "bash",
        _ => "a.pmtiles",
    };
    for name in &names {
        let quiet = Voice { is_quiet: true, ..Voice::default() };
        let loud = Voice { verbosity: 2, format: LogFormat::Json, ..Voice::default() };
        for (line, voice) in [
            (format!("corniche {name} {} -q", rest(name)), quiet),
            (format!("corniche --quiet {name} {}", rest(name)), quiet),
            (format!("corniche {name} -vv --log-format json {}", rest(name)), loud),
        ] {
            let arguments = parse(line.clone()).unwrap_or_else(|error| panic!("{line}: {error}"));
            assert_eq!(
                (arguments.voice(), arguments.command.name()),
                (voice, name.as_str()),
                "{line}"
            );
        }
        assert!(parse(format!("corniche {name} {} -q -v", rest(name))).is_err(), "{name}");
    }
    let told = parse("corniche verify a.pmtiles --json-progress".into()).unwrap().voice();
    assert!(told.json_progress);
    assert!(parse("corniche verify a.pmtiles --json-progress -q".into()).is_err());
}

/// `--dem` and `--osm` take every name up to the next option; a package among them is told by its ending.
#[test]
fn verify_finds_its_package_wherever_it_is_named() {
    let files = |line: &str| {
        let arguments =
            Arguments::try_parse_from(line.split(' ')).map_err(|error| error.to_string())?;
        let Command::Verify(args) = arguments.command else { panic!("{line}") };
        let files = args.files().map_err(|failure| failure.to_string())?;
        Ok::<_, String>((files.package, files.dem, files.osm))
    };
    let expected = Ok(("p.pmtiles".into(), vec!["a.tif".into(), "b.tif".into()], Vec::new()));
    for line in [
        "corniche verify p.pmtiles --dem a.tif b.tif",
        "corniche verify --dem a.tif b.tif p.pmtiles",
        "corniche verify --dem a.tif p.pmtiles --dem b.tif",
        "corniche verify --dem a.tif b.tif --json p.pmtiles",
        "corniche verify --dem a.tif --threads 2 p.pmtiles --dem b.tif",
    ] {
        assert_eq!(files(line), expected, "{line}");
    }
    let expected = Ok(("p.pmtiles".into(), Vec::new(), vec!["a.pbf".into(), "b.pbf".into()]));
    for line in [
        "corniche verify p.pmtiles --osm a.pbf b.pbf",
        "corniche verify --osm a.pbf b.pbf p.pmtiles",
        "corniche verify --osm a.pbf --osm b.pbf --json p.pmtiles",
    ] {
        assert_eq!(files(line), expected, "{line}");
    }
    // A package of another name is found where nothing swallows it.
    assert!(files("corniche verify old --dem a.tif").is_ok_and(|(package, ..)| package == *"old"));
    assert!(
        files("corniche verify --dem a.tif b.tif").unwrap_err().contains("no package is named")
    );
    assert!(
        files("corniche verify --dem a.tif p.pmtiles q.pmtiles").unwrap_err().contains("several")
    );
    assert!(files("corniche verify").is_err());
}
