//! The command line: all commands and their options.

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
    Export, ExportEdgesArgs, ExportGeoTiffArgs, ExportLayerArgs, ExportMeshArgs,
    ExportQuantizedMeshArgs, ExportRoadsArgs, ExportTiles3dArgs, MODEL_FORMATS, VECTOR_FORMATS,
    VectorArgs,
};
pub(crate) use growth::GrowthArgs;
pub(crate) use look::{LookArgs, OUTLINES, ROADS, Roads, WIDTH_GROWTHS};
pub(crate) use matching::MatchArgs;
#[cfg(test)]
pub(crate) use overlay::parse as overlay;
pub(crate) use overlay::{OverlayArg, styled as with_overlays};
pub(crate) use part::{JobsArgs, MergeArgs, PartArgs, plan_and_stores};
pub(crate) use profile::ProfileArgs;
pub(crate) use reading::{DumpCoordinates, InfoArgs, TileArgs, VerifyArgs};
pub(crate) use serve::ServeArgs;
pub(crate) use shared::{
    DatumArg, ExtractArgs, FileArgs, FolderArgs, PackageArg, RecordedArgs, ThreadsArg,
};
pub(crate) use shell::{CompletionsArgs, LayersArgs, ManArgs};
pub(crate) use values::{package_among, word_of};
pub(crate) use view::ViewArgs;
pub(crate) use voice::{LogFormat, Voice};

use self::voice::JSON_PROGRESS;
use crate::escaped::one_line;

/// Create terrain tiles with roads exactly on them, from a DEM and OpenStreetMap extracts.
#[derive(Debug, Parser)]
#[command(version, name = "corniche", max_term_width = 100)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub command: CliCommand,
    /// The name of the command.
    #[arg(skip)]
    pub name: String,
    /// How the program writes its messages.
    #[command(flatten)]
    pub voice: Voice,
    /// Exit with code 1 when stdin closes, so that the process does not outlive its parent. For
    /// programs that start this one with a pipe as its stdin. Rerun the same part or merge to
    /// resume
    #[arg(long, global = true, help_heading = "For programs")]
    pub die_with_parent: bool,
}

impl Arguments {
    /// Parses and checks the command line.
    ///
    /// # Errors
    /// When the command line is invalid; also when it requests the help or the version.
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
        // clap does not detect conflicts between options before and after the command's name.
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

/// Rewrites an error so that the words of the command line in it are escaped with [`one_line`]: no
/// word can then be mistaken for a line of ours. The escaped words are parsed again, and their
/// error is returned.
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
        // The escaped words are valid.
        let said = error.to_string();
        let said = said.trim_start_matches("error: ").trim_end();
        Arguments::command().error(error.kind(), one_line(said))
    })
}

/// Whether `--json-progress` is given, to this command or to its subcommand.
fn has_json_progress(matches: &ArgMatches) -> bool {
    match matches.subcommand() {
        Some((_, below)) => has_json_progress(below),
        None => matches!(matches.try_get_one(JSON_PROGRESS), Ok(Some(true))),
    }
}

/// Names that other programs give to the option for a part of the data.
const NAMES_OF_PARTS: [&str; 3] = ["--bbox", "--clip", "--cutline"];

