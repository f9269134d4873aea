//! The command line is consistent: options exclude each other, do not consume positional arguments,
//! and have tips.

use std::path::{Path, PathBuf};

use corniche_remote::PackagePlace;

use super::*;
use crate::failure::CommandFailure;

fn planned(args: &part::PlannedArgs) -> Result<(PathBuf, Vec<PathBuf>), CommandFailure> {
    plan_and_stores(args.plan.as_ref(), &args.store)
}

#[test]
fn the_command_line_is_consistent() {
    Arguments::command().debug_assert();
}

#[test]
fn options_that_are_not_there_are_rejected() {
    let line = "corniche build --dem a.tif -o b --lakes x.tif";
    assert!(Arguments::try_parse_from(line.split(' ')).is_err(), "{line}");
}

#[test]
fn the_options_of_resumed_builds_and_plans_are_understood() {
    let parse = |line: &str| Arguments::try_parse_from(line.split(' '));
    let Ok(Arguments { command: CliCommand::Build(args), .. }) =
        parse("corniche build --dem a.tif -o b --resume --tmp c --force")
    else {
        panic!("it is no build");
    };
    assert!(args.resume && args.work.force && !args.overwrite);
    assert_eq!(args.work.resources.tmp, Some("c".into()));
    for line in ["--json", "-o plan.json -O", "--osm b.osm.pbf --max-error 5 --threads 3"] {
        assert!(parse(&format!("corniche plan --dem a.tif {line}")).is_ok(), "{line}");
    }
    // Options that do not affect a plan are not options of it.
    for line in ["--resume", "-O", "--defects a.csv"] {
        assert!(parse(&format!("corniche plan --dem a.tif {line}")).is_err(), "{line}");
    }
}

/// `-q`, `-v` and `--log-format` are options of every command, before and after its name.
#[test]
fn every_command_takes_the_options_of_messages() {
    let parse = |line: String| Arguments::checked_from(line.split_whitespace().map(Into::into));
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
        "profile" => "a.pmtiles --way 1,-2",
        "match" => "a.pmtiles --slope",
        "completions" => "bash",
        _ => "a.pmtiles",
    };
    for name in &names {
        let quiet = Voice { quiet: true, ..Voice::default() };
        let loud = Voice { verbose: 2, log_format: LogFormat::Json, ..Voice::default() };
        for (line, voice) in [
            (format!("corniche {name} {} -q", rest(name)), quiet),
            (format!("corniche --quiet {name} {}", rest(name)), quiet),
            (format!("corniche {name} -vv --log-format json {}", rest(name)), loud),
        ] {
            let arguments = parse(line.clone()).unwrap_or_else(|error| panic!("{line}: {error}"));
            assert_eq!(
                (arguments.voice, arguments.name.as_str()),
                (voice, name.as_str()),
                "{line}"
            );
        }
        assert!(parse(format!("corniche {name} {} -q -v", rest(name))).is_err(), "{name}");
    }
    let told = parse("corniche verify a.pmtiles --json-progress".into()).unwrap().voice;
    assert!(told.json_progress);
    assert!(parse("corniche verify a.pmtiles --json-progress -q".into()).is_err());
}

/// Two of `-q`, `-v` and `--json-progress` are rejected in every order; the parser alone detects
/// only those on one side of the command's name.
#[test]
fn silence_and_talk_exclude_each_other_on_both_sides_of_the_command() {
    let parse = |line: &str| Arguments::checked_from(line.split(' ').map(Into::into));
    let package = "verify a.pmtiles";
    for line in [
        format!("corniche -q {package} --json-progress"),
        format!("corniche {package} -q --json-progress"),
        format!("corniche -q {package} -v"),
        format!("corniche -v {package} -q"),
        format!("corniche -q -v {package}"),
        "corniche -q build --dem a.tif -o b.pmtiles --json-progress".to_owned(),
    ] {
        let refused = parse(&line).expect_err(&line);
        assert_eq!(refused.kind(), ErrorKind::ArgumentConflict, "{line}");
        let said = refused.to_string();
        assert!(said.contains("--quiet") && said.contains("cannot be used with"), "{line}: {said}");
    }
    let line = format!("corniche -v {package} --json-progress");
    let said = parse(&line).expect_err(&line).to_string();
    assert!(said.contains("'--json-progress' cannot be used with '--verbose'"), "{said}");
    for option in ["-q", "-v", "-vv"] {
        assert!(parse(&format!("corniche {option} {package}")).is_ok(), "{option}");
    }
    assert!(parse(&format!("corniche {package} --json-progress")).is_ok());
}

