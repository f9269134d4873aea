//! Fields, values and geometries of the features that are exported.

/// What a field holds.
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
    /// Its name, as GDAL has it.
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
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// Its name in the file.
    pub name: &'static str,
    /// What it holds.
    pub kind: FieldKind,
    /// The unit of a number; empty where there is none.
    pub unit: &'static str,
    /// What it says.
    pub meaning: &'static str,
}

/// The value of a field.
#[derive(Clone)]
pub(crate) enum Value {
    Integer(i64),
    Real(f64),
    Text(String),
    /// The feature has no value in this field.
    Null,
}

impl From<i64> for Value {
    fn from(number: i64) -> Self {
        Self::Integer(number)
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Real(number)
    }
}

impl From<&str> for Value {
    /// GDAL's texts end at a zero byte, which OpenStreetMap's never have and damaged ones may.
    fn from(text: &str) -> Self {
        Self::Text(text.replace('\0', "\u{fffd}"))
    }
}

impl<T: Into<Self>> From<Option<T>> for Value {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Null, Into::into)
    }
}

/// A number rounded to whole micrometres, so that sums of rounding do not fill files with digits.
pub(crate) fn real(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// A text; `None` where it is empty.
pub(crate) fn text(text: &str) -> Option<&str> {
    Some(text).filter(|text| !text.is_empty())
}

/// One feature: a value for each field, and its geometry.
#[derive(Clone)]
pub(crate) struct Record {
    pub(crate) values: Vec<Value>,
    pub(crate) shape: Shape,
}

/// The geometries that a layer holds.
#[derive(Clone, Copy)]
pub(crate) enum ShapeKind {
    /// [`Shape::Lines`]
    Lines,
    /// [`Shape::Lines`], whose heights are left out.
    PlanLines,
    /// [`Shape::Polygons`]
    Polygons,
}

/// The geometry of a feature.
#[derive(Clone)]
pub(crate) enum Shape {
    /// Lines of x, y and height.
    Lines(Vec<Vec<[f64; 3]>>),
    /// Polygons in plan: an outer ring, then rings around holes. The first point of a ring is not repeated at its end.
    Polygons(Vec<Vec<Vec<[f64; 2]>>>),
}

impl Shape {
    /// Vertices in a file, where the last point of a ring is its first one again.
    pub(crate) fn vertices(&self) -> usize {
        match self {
            Self::Lines(lines) => lines.iter().map(Vec::len).sum(),
            Self::Polygons(polygons) => polygons.iter().flatten().map(|ring| ring.len() + 1).sum(),
        }
    }
}

/// Declares fields together with what is in them, in one order.
macro_rules! fields {
    ($fields:ident, $of:ident: $type:ty: $($name:literal, $kind:ident, $unit:literal, $meaning:literal, $value:expr;)+) => {
        const $fields: &[(Field, fn($type) -> Value)] = &[
            $((
                Field { name: $name, kind: FieldKind::$kind, unit: $unit, meaning: $meaning },
                |$of| Value::from($value),
            ),)+
        ];
    };
}

pub(crate) use fields;

/// The fields among fields with what is in them.
pub(crate) fn fields_of<V>(fields: &[(Field, V)]) -> Vec<Field> {
    fields.iter().map(|(field, _)| *field).collect()
}
