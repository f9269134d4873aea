//! The command line: every command with its options.

mod build;
mod camera;
mod drawing;
mod export;
mod ground;
mod growth;
mod look;
mod matching;
#[cfg(test)]
mod options_page_tests;
mod overlay;
mod part;
mod profile;
mod reading;
mod serve;
mod shared;
mod shell;
mod values;
mod view;
mod voice;

use std::{borrow::Cow, ffi::OsString, path::Path};

use clap::{
    ArgMatches, CommandFactory as _, FromArgMatches as _, Parser, Subcommand,
    error::{ContextKind, ContextValue, ErrorKind},
};

pub(crate) use build::{BuildArgs, PlanArgs, WorkArgs};
pub(crate) use camera::PrintScale;
pub(crate) use drawing::{DETAILS, FlyArgs, RenderArgs};
pub(crate) use export::{
    Export, ExportAreasArgs, ExportBoundariesArgs, ExportEdgesArgs, ExportGeoTiffArgs,
    ExportMeshArgs, ExportQuantizedMeshArgs, ExportRoadsArgs, ExportTiles3dArgs, InPlanArgs,
    MODEL_FORMATS, VECTOR_FORMATS, VectorArgs,
};
pub(crate) use growth::GrowthArgs;
pub(crate) use look::{LookArgs, OUTLINES, ROADS, Roads, WIDTH_GROWTHS};
pub(crate) use matching::MatchArgs;
#[cfg(test)]
pub(crate) use overlay::parse as overlay;
pub(crate) use overlay::{OverlayArg, styled as with_overlays};
pub(crate) use part::{JobsArgs, MergeArgs, PartArgs, plan_and_stores};
pub(crate) use profile::ProfileArgs;
pub(crate) use reading::{Coordinates, InfoArgs, TileArgs, VerifyArgs};
pub(crate) use serve::ServeArgs;
pub(crate) use shared::{
    DatumArg, ExtractArgs, FileArgs, FolderArgs, PackageArg, RecordedArgs, ThreadsArg,
};
pub(crate) use shell::{CompletionsArgs, ManArgs};
pub(crate) use values::{package_among, word_of};
pub(crate) use view::ViewArgs;
pub(crate) use voice::{LogFormat, Voice};

use self::voice::JSON_PROGRESS;
use crate::escaped::one_line;

/// Terrain tiles with roads laid exactly on them, from elevation rasters and OpenStreetMap extracts.
#[derive(Debug, Parser)]
#[command(version, name = "corniche", max_term_width = 100)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
    /// The name of the command.
    #[arg(skip)]
    pub(crate) name: String,
    /// How the program is to talk.
    #[command(flatten)]
    pub(crate) voice: Voice,
    /// End, with exit code 1, when standard input ends: for programs that start this one and keep a pipe to it open. It ends when they
    /// do, however they end. The same part or merge goes on from what was done
    #[arg(long, global = true, help_heading = "For programs")]
    pub(crate) die_with_parent: bool,
}

impl Arguments {
    /// The command line, checked.
    ///
    /// # Errors
    /// When it cannot be used; also when what is asked for is help or the version.
    pub(crate) fn checked_from(words: impl Iterator<Item = OsString>) -> Result<Self, clap::Error> {
        let words: Vec<OsString> = words.collect();
        Self::parsed(&words).map_err(|error| as_shown(error, words))
    }

    fn parsed(words: &[OsString]) -> Result<Self, clap::Error> {
        let matches = Self::command().try_get_matches_from(words);
        let matches = matches.map_err(|error| with_tip(error, words))?;
        let mut arguments = Self::from_arg_matches(&matches)?;
        matches.subcommand_name().unwrap_or_default().clone_into(&mut arguments.name);
        arguments.voice.json_progress = has_json_progress(&matches);
        // Conflicts of options before the command's name with those behind it are not the parser's.
        let Voice { quiet, verbose, json_progress, .. } = arguments.voice;
        let given =
            [(quiet, "--quiet"), (verbose > 0, "--verbose"), (json_progress, "--json-progress")];
        let given: Vec<&str> =
            given.into_iter().filter_map(|(is_given, name)| is_given.then_some(name)).collect();
        let [first, second, ..] = given[..] else { return Ok(arguments) };
        let text = format!("the argument '{second}' cannot be used with '{first}'");
        Err(Self::command().error(ErrorKind::ArgumentConflict, text))
    }
}

/// A refusal in whose message the words of the command line stand as [`one_line`] makes them, so that none passes for a line of ours: it is that of
/// the words so written.
fn as_shown(error: clap::Error, words: Vec<OsString>) -> clap::Error {
    let mut is_shown_as_it_is = true;
    let written = words.into_iter().map(|word| match one_line(&word.to_string_lossy()) {
        Cow::Borrowed(_) => word,
        Cow::Owned(shown) => {
            is_shown_as_it_is = false;
            shown.into()
        }
    });
    let written: Vec<OsString> = written.collect();
    if is_shown_as_it_is {
        return error;
    }
    Arguments::parsed(&written).err().unwrap_or_else(|| {
        // Written otherwise nothing is wrong with them.
        let said = error.to_string();
        let said = said.trim_start_matches("error: ").trim_end();
        Arguments::command().error(error.kind(), one_line(said))
    })
}

