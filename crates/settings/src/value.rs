//! The values of settings: their texts and their numbers.

use corniche_geom::Cell;

use crate::{LayerTableRecord, PolygonRecord, ReliefLevels};

/// A value in the form in which settings are compared.
pub trait SettingValue {
    /// The value as text for people.
    fn text(&self) -> String;

    /// The numbers in it that must be within limits.
    fn numbers(&self) -> Vec<f64> {
        Vec::new()
    }
}

impl SettingValue for f64 {
    fn text(&self) -> String {
        self.to_string()
    }

    fn numbers(&self) -> Vec<f64> {
        vec![*self]
    }
}

impl<T: SettingValue> SettingValue for Option<T> {
    fn text(&self) -> String {
        self.as_ref().map_or_else(|| "not given".to_owned(), T::text)
    }

    fn numbers(&self) -> Vec<f64> {
        self.iter().flat_map(T::numbers).collect()
    }
}

impl<T: SettingValue> SettingValue for Vec<T> {
    fn text(&self) -> String {
        let texts: Vec<String> = self.iter().map(T::text).collect();
        if texts.is_empty() { "none".to_owned() } else { texts.join(", ") }
    }

    fn numbers(&self) -> Vec<f64> {
        self.iter().flat_map(T::numbers).collect()
    }
}

impl<const COUNT: usize> SettingValue for [f64; COUNT] {
    fn text(&self) -> String {
        self.map(|number| number.to_string()).join(",")
    }

    fn numbers(&self) -> Vec<f64> {
        self.to_vec()
    }
}

impl SettingValue for Cell {
    fn text(&self) -> String {
        self.to_array().text()
    }

    fn numbers(&self) -> Vec<f64> {
        self.to_array().to_vec()
    }
}

impl SettingValue for bool {
    fn text(&self) -> String {
        if *self { "on" } else { "off" }.to_owned()
    }
}

impl SettingValue for ReliefLevels {
    fn text(&self) -> String {
        self.name().to_owned()
    }
}

impl SettingValue for PolygonRecord {
    fn text(&self) -> String {
        named(&self.name, &self.sha256)
    }
}

impl SettingValue for LayerTableRecord {
    fn text(&self) -> String {
        named(&self.id, &self.sha256)
    }
}

/// The name of a file and the beginning of its hash, which identifies its contents.
fn named(name: &str, sha256: &str) -> String {
    format!("{name} ({}…)", sha256.get(..12).unwrap_or(sha256))
}

macro_rules! plain {
    ($($type:ty),*) => {
        $(
            impl SettingValue for $type {
                fn text(&self) -> String {
                    self.to_string()
                }
            }
        )*
    };
}

plain!(u8, u32, String);
