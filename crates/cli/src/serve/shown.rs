//! The packages that a page shows, and their names there.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
};

use corniche_remote::PackagePlace;
use corniche_viewer::{DrawError, ShownLayers};
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use serde::Serialize;

use crate::{
    documents::to_line,
    failure::{CommandFailure, Result},
    packages,
};

/// The list of packages that the page reads.
pub(crate) const LIST: &str = "packages.json";

/// Characters that are percent-encoded in URLs.
const ENCODED: &AsciiSet = &NON_ALPHANUMERIC.remove(b'-').remove(b'_').remove(b'.').remove(b'~');

/// A package that a page shows.
#[derive(Debug)]
pub(crate) struct Shown {
    /// Its name: the file name without the extension, with a number if several packages have the
    /// same name.
    pub name: String,
    /// The file.
    pub file: PathBuf,
    /// The layers that the page shows at first, as they were passed.
    pub layers: Option<String>,
}

impl Shown {
    /// Its path, relative to the page.
    pub(crate) fn path(&self) -> String {
        format!("packages/{}.pmtiles", self.name)
    }
}

/// An entry of the list.
#[derive(Serialize)]
struct ShownEntry<'a> {
    name: &'a str,
    /// The URL, relative to that of the page.
    src: String,
    /// The layers that the page shows at first; without them, all.
    #[serde(skip_serializing_if = "Option::is_none")]
    layers: Option<&'a str>,
}

/// Opens each package, so that invalid ones are reported before the server starts, and assigns
/// names. Each package must have the layers that are shown at first.
pub(crate) fn open(places: &[PackagePlace], layers: Option<&str>) -> Result<Vec<Shown>> {
    let wanted = layers.map_or(ShownLayers::ALL, ShownLayers::from_list);
    let file = |place: &PackagePlace| match place {
        PackagePlace::File(path) => {
            let package = packages::open(place)?;
            let known = wanted.check(package.manifest());
            known.map_err(|error| CommandFailure::from(DrawError::from(error)).about(path))?;
            Ok(path.clone())
        }
        PackagePlace::Address(_) => Err(unusable!(
            "{:?} is already on a web server, but serve accepts only files; to show it, append ?src=ADDRESS to the address of the page",
            place.name()
        )),
    };
    let files: Vec<PathBuf> = places.iter().map(file).collect::<Result<_, _>>()?;
    let names = names(&files);
    let layers = layers.map(str::to_owned);
    let shown = |(name, file)| Shown { name, file, layers: layers.clone() };
    Ok(names.into_iter().zip(files).map(shown).collect())
}

/// A unique name for each file, also if case is ignored.
fn names(files: &[PathBuf]) -> Vec<String> {
    let own = |file: &Path| file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    // A file whose name already ends in such a number keeps its name.
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

/// The list in the format that the page reads.
pub(crate) fn list(shown: &[Shown]) -> String {
    let entries: Vec<ShownEntry<'_>> = shown
        .iter()
        .map(|Shown { name, layers, .. }| {
            let src = format!("packages/{}.pmtiles", utf8_percent_encode(name, ENCODED));
            ShownEntry { name, src, layers: layers.as_deref() }
        })
        .collect();
    format!("{}\n", to_line(&entries))
}

#[cfg(test)]
#[path = "shown_tests.rs"]
mod tests;