/// Whether `--json-progress` is given, to the command or to the one below it.
fn has_json_progress(matches: &ArgMatches) -> bool {
    match matches.subcommand() {
        Some((_, below)) => has_json_progress(below),
        None => matches!(matches.try_get_one(JSON_PROGRESS), Ok(Some(true))),
    }
}

/// What other programs call a part of the data.
const NAMES_OF_PARTS: [&str; 3] = ["--bbox", "--clip", "--cutline"];

/// A refusal, with what to write instead where that is known.
fn with_tip(mut error: clap::Error, words: &[OsString]) -> clap::Error {
    let tip = match error.kind() {
        ErrorKind::UnknownArgument => {
            tip_for_part(&error).or_else(|| tip_for_inputs(&error, words))
        }
        ErrorKind::InvalidValue => tip_for_caps(&error),
        ErrorKind::ArgumentConflict => tip_for_site(&error),
        _ => None,
    };
    if let Some(tip) = tip {
        error.remove(ContextKind::SuggestedArg);
        error.remove(ContextKind::SuggestedValue);
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
    }
    error
}

fn text_of(error: &clap::Error, kind: ContextKind) -> String {
    error.get(kind).map(ToString::to_string).unwrap_or_default()
}

/// For an unknown option that is one for a part of the data in other programs, of a command that can convert a part. Its value is written in
/// another way, so ours have no such names themselves.
fn tip_for_part(error: &clap::Error) -> Option<String> {
    let option = text_of(error, ContextKind::InvalidArg);
    let usage = text_of(error, ContextKind::Usage);
    let name = option.split('=').next().unwrap_or_default();
    let has_parts =
        ["corniche build ", "corniche plan "].iter().any(|command| usage.contains(command));
    (has_parts && NAMES_OF_PARTS.contains(&name))
        .then(|| "use --bounds W,S,E,N or --polygon FILE".to_owned())
}

/// Options by the endings of the files that they take, in lower case; the first that a command has counts.
const OPTIONS_BY_ENDING: [(&str, &[&str]); 7] = [
    ("osm", &[".pbf", ".osm", ".osm.gz", ".osm.bz2", ".osm.xz", ".o5m"]),
    ("line", &[".gpx", ".kml", ".geojson", ".shp"]),
    ("polygon", &[".geojson", ".kml", ".shp", ".poly"]),
    ("output", &[".pmtiles", ".gpkg", ".fgb", ".geojson", ".csv", ".png", ".glb", ".gltf", ".svg"]),
    (
        "dem",
        &[
            ".tif", ".tiff", ".hgt", ".asc", ".vrt", ".img", ".dem", ".dt0", ".dt1", ".dt2",
            ".bil", ".flt", ".zip",
        ],
    ),
    ("config", &[".toml"]),
    ("photo", &[".jpg", ".jp2"]),
];

/// For files where a command takes none: its options, by what the files are by their names.
fn tip_for_inputs(error: &clap::Error, words: &[OsString]) -> Option<String> {
    let first = text_of(error, ContextKind::InvalidArg);
    if first.starts_with('-') {
        return None;
    }
    let usage = text_of(error, ContextKind::Usage);
    let names = usage.split_once("corniche ")?.1.split_whitespace();
    let mut names = names.take_while(|name| name.starts_with(|c: char| c.is_ascii_alphanumeric()));
    let program = Arguments::command();
    let command = names.try_fold(&program, |command, name| command.find_subcommand(name))?;
    let has = |option: &str| command.get_arguments().any(|arg| arg.get_long() == Some(option));
    let words: Vec<_> = words.iter().map(|word| word.to_string_lossy()).collect();
    let is_given = |option: &str| {
        words.iter().any(|word| {
            let name = word.split('=').next().unwrap_or_default();
            (option, name) == ("output", "-o") || name.strip_prefix("--") == Some(option)
        })
    };
    let option_of = |file: &str| -> Option<&str> {
        // A number is half of a place that was written with a space.
        if file.parse::<f64>().is_ok() {
            return None;
        }
        let name = file.to_lowercase();
        let is_for = |endings: &[&str]| endings.iter().any(|ending| name.ends_with(ending));
        let mut fitting = OPTIONS_BY_ENDING.iter().filter(|(option, endings)| {
            has(option) && is_for(endings) && !(*option == "output" && is_given(option))
        });
        // A raster is what this one writes, unless that is named.
        let writes_rasters = command.get_name() == "geotiff" && !is_given("output");
        let found = fitting.next().map(|(option, _)| *option);
        let other = ["dem", "output"].into_iter().find(|option| has(option) && !is_given(option));
        // What is not there is what is to be written, rather than a polygon.
        let is_missing = has("output") && !is_given("output") && !Path::new(file).exists();
        match found {
            Some("dem") if writes_rasters => Some("output"),
            Some("polygon") if is_missing => Some("output"),
            _ => found.or(other),
        }
    };
    let mut tip: Vec<(&str, Vec<String>)> = Vec::new();
    for file in files_in(command, words.iter().skip_while(|word| **word != first)) {
        let Some(option) = option_of(file) else { continue };
        let file =
            if file.contains(char::is_whitespace) { format!("'{file}'") } else { file.to_owned() };
        match tip.iter_mut().find(|(own, _)| *own == option) {
            Some((_, files)) => files.push(file),
            None => tip.push((option, vec![file])),
        }
    }
    let named = tip.iter().map(|(option, files)| format!("--{option} {}", files.join(" ")));
    let named = named.collect::<Vec<_>>().join(" ");
    (!named.is_empty()).then(|| format!("files are named by options: {named}"))
}

