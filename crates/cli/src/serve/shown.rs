//! The packages that a page shows, and what they are called there.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
};

use corniche_remote::PackagePlace;
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use serde::Serialize;

use crate::{documents::to_line, failure::Failure, packages};

/// The list of packages, which the page reads.
pub(crate) const LIST: &str = "packages.json";

/// What may stand in an address as it is.
const ENCODED: &AsciiSet = &NON_ALPHANUMERIC.remove(b'-').remove(b'_').remove(b'.').remove(b'~');

/// A package that a page shows.
#[derive(Debug)]
pub(crate) struct Shown {
    /// What it is called: its file's name without the ending, with a number if others are called so.
    pub(crate) name: String,
    /// Its file.
    pub(crate) file: PathBuf,
}

impl Shown {
    /// Its path below the page.
    pub(crate) fn path(&self) -> String {
        format!("packages/{}.pmtiles", self.name)
    }
}

/// A line of the list.
#[derive(Serialize)]
struct Entry<'a> {
    name: &'a str,
    /// An address, from that of the page on.
    src: String,
}

/// Opens each package, so that what is no package is told before anyone looks at it, and names them.
pub(crate) fn open(places: &[PackagePlace]) -> Result<Vec<Shown>, Failure> {
    let file = |place: &PackagePlace| match place {
        PackagePlace::File(path) => {
            packages::open(place)?;
            Ok(path.clone())
        }
        PackagePlace::Address(_) => Err(Failure::unusable(format!(
            "{place} is on a web server already; serve shows files. The page shows a package of another server by its address: \
             ?src=ADDRESS behind the page's own"
        ))),
    };
    let files: Vec<PathBuf> = places.iter().map(file).collect::<Result<_, _>>()?;
    let names = names(&files);
    Ok(names.into_iter().zip(files).map(|(name, file)| Shown { name, file }).collect())
}

/// One name for each file, none twice, also where capital and small letters are not told apart.
fn names(files: &[PathBuf]) -> Vec<String> {
    let own = |file: &Path| file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    // A file that is called like another one with a number keeps its name.
    let mut taken: BTreeSet<String> = files.iter().map(|file| own(file).to_lowercase()).collect();
    let mut given = BTreeSet::new();
    let name = |file: &PathBuf| {
        let own = own(file);
        if given.insert(own.to_lowercase()) {
            return own;
        }
        let numbered = (2..).map(|number: u64| format!("{own}-{number}"));
        let free = numbered.into_iter().find(|name| taken.insert(name.to_lowercase()));
        free.unwrap_or(own)
    };
    files.iter().map(name).collect()
}

/// The list as the page reads it.
pub(crate) fn list(shown: &[Shown]) -> String {
    let entries: Vec<Entry<'_>> = shown
        .iter()
        .map(|Shown { name, .. }| {
            let src = format!("packages/{}.pmtiles", utf8_percent_encode(name, ENCODED));
            Entry { name, src }
        })
        .collect();
    format!("{}\n", to_line(&entries))
}

#[cfg(test)]
#[path = "shown_tests.rs"]
mod tests;
