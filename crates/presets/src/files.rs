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

/// The names of files or of layers: a list, or a single name.
pub(crate) fn one_or_many_names<'de, D: Deserializer<'de>, T: Deserialize<'de>>(
    deserializer: D,
) -> Result<Vec<T>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "expected a name or a list of names")]
    enum OneOrMany<T> {
        One(T),
        Many(Vec<T>),
    }
    Ok(match OneOrMany::deserialize(deserializer)? {
        OneOrMany::One(path) => vec![path],
        OneOrMany::Many(paths) => paths,
    })
}
