//! Fields, values and geometries of exported features.

use std::borrow::Cow;

/// The type of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldKind {
    /// A whole number of 32 bits.
    Integer,
    /// A whole number of 64 bits.
    Integer64,
    /// A number.
    Real,
    /// Text.
    Text,
}

impl FieldKind {
    /// The name in GDAL.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Integer => "Integer",
            Self::Integer64 => "Integer64",
            Self::Real => "Real",
            Self::Text => "String",
        }
    }
}

/// A field of features.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FeatureField {
    /// Its name in the file.
    pub name: Cow<'static, str>,
    /// The type of its values.
    pub kind: FieldKind,
    /// The unit of a number; empty without one.
    pub unit: &'static str,
    /// The meaning of the field.
    pub meaning: Cow<'static, str>,
}

/// The value of a field.
pub(crate) enum FieldValue {
    Integer(i64),
    Real(f64),
    Text(String),
    /// The feature has no value in this field.
    Null,
}

impl From<i64> for FieldValue {
    fn from(number: i64) -> Self {
        Self::Integer(number)
    }
}

impl From<f64> for FieldValue {
    fn from(number: f64) -> Self {
        Self::Real(number)
    }
}

impl From<&str> for FieldValue {
    /// GDAL's texts end at a zero byte. OpenStreetMap's texts never have one, but corrupt ones may.
    fn from(text: &str) -> Self {
        Self::Text(text.replace('\0', "\u{fffd}"))
    }
}

impl<T: Into<Self>> From<Option<T>> for FieldValue {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Null, Into::into)
    }
}

/// Rounds a number to whole micrometres, so that rounding errors do not fill files with digits.
pub(crate) fn real(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// Returns a text; `None` if it is empty.
pub(crate) fn text(text: &str) -> Option<&str> {
    Some(text).filter(|text| !text.is_empty())
}

/// One feature: a value for each field, and its geometry.
pub(crate) struct FeatureRecord {
    pub(crate) values: Vec<FieldValue>,
    pub(crate) shape: FeatureGeometry,
}

/// The geometries that a layer holds.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum ShapeKind {
    /// [`FeatureGeometry::Lines`]
    Lines,
    /// [`FeatureGeometry::Polygons`]
    Polygons,
    /// [`FeatureGeometry::Point`]
    Points,
}

/// The geometry of a feature.
pub(crate) enum FeatureGeometry {
    /// Lines of x, y and height.
    Lines(Vec<Vec<[f64; 3]>>),
    /// Polygons in plan: an outer ring, then the rings of holes. The first point of a ring is not
    /// repeated at its end.
    Polygons(Vec<Vec<Vec<[f64; 2]>>>),
    /// A point: x, y and height.
    Point([f64; 3]),
}

impl FeatureGeometry {
    /// The number of vertices in a file, where the last point of a ring repeats its first.
    pub(crate) fn vertices(&self) -> usize {
        match self {
            Self::Lines(lines) => lines.iter().map(Vec::len).sum(),
            Self::Polygons(polygons) => polygons.iter().flatten().map(|ring| ring.len() + 1).sum(),
            Self::Point(_) => 1,
        }
    }
}

/// Declares fields together with the functions that return their values, in one order.
macro_rules! fields {
    ($fields:ident, $of:ident: $type:ty: $($name:literal, $kind:ident, $unit:literal, $meaning:literal, $value:expr;)+) => {
        const $fields: &[(FeatureField, fn($type) -> FieldValue)] = &[
            $((
                FeatureField {
                    name: ::std::borrow::Cow::Borrowed($name),
                    kind: FieldKind::$kind,
                    unit: $unit,
                    meaning: ::std::borrow::Cow::Borrowed($meaning),
                },
                |$of| FieldValue::from($value),
            ),)+
        ];
    };
}

pub(crate) use fields;

/// Returns the fields without the functions that return their values.
pub(crate) fn fields_of<V>(fields: &[(FeatureField, V)]) -> Vec<FeatureField> {
    fields.iter().map(|(field, _)| field.clone()).collect()
}
