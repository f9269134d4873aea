//! Files of features through GDAL's vector drivers. Nothing here knows a road or an area.

mod cell;
mod field;
mod file;
mod format;
mod whole;

pub use cell::cell_text;
pub use field::{Field, FieldKind};
pub(crate) use field::{Record, Shape, ShapeKind, Value};
pub(crate) use file::{Layer, VectorFile};
pub use format::VectorFormat;
