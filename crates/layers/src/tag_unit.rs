//! Units of numbers in tags.

use corniche_roads::{listed, number_and_unit};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

listed! {
    /// The unit in which the numbers of a tag are read and stored. A number without a unit is in
    /// this unit, and other units of the same quantity are converted.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
    pub enum TagUnit {
        /// A plain number, such as a population.
        #[default]
        #[serde(rename = "")]
        Count = ("", UnitQuantity::Count, 1.0),
        /// Millimetres.
        #[serde(rename = "mm")]
        Millimetre = ("mm", UnitQuantity::Length, 1e-3),
        /// Centimetres.
        #[serde(rename = "cm")]
        Centimetre = ("cm", UnitQuantity::Length, 1e-2),
        /// Metres.
        #[serde(rename = "m")]
        Metre = ("m", UnitQuantity::Length, 1.0),
        /// Kilometres.
        #[serde(rename = "km")]
        Kilometre = ("km", UnitQuantity::Length, 1e3),
        /// International feet.
        #[serde(rename = "ft")]
        Foot = ("ft", UnitQuantity::Length, 0.3048),
        /// International inches.
        #[serde(rename = "in")]
        Inch = ("in", UnitQuantity::Length, 0.0254),
        /// Statute miles.
        #[serde(rename = "mi")]
        Mile = ("mi", UnitQuantity::Length, 1609.344),
        /// Kilometres per hour.
        #[serde(rename = "km/h")]
        KilometrePerHour = ("km/h", UnitQuantity::Speed, 1.0),
        /// Miles per hour.
        #[serde(rename = "mph")]
        MilePerHour = ("mph", UnitQuantity::Speed, 1.609_344),
        /// Volts.
        #[serde(rename = "V")]
        Volt = ("V", UnitQuantity::Voltage, 1.0),
        /// Kilovolts.
        #[serde(rename = "kV")]
        Kilovolt = ("kV", UnitQuantity::Voltage, 1e3),
        /// Tonnes.
        #[serde(rename = "t")]
        Tonne = ("t", UnitQuantity::Mass, 1.0),
        /// Per cent.
        #[serde(rename = "%")]
        Percent = ("%", UnitQuantity::Ratio, 1.0),
    }

    /// The symbol, the quantity, and the value of one unit in the quantity's first unit.
    fn row() -> (&'static str, UnitQuantity, f64);
}

/// What a unit measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum UnitQuantity {
    Count,
    Length,
    Speed,
    Voltage,
    Mass,
    Ratio,
}

impl TagUnit {
    /// Returns the symbol of the unit, empty for plain numbers.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        self.row().0
    }

    /// Reads the value of a tag as a number in this unit: `12`, `-3.5`, `12 m`, `1200 ft`,
    /// `12'6"`. `None` for anything else, such as decimal commas, ranges, lists, numbers of another
    /// quantity and numbers of more than 10^15.
    ///
    /// Source: OSM wiki, *Map features/Units*.
    #[must_use]
    pub fn number(self, tagged: &str) -> Option<f64> {
        let tagged = tagged.trim();
        let (sign, text) = match tagged.strip_prefix('-') {
            Some(text) => (-1.0, text),
            None => (1.0, tagged),
        };
        let (_, quantity, own) = self.row();
        let value = match text.split_once('\'') {
            Some((feet, inches)) if quantity == UnitQuantity::Length => {
                (plain(feet)? * 0.3048 + inches_of(inches)? * 0.0254) / own
            }
            Some(_) => return None,
            None => {
                let (value, symbol) = number_and_unit(text)?;
                value * self.in_own(symbol)?
            }
        };
        (value <= 1e15).then_some(sign * value)
    }

    /// Returns the value of one unit with this symbol in this unit; `None` if it is the symbol of
    /// another quantity, or of none.
    fn in_own(self, symbol: &str) -> Option<f64> {
        let (_, quantity, own) = self.row();
        let symbol = match symbol {
            "" => return Some(1.0),
            "\"" => "in",
            "kmh" | "kph" => "km/h",
            other => other,
        };
        let mut units = Self::ALL.iter().map(|unit| unit.row());
        let (.., value) = units.find(|&(known, of, _)| known == symbol && of == quantity)?;
        Some(value / own)
    }
}

/// Reads inches after feet: `6"`, or nothing.
fn inches_of(text: &str) -> Option<f64> {
    match text.trim() {
        "" => Some(0.0),
        text => plain(text.strip_suffix('"')?),
    }
}

/// Reads a number without a unit.
fn plain(text: &str) -> Option<f64> {
    number_and_unit(text).and_then(|(value, unit)| unit.is_empty().then_some(value))
}

#[cfg(test)]
#[path = "tag_unit_tests.rs"]
mod tests;
