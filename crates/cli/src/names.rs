//! Names of files that commands write.

use std::path::Path;

use corniche_presets::Words;

use crate::failure::Result;

/// Rejects names that the user does not mean as a file.
pub(crate) fn refuse_what_is_no_file(target: &Path) -> Result<()> {
    let name = target.as_os_str();
    if name == "-" {
        refuse!(
            "cannot write to standard output (-): the output is moved to its target when it is complete; pass the name \
             of a file (./- for a file with this name)"
        );
    }
    if name.to_str().is_some_and(|name| name.contains("://")) {
        refuse!(
            "cannot write {target:?}: this command does not write to URLs; pass the name of a file (corniche merge also writes \
             packages to s3://BUCKET/NAME.pmtiles)"
        );
    }
    Ok(())
}

/// Rejects a name of a package that does not end in .pmtiles.
pub(crate) fn refuse_other_than_package(target: &Path) -> Result<()> {
    if is_package_name(target) {
        return Ok(());
    }
    // MBTiles is the other format for tiles in one file.
    let whole = if target.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mbtiles")) {
        target.with_extension("pmtiles")
    } else {
        target.with_added_extension("pmtiles")
    };
    Err(unusable!(
        "cannot write {target:?}: a package must have the extension .pmtiles; choose a name such as {whole:?}"
    ))
}

/// The named format, or the one of the file extension, in any case. The words of `formats` are
/// their extensions.
pub(crate) fn format_of<T: Copy, const N: usize>(
    named: Option<T>,
    output: &Path,
    formats: &Words<T, N>,
) -> Result<T> {
    let ending = output.extension().unwrap_or_default();
    let own = formats.iter().find(|(word, ..)| ending.eq_ignore_ascii_case(word));
    named.or(own.map(|(.., format)| *format)).ok_or_else(|| {
        let endings = formats.each_ref().map(|(word, ..)| format!(".{word}")).join(", ");
        unusable!(
            "cannot write {output:?}: its extension does not name a format; choose one of {endings}, or pass --format"
        )
    })
}

/// The name of a file without its folders.
pub(crate) fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Whether a name has the extension of packages.
pub(crate) fn is_package_name(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("pmtiles"))
}

/// A format with its extensions; a name with another extension is a mistake.
pub(crate) struct Format {
    /// The format in a message.
    what: &'static str,
    /// The extensions, the usual one first.
    endings: &'static [&'static str],
}

/// The format of images.
pub(crate) const PICTURE: Format = Format { what: "images are PNG", endings: &["png"] };
/// The format of georeferenced images.
pub(crate) const MAP: Format = Format { what: "maps are GeoTIFF", endings: &["tif", "tiff"] };
/// The format of charts.
pub(crate) const CHART: Format = Format { what: "charts are SVG", endings: &["svg"] };

impl Format {
    /// Whether a name has an extension of this format.
    pub(crate) fn is_of(&self, path: &Path) -> bool {
        let extension = path.extension().unwrap_or_default();
        self.endings.iter().any(|ending| extension.eq_ignore_ascii_case(ending))
    }

    /// Rejects a name with another extension.
    pub(crate) fn refuse_others(&self, path: &Path) -> Result<()> {
        if self.is_of(path) {
            return Ok(());
        }
        let Self { what, endings } = self;
        Err(unusable!(
            "cannot write {path:?}: {what}; choose a name with the extension .{}",
            endings[0]
        ))
    }
}
