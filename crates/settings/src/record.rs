//! The settings that determine the bytes of a package, as stored in its manifest.

use corniche_geom::Cell;
use corniche_roads::FunctionalRoadClass;
use serde::{Deserialize, Serialize, Serializer, ser::SerializeStruct as _};

use crate::{
    LayerTableRecord, MAX_MEASURE_M, PhotoRecord, PolygonRecord, ReliefLevels, SettingValue,
    table::KEYS_IN_ORDER,
};

/// A section of settings files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SettingSection {
    /// How the terrain is built.
    Terrain,
    /// Which roads a package has, and how exact they are.
    Roads,
    /// Which layers a package has.
    Layers,
    /// How photos are stored.
    Photo,
}

/// A setting in the form in which settings are compared.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SettingFact {
    /// The section of the setting.
    pub section: SettingSection,
    /// Its key in the manifest.
    pub key: &'static str,
    /// The name that users know, such as `--crs`.
    pub name: &'static str,
    /// Its value as text.
    pub value: String,
}

macro_rules! value_text {
    ($record:ident $key:ident) => {
        $record.$key.text()
    };
    ($record:ident $key:ident $text:ident) => {
        $text($record)
    };
}

macro_rules! record {
    ($($section:ident {
        $(#[$($attr:tt)*])*
        [$($flag:literal $(as $text:ident)?),*] $key:ident: $type:ty
        $(, left_out $left_out:literal)? $(, within $range:expr)?
        $(, at $($path:ident).+ $(, usual $usual:expr)?)?
    })*) => {
        /// Settings that determine the bytes of a package.
        #[derive(Debug, Clone, PartialEq, Default, Deserialize)]
        pub struct SettingsRecord {
            $(
                $(#[$($attr)*])*
                $(#[serde(default, skip_serializing_if = $left_out)])?
                pub $key: $type,
            )*
        }

        impl SettingsRecord {
            /// The facts to compare of each setting, in the order of the manifest.
            #[must_use]
            pub fn facts(&self) -> Vec<SettingFact> {
                let record = self;
                let mut facts = vec![$($(SettingFact {
                    section: SettingSection::$section,
                    key: stringify!($key),
                    name: $flag,
                    value: value_text!(record $key $($text)?),
                },)*)*];
                facts.sort_by_key(|fact| place(fact.key));
                facts
            }

            /// The first number that is not a valid setting, with its key.
            #[must_use]
            pub fn wrong_number(&self) -> Option<(&'static str, f64)> {
                $($(
                    let numbers = self.$key.numbers();
                    if let Some(wrong) = numbers.into_iter().find(|n| !($range).contains(n)) {
                        return Some((stringify!($key), wrong));
                    }
                )?)*
                None
            }

            /// The manifest's keys, in their order.
            #[must_use]
            pub fn keys() -> Vec<&'static str> {
                let mut keys = vec![$(stringify!($key)),*];
                keys.sort_by_key(|key| place(key));
                keys
            }

            /// Writes the settings with all keys in their order. Keys that are omitted at their
            /// default are written only if `always` has them.
            fn write<S: Serializer>(&self, to: S, always: &[&str]) -> Result<S::Ok, S::Error> {
                let mut keys = Self::keys();
                keys.retain(|key| match *key {
                    $(stringify!($key) => {
                        let is_left_out = [$($left_out)?].contains(&"is_default");
                        !is_left_out || always.contains(key) || !is_default(&self.$key)
                    })*
                    _ => false,
                });
                let mut state = to.serialize_struct("SettingsRecord", keys.len())?;
                for key in keys {
                    match key {
                        $(stringify!($key) => state.serialize_field(stringify!($key), &self.$key)?,)*
                        _ => {}
                    }
                }
                state.end()
            }
        }
    };
}

crate::recorded! { [record] }

/// The position of a key in the manifest.
fn place(key: &str) -> usize {
    KEYS_IN_ORDER.split(' ').position(|known| known == key).unwrap_or(usize::MAX)
}

/// Whether a value is that of packages without its key.
fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

impl Serialize for SettingsRecord {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.write(serializer, &[])
    }
}

impl SettingsRecord {
    /// Writes the settings as `corniche info --json` prints them: with their levels of relief even
    /// if no level has relief.
    ///
    /// # Errors
    /// When the serializer fails.
    pub fn serialize_document<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.write(serializer, &["relief"])
    }

    /// The labels of the road classes, class 0 first, where they are recorded.
    #[must_use]
    pub fn recorded_labels(&self) -> Option<[String; FunctionalRoadClass::COUNT]> {
        self.class_labels.clone()?.try_into().ok()
    }
}

fn structures_text(record: &SettingsRecord) -> String {
    if record.spans { "spans" } else { "ground" }.to_owned()
}

fn class_cells_text(record: &SettingsRecord) -> String {
    let texts = record.class_max_cell_m.iter().enumerate().map(|(class, cell_m)| {
        format!("{class}: {}", cell_m.map_or_else(|| "all".to_owned(), |cell_m| cell_m.to_string()))
    });
    texts.collect::<Vec<_>>().text()
}

fn photo_levels_text(record: &SettingsRecord) -> String {
    record.photo.map(|photo| photo.levels).text()
}

fn photo_quality_text(record: &SettingsRecord) -> String {
    record.photo.map(|photo| photo.quality).text()
}

#[cfg(test)]
#[path = "record_tests.rs"]
mod tests;