/// Adds a tip to an error: what to write instead, where this is known.
fn with_tip(mut error: clap::Error, words: &[OsString]) -> clap::Error {
    let tip = match error.kind() {
        ErrorKind::MissingRequiredArgument => return needs(&error).unwrap_or(error),
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

/// The error for missing arguments as a sentence with advice.
fn needs(error: &clap::Error) -> Option<clap::Error> {
    let usage = text_of(error, ContextKind::Usage);
    let Some(ContextValue::Strings(missing)) = error.get(ContextKind::InvalidArg) else {
        return None;
    };
    let words = usage.split_once("corniche ")?.1.split_whitespace();
    let name = words.take_while(|word| word.starts_with(|c: char| c.is_ascii_alphanumeric()));
    let name = name.collect::<Vec<_>>().join(" ");
    let option = |word: &String| match word.strip_prefix("<--") {
        // A choice is written as <--one|--other>.
        Some(choice) => {
            format!("--{}", choice.strip_suffix('>').unwrap_or(choice)).replace("|--", " or --")
        }
        // Options that other arguments replace or require.
        None if word == "<Z/X/Y>" => format!("{word} or --at <LON,LAT>"),
        None => word.clone(),
    };
    let in_brackets = |words: String| {
        if words.contains(" or ") && missing.len() > 1 { format!("({words})") } else { words }
    };
    let pass = missing.iter().map(option).map(in_brackets).collect::<Vec<_>>().join(" and ");
    let pass = pass.replace("--from <LON,LAT>", "--from <LON,LAT> --to <LON,LAT>");
    let text = format!(
        "corniche {name} needs more arguments; pass {pass}\n\n{usage}\n\nFor more information, try '--help'.\n"
    );
    Some(clap::Error::raw(error.kind(), text))
}

fn text_of(error: &clap::Error, kind: ContextKind) -> String {
    error.get(kind).map(ToString::to_string).unwrap_or_default()
}

/// A tip for an unknown option that selects a part of the data in other programs, in commands that
/// can convert a part. Our options have other names because their values have another format.
fn tip_for_part(error: &clap::Error) -> Option<String> {
    let option = text_of(error, ContextKind::InvalidArg);
    let usage = text_of(error, ContextKind::Usage);
    let name = option.split('=').next().unwrap_or_default();
    let has_parts =
        ["corniche build ", "corniche plan "].iter().any(|command| usage.contains(command));
    (has_parts && NAMES_OF_PARTS.contains(&name))
        .then(|| "use --bounds W,S,E,N or --polygon FILE".to_owned())
}

/// Options by the file extensions that they accept, in lower case. The first option that the
/// command has is used.
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

/// A tip for files where the command expects none: the options for them, judged by their
/// extensions.
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
        // A number is half of a position that was written with a space.
        if file.parse::<f64>().is_ok() {
            return None;
        }
        let name = file.to_lowercase();
        let is_for = |endings: &[&str]| endings.iter().any(|ending| name.ends_with(ending));
        let mut fitting = OPTIONS_BY_ENDING.iter().filter(|(option, endings)| {
            has(option) && is_for(endings) && !(*option == "output" && is_given(option))
        });
        // A raster is the output of this command, unless the output is named.
        let writes_rasters = command.get_name() == "geotiff" && !is_given("output");
        let found = fitting.next().map(|(option, _)| *option);
        let other = ["dem", "output"].into_iter().find(|option| has(option) && !is_given(option));
        // A missing file is more likely to be the output than a polygon.
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
    (!named.is_empty()).then(|| format!("files are passed with options: {named}"))
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

/// A tip for a method without caps, which only `fly` accepts, in a command that has the method
/// itself.
fn tip_for_caps(error: &clap::Error) -> Option<String> {
    let value = text_of(error, ContextKind::InvalidValue);
    let method =
        value.strip_suffix("-no-caps").filter(|_| ROADS.iter().any(|(word, ..)| *word == value))?;
    let valid = text_of(error, ContextKind::ValidValue);
    let has_method = valid.split(", ").any(|valid| valid == method);
    has_method.then(|| format!("write --roads {method} --caps none; only fly accepts {value}"))
}

/// A tip for an address or a port together with `--site`, which starts no server.
fn tip_for_site(error: &clap::Error) -> Option<String> {
    let both = [ContextKind::InvalidArg, ContextKind::PriorArg].map(|kind| text_of(error, kind));
    both.iter().any(|option| option.starts_with("--site")).then(|| {
        "--site writes files for another web server and starts no server itself; omit --port and --address, or omit --site to \
         serve the packages"
            .to_owned()
    })
}

#[derive(Debug, Subcommand)]
pub(crate) enum CliCommand {
    /// Build a tile package from a DEM (elevation files) and an OpenStreetMap extract
    Build(Box<BuildArgs>),
    /// Estimate what a build will produce and need, and write its plan
    Plan(Box<PlanArgs>),
    /// List the parts of a planned build for a number of processes, one JSON object per line
    Jobs(JobsArgs),
    /// Compute one part of a planned build and print the path of its file
    Part(PartArgs),
    /// Merge all parts of a plan into its package
    Merge(MergeArgs),
    /// Print what a package contains and what became of its inputs
    Info(InfoArgs),
    /// Report the cost of draping roads on the terrain (growth: the vertices that clipping adds),
    /// per level and class
    Growth(GrowthArgs),
    /// Print height and grade along roads
    Profile(ProfileArgs),
    /// Measure how far roads are offset from the road visible in a photo or in the terrain's slope
    Match(MatchArgs),
    /// Check every promise that a package makes; exits with 1 if one is broken
    Verify(VerifyArgs),
    /// Dump one decoded tile
    Tile(TileArgs),
    /// Export a package to other formats
    #[command(subcommand)]
    Export(Export),
    /// List the built-in layers, print or check the table of a layer, or print the tables' JSON
    /// schema
    Layers(LayersArgs),
    /// Render a package to a PNG, without a window
    Render(RenderArgs),
    /// Fly over a package and measure the cost of each frame; needs no window
    Fly(FlyArgs),
    /// Open a package in a window
    View(ViewArgs),
    /// Show packages in web browsers: start a small web server with a page, or write the files for
    /// another server
    Serve(ServeArgs),
    /// Print a shell completion script for the commands and options
    Completions(CompletionsArgs),
    /// Write manual pages, one for the program and one for each command
    Man(ManArgs),
}

impl CliCommand {
    /// Whether the command may need a GPU.
    pub(crate) fn draws(&self) -> bool {
        matches!(self, Self::Render(_) | Self::Fly(_) | Self::View(_))
    }
}

#[cfg(test)]
#[path = "args_tests.rs"]
mod tests;