/// Readers of records get the error of an invalid command line as a record.
#[test]
fn the_voice_of_a_line_that_is_not_understood_is_found() {
    let voice = |line: &str| Voice::of_unparsed(line.split(' ').map(Into::into));
    let json = Voice { log_format: LogFormat::Json, ..Voice::default() };
    let progress = Voice { json_progress: true, ..Voice::default() };
    for (line, expected) in [
        ("info --odd", Voice::default()),
        ("info --odd --log-format json", json),
        ("--log-format=json info --odd", json),
        ("build --json-progress --odd", progress),
        ("info --log-format text json", Voice::default()),
        ("info json --log-format", Voice::default()),
        ("info -- --log-format json --json-progress", Voice::default()),
    ] {
        assert_eq!(voice(line), expected, "{line}");
    }
}

/// An option with several values consumes all words that follow it, including a positional
/// argument. Each command that has both finds its own argument among them by its name.
#[test]
fn options_with_several_values_leave_positional_arguments_alone() {
    let mut found = Vec::new();
    for (path, command) in all_commands() {
        let has_positional = command.get_positionals().next().is_some();
        let takes_several = |arg: &&clap::Arg| {
            !arg.is_positional() && arg.get_num_args().is_some_and(|range| range.max_values() > 1)
        };
        for option in command.get_arguments().filter(takes_several).filter(|_| has_positional) {
            found.push(format!("{path} --{}", option.get_long().unwrap()));
        }
    }
    found.sort();
    // Further required options; files are called `rest`.
    let measured = |from: &RecordedArgs, osm: &[PathBuf]| {
        let (package, files) = from.files(osm, "").unwrap();
        let mut files = files.concat();
        files.retain(|file| file != Path::new("rest"));
        (path_of(package), files)
    };
    let files = |arguments: &Arguments| match &arguments.command {
        CliCommand::Profile(args) => measured(&args.recorded, &args.extract.osm),
        CliCommand::Jobs(args) => plan_and_stores(args.plan.as_ref(), &args.store).unwrap(),
        CliCommand::Part(args) => planned(&args.planned).unwrap(),
        CliCommand::Merge(args) => planned(&args.planned).unwrap(),
        CliCommand::Export(what) => match what {
            Export::GeoTiff(args) => measured(&args.from, &[]),
            Export::Roads(args) => measured(&args.vector.from, &args.vector.extract.osm),
            Export::Edges(args) => measured(&args.vector.from, &args.vector.extract.osm),
            what => panic!("{what:?} has no files to tell apart"),
        },
        CliCommand::Match(args) => {
            let (package, [photos]) =
                package_among(args.package.as_ref(), [&args.photo], "").unwrap();
            (path_of(package), photos)
        }
        CliCommand::Verify(args) => {
            let lists = [&*args.dem, &*args.photo, &*args.osm];
            let (package, files) = package_among(args.package.as_ref(), lists, "").unwrap();
            (path_of(package), files.concat())
        }
        _ => panic!("{arguments:?} has no files to tell apart"),
    };
    // The words after the option, the expected positional argument, and the required options.
    let known = [
        ("export edges --dem", "p.pmtiles", "-o e.csv --osm rest"),
        ("export edges --osm", "p.pmtiles", "-o e.csv --dem rest"),
        ("export geotiff --dem", "p.pmtiles", "-o h.tif"),
        ("export roads --dem", "p.pmtiles", "-o r.csv"),
        ("export roads --osm", "p.pmtiles", "-o r.csv --dem rest"),
        ("jobs --store", "p.json", "--slots 2"),
        ("match --photo", "p.pmtiles", "--radius 20"),
        ("merge --store", "p.json", "-o c.pmtiles"),
        ("part --store", "p.json", "--step top"),
        ("profile --dem", "p.pmtiles", "--way 7"),
        ("profile --osm", "p.pmtiles", "--way 7 --dem rest"),
        ("verify --dem", "p.pmtiles", "--threads 1"),
        ("verify --osm", "p.pmtiles", "--threads 1"),
        ("verify --photo", "p.pmtiles", "--threads 1"),
    ];
    let names: Vec<&str> = known.iter().map(|(name, _, _)| *name).collect();
    assert_eq!(found, names, "a new option with several values needs a line here");
    for (name, positional, rest) in known {
        let (command, option) = name.rsplit_once(' ').unwrap();
        for line in [
            format!("corniche {command} {option} a b {positional} {rest}"),
            format!("corniche {command} {rest} {option} a {positional} {option} b"),
            format!("corniche {command} {positional} {option} a b {rest}"),
            format!("corniche {command} {option} a b {rest} {positional}"),
        ] {
            let arguments = Arguments::try_parse_from(line.split(' '));
            let arguments = arguments.unwrap_or_else(|error| panic!("{line}: {error}"));
            assert_eq!(
                files(&arguments),
                (positional.into(), vec!["a".into(), "b".into()]),
                "{line}"
            );
        }
    }
}

