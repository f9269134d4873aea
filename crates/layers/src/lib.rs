//! Layers: which objects of an extract a package contains, in which classes and with which
//! attributes, by a table that users can write themselves.
//!
//! ```text
//!  TOML (presets) ──► LayerForm ──► LayerTable::new ──► LayerTable
//!                     as written    checks it           │
//!                                    tags ──► class ◄───┘
//! ```
//!
//! This crate parses no file, and knows neither geometry nor terrain.

mod atom_set;
mod layer_attribute;
mod layer_form;
mod layer_stack;
mod layer_table;
mod osm_object;
mod shadowing;
mod table_error;
mod tag_condition;
mod tag_rule;
mod tag_unit;
mod titles;

pub use layer_attribute::{AttributeKind, AttributeValue, DerivedNumber, MAX_NAMES};
pub use layer_form::{ClassForm, LayerForm, LayerGeometry, LinePlacement, RelationMembers};
pub use layer_stack::{LayerStackError, MAX_LAYERS, stacked_layers};
pub use layer_table::{LayerTable, MAX_LAYER_CLASSES};
pub use osm_object::OsmObject;
pub use table_error::{LayerTableError, TablePath, TableStep};
pub use tag_condition::TagCondition;
pub use tag_rule::TagRule;
pub use tag_unit::TagUnit;
pub use titles::Titles;
