//! Files that a settings file names.

use std::path::PathBuf;

use serde::{Deserialize, Deserializer};

/// The output files: the section `[output]`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct OutputFiles {
    /// `--output`.
    pub package: Option<PathBuf>,
    /// `--defects`.
    pub defects: Option<PathBuf>,
}

/// The names of files: a list, or a single name.
pub(crate) fn one_or_many_names<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Vec<PathBuf>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "expected the name of a file or a list of names")]
    enum OneOrMany {
        One(PathBuf),
        Many(Vec<PathBuf>),
    }
    Ok(match OneOrMany::deserialize(deserializer)? {
        OneOrMany::One(path) => vec![path],
        OneOrMany::Many(paths) => paths,
    })
}
