//! Names of files that commands write.

use std::path::Path;

use corniche_presets::Words;

use crate::failure::Failure;

/// Refuses names that mean something else than a file to whoever gives them.
pub(crate) fn refuse_what_is_no_file(target: &Path) -> Result<(), Failure> {
    let name = target.as_os_str();
    if name == "-" {
        return Err(Failure::unusable(
            "cannot write -: what is written takes its place when it is complete, so it cannot go to standard output; give the name \
             of a file (./- if it is really called so)",
        ));
    }
    if name.to_str().is_some_and(|name| name.contains("://")) {
        return Err(Failure::unusable(format!(
            "cannot write {}: it is an address, and this is written to files; give the name of a file (corniche merge writes \
             packages to s3://BUCKET/NAME.pmtiles, too)",
            target.display()
        )));
    }
    Ok(())
}

/// Refuses a name of a package that does not end in .pmtiles.
pub(crate) fn refuse_other_than_package(target: &Path) -> Result<(), Failure> {
    if is_package_name(target) {
        return Ok(());
    }
    // The other format for tiles in one file.
    let whole = if target.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mbtiles")) {
        target.with_extension("pmtiles")
    } else {
        target.with_added_extension("pmtiles")
    };
    Err(Failure::unusable(format!(
        "cannot write {}: the name of a package ends in .pmtiles; write it like {}",
        target.display(),
        whole.display()
    )))
}

/// The format that is named, or that of the ending, in capitals or not. The words of `formats` are their endings.
pub(crate) fn format_of<T: Copy, const N: usize>(
    named: Option<T>,
    output: &Path,
    formats: &Words<T, N>,
) -> Result<T, Failure> {
    let ending = output.extension().unwrap_or_default();
    let own = formats.iter().find(|(word, ..)| ending.eq_ignore_ascii_case(word));
    named.or(own.map(|(.., format)| *format)).ok_or_else(|| {
        let endings = formats.each_ref().map(|(word, ..)| format!(".{word}")).join(", ");
        Failure::unusable(format!(
            "the ending of {} says no format; use one of {endings}, or name it with --format",
            output.display()
        ))
    })
}

/// The name of a file without its folders.
pub(crate) fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Whether a name ends as those of packages do.
pub(crate) fn is_package_name(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("pmtiles"))
}

/// What has one format, so that a name with the ending of another one is a mistake.
pub(crate) struct Format {
    /// What it is in a message.
    what: &'static str,
    /// The endings of its names, the usual one first.
    endings: &'static [&'static str],
}

/// A picture.
pub(crate) const PICTURE: Format = Format { what: "pictures are PNG", endings: &["png"] };
/// A picture that knows its place.
pub(crate) const MAP: Format = Format { what: "maps are GeoTIFF", endings: &["tif", "tiff"] };
/// A chart.
pub(crate) const CHART: Format = Format { what: "charts are SVG", endings: &["svg"] };

impl Format {
    /// Whether a name has an ending of this format.
    pub(crate) fn is_of(&self, path: &Path) -> bool {
        let extension = path.extension().unwrap_or_default();
        self.endings.iter().any(|ending| extension.eq_ignore_ascii_case(ending))
    }

    /// Refuses a name that ends as that of another format.
    pub(crate) fn refuse_others(&self, path: &Path) -> Result<(), Failure> {
        if self.is_of(path) {
            return Ok(());
        }
        let Self { what, endings } = self;
        Err(Failure::unusable(format!(
            "cannot write {}: {what}; give a name that ends in .{}",
            path.display(),
            endings[0]
        )))
    }
}
