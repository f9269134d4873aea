//! The options of a build, for the command line and for settings files, declared with
//! [`corniche_settings::settings!`].

use std::{collections::BTreeMap, num::NonZeroUsize, path::PathBuf};

use clap::Args;
use corniche_geom::Cell;
use corniche_settings::ReliefLevels;
use serde::{Deserialize, Deserializer, de::Error};

use crate::{
    BoundsChoice, Classes, PresetError,
    error::bounded,
    files::{OutputFiles, one_or_many_names},
    values::{
        RELIEF, check_cells, check_height_range, check_max_error, check_nodata, check_simplify,
        either, one_of, parse_cell, parse_range,
    },
};

/// The contents of a settings file: the options of the command line, by section. Defaults of
/// missing options are not decided here.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Config {
    /// `[inputs]`
    pub inputs: InputFiles,
    /// `[output]`
    pub output: OutputFiles,
    /// `[terrain]`
    pub terrain: TerrainOptions,
    /// `[roads]`
    pub roads: RoadOptions,
    /// `[layers]`
    pub layers: LayerOptions,
    /// `[photo]`
    pub photo: PhotoOptions,
    /// `[resources]`
    pub resources: ResourceOptions,
}

impl Config {
    /// Parses a settings file. Unknown sections and names are rejected.
    ///
    /// # Errors
    /// When the text is not TOML, or has something that is not a setting.
    pub fn parse(text: &str) -> Result<Self, PresetError> {
        Ok(toml::from_str(bounded(text)?)?)
    }
}

/// Whether an option is given.
fn is_given<T: Default + PartialEq>(option: &T) -> bool {
    *option != T::default()
}

macro_rules! options {
    (
        ()
        $(
            $section:ident($options:ident $(, $heading:literal)?) {
                $(
                    $(#[$($attr:tt)*])*
                    $name:ident: $type:ty
                    $(, check $check:ident)? $(, rival $rival:ident)? $(=> $record:tt)?;
                )*
            } and $other:tt
        )*
    ) => {
        $(
            #[derive(Debug, Clone, PartialEq, Default, Args, Deserialize)]
            #[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
            $(#[command(next_help_heading = $heading)])?
            #[expect(missing_docs, reason = "clap would take it for the description of the command")]
            pub struct $options {
                $($(#[$($attr)*])* pub $name: $type,)*
            }

            impl $options {
                /// These options; missing ones are filled in from `other`.
                #[must_use]
                pub fn or(mut self, other: Self) -> Self {
                    let own = self.clone();
                    $(
                        if !(is_given(&own.$name) $(|| is_given(&own.$rival))?) {
                            self.$name = other.$name;
                        }
                    )*
                    self
                }

                /// Rejects invalid values.
                ///
                /// # Errors
                /// The first invalid value, with the reason.
                pub fn check(&self) -> Result<(), String> {
                    $($($check(self.$name.as_slice())?;)?)*
                    Ok(())
                }
            }
        )*
    };
}

corniche_settings::settings! { [options] () }

/// A list of numbers, or a single number; an empty list gives nothing.
fn one_or_many<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Vec<f64>>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "expected a number or a list of numbers")]
    enum OneOrMany {
        One(f64),
        Many(Vec<f64>),
    }
    Ok(match OneOrMany::deserialize(deserializer)? {
        OneOrMany::One(value) => Some(vec![value]),
        OneOrMany::Many(values) => Some(values).filter(|values| !values.is_empty()),
    })
}

/// A cell, east and north: one number is the side of a square.
fn one_or_two<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Cell>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "expected a number or two of them, [east, north]")]
    enum Sides {
        Square(f64),
        Rectangle([f64; 2]),
    }
    Ok(Some(match Sides::deserialize(deserializer)? {
        Sides::Square(side_m) => side_m.into(),
        Sides::Rectangle(sides_m) => sides_m.into(),
    }))
}

/// The value of `structures`: whether there are spans.
fn ground_or_spans<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<bool>, D::Error> {
    let text = String::deserialize(deserializer)?;
    match ["ground", "spans"].iter().position(|word| *word == text) {
        Some(place) => Ok(Some(place == 1)),
        None => {
            Err(Error::custom(format!(r#"structures must be "ground" or "spans", not {text:?}"#)))
        }
    }
}

#[cfg(test)]
#[path = "build_options_tests.rs"]
mod tests;
