//! `corniche man`: writes manual pages to a folder.

use std::{
    fs,
    path::{Path, PathBuf},
};

use clap::{Command, CommandFactory as _};
use clap_mangen::Man;

use crate::{
    args::{Arguments, ManArgs},
    failure::Result,
    output::{Complete, Output, existing_of},
};

pub(crate) fn run(args: &ManArgs) -> Result<()> {
    let folder = &args.folder;
    fs::create_dir_all(folder)
        .map_err(|error| unusable!("cannot create the folder {folder:?}: {error}"))?;
    let pages = pages()?;
    // All paths are checked before anything is written, and all pages are written before the first
    // is moved to its target.
    let existing = existing_of(args.overwrite);
    let place = |(name, _): &(PathBuf, Vec<u8>)| Output::create(&folder.join(name), existing, &[]);
    let places: Vec<Output> = pages.iter().map(place).collect::<Result<_, _>>()?;
    let written: Vec<Complete> = places
        .into_iter()
        .zip(&pages)
        .map(|(place, (_, page))| place.fill(page))
        .collect::<Result<_, _>>()?;
    let count = written.len();
    written.into_iter().try_for_each(Complete::place)?;
    note!("wrote {count} pages to {}", folder.display());
    Ok(())
}

/// The pages of the program, its commands and their subcommands, with their file names.
fn pages() -> Result<Vec<(PathBuf, Vec<u8>)>> {
    let mut program = Arguments::command().disable_help_subcommand(true);
    program.build();
    let mut commands = vec![program];
    let mut next = 0;
    while let Some(command) = commands.get(next) {
        let parts = command
            .get_subcommands()
            .filter(|part| !part.is_hide_set() && part.get_name() != "help");
        let parts: Vec<Command> = parts.cloned().collect();
        commands.extend(parts);
        next += 1;
    }
    commands
        .into_iter()
        .map(|command| {
            // A page has space for the options that the short help hides.
            let command = command.mut_args(|arg| arg.hide_short_help(false));
            let man = Man::new(command).manual("Corniche");
            let mut page = Vec::new();
            man.render(&mut page)?;
            Ok((Path::new(&man.get_filename()).to_owned(), page))
        })
        .collect()
}