fn path_of(place: PackagePlace) -> PathBuf {
    match place {
        PackagePlace::File(path) => path,
        PackagePlace::Address(address) => panic!("{address} is no file"),
    }
}

/// All commands and their subcommands, by their words.
fn all_commands() -> Vec<(String, clap::Command)> {
    let mut all = vec![(String::new(), Arguments::command())];
    let mut next = 0;
    while let Some((path, command)) = all.get(next).cloned() {
        let below = command
            .get_subcommands()
            .map(|below| (format!("{path} {}", below.get_name()).trim().to_owned(), below.clone()));
        all.extend(below.collect::<Vec<_>>());
        next += 1;
    }
    all
}

/// A missing or ambiguous plan is reported.
#[test]
fn a_plan_that_is_not_named_is_missed() {
    let refusal = |line: &str| {
        let arguments = Arguments::try_parse_from(line.split(' ')).unwrap();
        let CliCommand::Part(args) = arguments.command else { panic!("{line}") };
        planned(&args.planned).unwrap_err().to_string()
    };
    for (names, word) in [
        ("a b", "no plan is named"),
        ("p.json q.json a", "several names"),
        ("p.json", "--store needs a folder"),
    ] {
        let said = refusal(&format!("corniche part --step top --store {names}"));
        assert!(said.contains(word), "{names}: {said}");
    }
    assert!(Arguments::try_parse_from(["corniche", "jobs", "--slots", "2"]).is_err());
}

