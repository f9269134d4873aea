//! Files of features through GDAL's vector drivers. Nothing here knows a road.

mod field;
mod file;
mod format;
mod whole;

pub use field::{Field, FieldKind};
pub(crate) use field::{Record, Value};
pub(crate) use file::{Layer, VectorFile};
pub use format::VectorFormat;
