//! Files of features through GDAL's vector drivers. Nothing here depends on roads or layers, except
//! for the colours of their classes.

mod cell;
mod field;
mod file;
mod format;
mod geopackage;
mod map_style;
mod whole;

pub use cell::{cell_text, is_unseen, text_in_line};
pub use field::{FeatureField, FieldKind};
pub(crate) use field::{
    FeatureGeometry, FeatureRecord, FieldValue, ShapeKind, fields, fields_of, real, text,
};
pub(crate) use file::{Layer, VectorFile};
pub use format::VectorFormat;
pub(crate) use map_style::StyledClasses;
