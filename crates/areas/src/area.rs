//! An area of the map: its OSM object, its name, its polygons and its true size.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::{AreaClass, Polygon};

/// The OSM object from which an area comes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum AreaObject {
    /// A closed way.
    Way(i64),
    /// A relation of the type `multipolygon` or `boundary`.
    Relation(i64),
}

/// An area of the map: one object of OSM.
#[derive(Debug, Clone, PartialEq)]
pub struct Area {
    /// The OSM object from which the area comes.
    pub object: AreaObject,
    /// The class of the area.
    pub class: AreaClass,
    /// Its name, if it has one.
    pub name: Option<String>,
    /// The parts of the area, at least one.
    pub polygons: Vec<Polygon>,
    /// The true area on the ellipsoid, square metres.
    pub area_m2: f64,
}

impl AreaObject {
    /// Returns the type of the object, `"way"` or `"relation"`, and its id.
    #[must_use]
    pub const fn parts(self) -> (&'static str, i64) {
        match self {
            Self::Way(id) => ("way", id),
            Self::Relation(id) => ("relation", id),
        }
    }
}

impl fmt::Display for AreaObject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (kind, id) = self.parts();
        write!(f, "{kind} {id}")
    }
}