/// The words that are neither options of a command nor their values.
fn files_in<'a>(
    command: &clap::Command,
    words: impl Iterator<Item = &'a std::borrow::Cow<'a, str>>,
) -> Vec<&'a str> {
    let mut values = 0;
    let mut files = Vec::new();
    for word in words {
        if let Some(name) = word.strip_prefix('-').filter(|name| !name.is_empty()) {
            let arg = command.get_arguments().find(|arg| match name.strip_prefix('-') {
                Some(long) => arg.get_long() == Some(long),
                None => arg.get_short().is_some_and(|short| name == short.to_string()),
            });
            let takes = |arg: &clap::Arg| {
                let most = arg.get_num_args().map_or(1, |range| range.max_values());
                if arg.get_action().takes_values() { most } else { 0 }
            };
            values = arg.map_or(0, takes);
        } else if values > 0 {
            values -= 1;
        } else {
            files.push(word.as_ref());
        }
    }
    files
}

/// For a method without caps, which `fly` alone has, of a command that has the method itself.
fn tip_for_caps(error: &clap::Error) -> Option<String> {
    let value = text_of(error, ContextKind::InvalidValue);
    let method =
        value.strip_suffix("-no-caps").filter(|_| ROADS.iter().any(|(word, ..)| *word == value))?;
    let valid = text_of(error, ContextKind::ValidValue);
    let has_method = valid.split(", ").any(|valid| valid == method);
    has_method.then(|| format!("write --roads {method} --caps none; {value} is for fly alone"))
}

/// For an address or a port together with a site, which no server of ours serves.
fn tip_for_site(error: &clap::Error) -> Option<String> {
    let both = [ContextKind::InvalidArg, ContextKind::PriorArg].map(|kind| text_of(error, kind));
    both.iter().any(|option| option.starts_with("--site")).then(|| {
        "--site writes files for another web server and listens nowhere; leave --port and --address out, or leave --site out to \
         serve the packages"
            .to_owned()
    })
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Build a tile package from elevation rasters and an OpenStreetMap extract
    Build(Box<BuildArgs>),
    /// Tell what a build will make and what it will take, and write its plan
    Plan(Box<PlanArgs>),
    /// List the parts of a planned build for so many processes, one JSON object per line
    Jobs(JobsArgs),
    /// Make one part of a planned build; prints the path of its file
    Part(PartArgs),
    /// Write the package of a plan from all its parts
    Merge(MergeArgs),
    /// Tell what a package holds and what became of its inputs
    Info(InfoArgs),
    /// Tell what laying roads on the terrain costs, per level and class
    Growth(GrowthArgs),
    /// Tell height and grade along roads
    Profile(ProfileArgs),
    /// Tell how far roads lie beside what a photo or the slope of the ground shows of them
    Match(MatchArgs),
    /// Check every promise a package makes; exits with 1 when one is broken
    Verify(VerifyArgs),
    /// Dump one decoded tile
    Tile(TileArgs),
    /// Give what a package holds to other programs
    #[command(subcommand)]
    Export(Export),
    /// Draw a package to a PNG, without a window
    Render(RenderArgs),
    /// Fly over a package and tell what each frame costs; needs no window
    Fly(FlyArgs),
    /// Open a window on a package
    View(ViewArgs),
    /// Show packages in web browsers: a small web server with a page, or the files for one
    Serve(ServeArgs),
    /// Print a script that completes this command's names and options in a shell
    Completions(CompletionsArgs),
    /// Write manual pages, one for the program and one for each command
    Man(ManArgs),
}

impl Command {
    /// Whether it may ask for a graphics card.
    pub(crate) fn draws(&self) -> bool {
        matches!(self, Self::Render(_) | Self::Fly(_) | Self::View(_))
    }
}

#[cfg(test)]
#[path = "args_tests.rs"]
mod tests;