/// `--dem` and `--osm` consume every name up to the next option; a package among them is recognized
/// by its extension.
#[test]
fn verify_finds_its_package_wherever_it_is_named() {
    let files = |line: &str| {
        let arguments =
            Arguments::try_parse_from(line.split(' ')).map_err(|error| error.to_string())?;
        let CliCommand::Verify(args) = arguments.command else { panic!("{line}") };
        let lists = [&*args.dem, &*args.photo, &*args.osm];
        let found = package_among(args.package.as_ref(), lists, "verify");
        let (package, [dem, _, osm]) = found.map_err(|failure| failure.to_string())?;
        Ok::<_, String>((path_of(package), dem, osm))
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
    // A package with another name is found where no option consumes it.
    assert!(files("corniche verify old --dem a.tif").is_ok_and(|(package, ..)| package == *"old"));
    assert!(
        files("corniche verify --dem a.tif b.tif").unwrap_err().contains("no package is named")
    );
    assert!(
        files("corniche verify --dem a.tif p.pmtiles q.pmtiles").unwrap_err().contains("several")
    );
    assert!(files("corniche verify").is_err());
}

/// The methods without caps are for `fly`, which accepts several; elsewhere the error says what to
/// write.
#[test]
fn caps_are_an_option_wherever_one_method_is_drawn() {
    let parse = |line: &str| Arguments::checked_from(line.split(' ').map(Into::into));
    for command in ["render a.pmtiles -o a.png", "view a.pmtiles"] {
        for method in ["geo", "sv"] {
            let line = format!("corniche {command} --roads {method}-no-caps");
            let said = parse(&line).expect_err(&line).to_string();
            let tip = format!(
                "tip: write --roads {method} --caps none; only fly accepts {method}-no-caps"
            );
            assert!(said.contains(&tip) && said.matches("tip:").count() == 1, "{line}: {said}");
            assert!(said.contains("[possible values: geo, sv, none]"), "{line}: {said}");
            let line = format!("corniche {command} --roads {method} --caps none");
            assert!(parse(&line).is_ok(), "{line}");
        }
        let line = format!("corniche {command} --roads none-no-caps");
        assert!(!parse(&line).expect_err(&line).to_string().contains("only fly accepts"), "{line}");
    }
    assert!(parse("corniche fly a.pmtiles -o a.csv --roads geo,geo-no-caps,sv-no-caps").is_ok());
    let line = "corniche export mesh a.pmtiles -o a.glb --roads sv-no-caps";
    assert!(!parse(line).expect_err(line).to_string().contains("only fly accepts"), "{line}");
}

/// Options for comparisons are not in the way of others: only the long help shows them, under a
/// separate heading.
#[test]
fn what_compares_with_the_papers_is_in_the_long_help_alone() {
    let papers = ["caps", "width-growth", "outline", "cap-test", "geo-quads"];
    for command in ["render", "fly", "view"] {
        let mut program = Arguments::command();
        let command = program.find_subcommand_mut(command).unwrap();
        let (short, long) =
            (command.render_help().to_string(), command.render_long_help().to_string());
        let (_, compared) = long.split_once("Comparing with the papers:").unwrap();
        for option in papers {
            let option = format!("--{option} ");
            assert!(!short.contains(&option) && compared.contains(&option), "{option}: {short}");
        }
        assert!(short.contains("--style ") && !short.contains("Comparing"), "{short}");
        // These apply to an image only, not to a map that moves or a flight.
        assert_eq!(compared.contains("--unmapped"), command.get_name() == "render");
    }
}

/// Another program's option for a part of the data gets a tip with ours; commands without parts
/// give no tip.
#[test]
fn options_of_other_programs_for_a_part_get_a_tip() {
    let refusal = |line: &str| {
        let refused = Arguments::checked_from(line.split(' ').map(Into::into));
        let refused = refused.expect_err(line);
        assert_eq!(refused.kind(), ErrorKind::UnknownArgument, "{line}");
        refused.to_string()
    };
    let tip = "tip: use --bounds W,S,E,N or --polygon FILE";
    for line in [
        "corniche build --dem a.tif -o b.pmtiles --clip c.geojson",
        "corniche build --dem a.tif -o b.pmtiles --cutline=c.geojson",
        "corniche plan --dem a.tif --bbox 9,47,10,48",
    ] {
        let said = refusal(line);
        assert!(said.contains(tip) && said.matches("tip:").count() == 1, "{line}: {said}");
    }
    for line in ["corniche info a.pmtiles --bbox 1", "corniche plan --dem a.tif --odd 1"] {
        assert!(!refusal(line).contains(tip), "{line}");
    }
}

/// Inputs without options get a tip with the options for them, judged by their extensions.
#[test]
fn files_without_options_get_the_options_that_name_them() {
    for (line, tip) in [
        ("build a.hgt b.osm.pbf", "--dem a.hgt --osm b.osm.pbf"),
        ("build a.tif b.asc c.pmtiles", "--dem a.tif b.asc --output c.pmtiles"),
        ("build A.TIF B.OSM.PBF", "--dem A.TIF --osm B.OSM.PBF"),
        ("build a.hgt a.HGT b.osm.bz2", "--dem a.hgt a.HGT --osm b.osm.bz2"),
        ("build b.osm --dem a.tif", "--osm b.osm"),
        ("build a.tif -q b.osm.pbf", "--dem a.tif --osm b.osm.pbf"),
        ("profile c.pmtiles road.GPX", "--line road.GPX"),
        (
            "export edges c.pmtiles a.tif b.osm.pbf e.gpkg",
            "--dem a.tif --osm b.osm.pbf --output e.gpkg",
        ),
        ("export roads c.pmtiles a.tif", "--dem a.tif"),
        ("export geotiff c.pmtiles a.tif", "--output a.tif"),
        ("build b.osm.pbf -o c.pmtiles", "--osm b.osm.pbf"),
        ("plan a.tif mine.toml", "--dem a.tif --config mine.toml"),
        ("verify c.pmtiles a.tif b.osm.pbf", "--dem a.tif --osm b.osm.pbf"),
        ("export roads c.pmtiles roads.gpkg", "--output roads.gpkg"),
        ("render c.pmtiles a.png --size 640x480", "--output a.png"),
    ] {
        let line = format!("corniche {line}");
        let refused = Arguments::checked_from(line.split(' ').map(Into::into));
        let said = refused.expect_err(&line).to_string();
        let tip = format!("tip: files are passed with options: {tip}\n");
        assert!(said.contains(&tip) && said.matches("tip:").count() == 1, "{line}: {said}");
    }
    for line in ["corniche info a.pmtiles b.pmtiles", "corniche build --odd a.tif"] {
        let refused = Arguments::checked_from(line.split(' ').map(Into::into));
        assert!(!refused.expect_err(line).to_string().contains("files are passed"), "{line}");
    }
}

/// A site is files: the error for a port together with it says why, in any order.
#[test]
fn an_address_beside_a_site_is_refused_with_the_reason() {
    for line in [
        "corniche serve --port 8090 --site F a.pmtiles",
        "corniche serve --site F --port 8090 a.pmtiles",
        "corniche serve a.pmtiles --site F --address 0.0.0.0",
        "corniche serve a.pmtiles --address 0.0.0.0 --port 0 --site F",
    ] {
        let refused = Arguments::checked_from(line.split(' ').map(Into::into));
        let said = refused.expect_err(line).to_string();
        let tip = "tip: --site writes files for another web server and starts no server";
        assert!(said.contains(tip) && said.contains("omit --port and --address"), "{line}: {said}");
    }
    let other = "corniche verify a.pmtiles -q --json-progress";
    let refused = Arguments::checked_from(other.split(' ').map(Into::into));
    assert!(!refused.expect_err(other).to_string().contains("tip:"), "{other}");
}

#[test]
fn missing_arguments_are_named_in_a_sentence() {
    for (line, words) in [
        ("match a.pmtiles", "match needs more arguments; pass --photo <FILE>... or --slope\n"),
        (
            "export edges a.pmtiles -o e.csv",
            "export edges needs more arguments; pass --dem <FILE>... and --osm <FILE>...\n",
        ),
        ("tile a.pmtiles", "tile needs more arguments; pass <Z/X/Y> or --at <LON,LAT>\n"),
        (
            "match",
            "match needs more arguments; pass (--photo <FILE>... or --slope) and <PACKAGE>\n",
        ),
        (
            "profile a.pmtiles",
            "profile needs more arguments; pass --way <ID> or --line <FILE> or --ref <NUMBER> or --name <NAME> or --from <LON,LAT> --to <LON,LAT>\n",
        ),
    ] {
        let line = format!("corniche {line}");
        let refused = Arguments::checked_from(line.split(' ').map(Into::into));
        let said = refused.expect_err(&line).to_string();
        let begin = format!("error: corniche {words}\nUsage: corniche ");
        assert!(said.starts_with(&begin), "{line}: {said}");
    }
}
