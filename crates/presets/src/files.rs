//! Files that a settings file names.

use std::path::PathBuf;

use serde::{Deserialize, Deserializer};

/// What is read: the section `[inputs]`.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct InputFiles {
    /// `--dem`: a list, or one alone.
    #[serde(deserialize_with = "one_or_many")]
    pub dem: Vec<PathBuf>,
    /// `--terrain`.
    pub terrain: Option<PathBuf>,
    /// `--osm`: a list, or one alone.
    #[serde(deserialize_with = "one_or_many")]
    pub osm: Vec<PathBuf>,
    /// `--polygon`.
    pub polygon: Option<PathBuf>,
    /// `--photo`: a list, or one alone.
    #[serde(deserialize_with = "one_or_many")]
    pub photo: Vec<PathBuf>,
}

impl InputFiles {
    /// These files; those that are not given are taken from `other`. Rasters and a package with terrain are two ways to give one thing:
    /// if one of them is given here, neither is taken from `other`.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        let (dem, terrain) = if self.dem.is_empty() && self.terrain.is_none() {
            (other.dem, other.terrain)
        } else {
            (self.dem, self.terrain)
        };
        let polygon = self.polygon.or(other.polygon);
        let osm = if self.osm.is_empty() { other.osm } else { self.osm };
        let photo = if self.photo.is_empty() { other.photo } else { self.photo };
        Self { dem, terrain, osm, polygon, photo }
    }
}

/// What is written: the section `[output]`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct OutputFiles {
    /// `--output`.
    pub package: Option<PathBuf>,
    /// `--defects`.
    pub defects: Option<PathBuf>,
}

fn one_or_many<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<PathBuf>, D::Error> {
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
