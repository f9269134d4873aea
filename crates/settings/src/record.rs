//! The settings that determine the bytes of a package, as its manifest has them.

use corniche_areas::ClassedLayer;
use corniche_geom::Cell;
use corniche_roads::FunctionalRoadClass;
use serde::{Deserialize, Serialize, Serializer, ser::SerializeStruct as _};

use crate::{
    AreaTableRecord, MAX_MEASURE_M, PhotoRecord, PolygonRecord, ReliefLevels, SettingValue,
    table::KEYS_IN_ORDER,
};

/// A section of settings files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SettingSection {
    /// How the ground is made.
    Terrain,
    /// Which roads there are, and how exactly they are kept.
    Roads,
    /// Which areas and boundaries there are.
    Areas,
    /// How photos are made.
    Photo,
}

/// What is compared of a setting.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SettingFact {
    /// The section that it is in.
    pub section: SettingSection,
    /// Its key in the manifest.
    pub key: &'static str,
    /// The name that users know, such as `--crs`.
    pub name: &'static str,
    /// Its value in words.
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
            /// What is compared of each setting, in the order of the manifest.
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

            /// A number that no settings have, with its key.
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

            /// The manifest's keys in their order.
            #[must_use]
            pub fn keys() -> Vec<&'static str> {
                let mut keys = vec![$(stringify!($key)),*];
                keys.sort_by_key(|key| place(key));
                keys
            }

            /// Writes the settings with all keys in their order, but for those that are left out
            /// where they have their default. The keys in `always` are there in any case.
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

/// Where a key comes in the manifest.
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
    /// Writes the settings as `corniche info --json` has them: with their levels of relief also
    /// where there are none.
    ///
    /// # Errors
    /// When the serializer fails.
    pub fn serialize_document<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.write(serializer, &["relief"])
    }

    /// The layers of lines that there are.
    #[must_use]
    pub fn lines(&self) -> Vec<ClassedLayer> {
        let has = |layer: &ClassedLayer| match layer {
            ClassedLayer::Boundaries => self.boundaries,
        };
        ClassedLayer::ALL.into_iter().filter(has).collect()
    }

    /// What the roads of each class are called, 0 first, where it is recorded.
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
