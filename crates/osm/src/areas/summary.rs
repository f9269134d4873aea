//! How many areas an extract had, and how many were kept or lost.

use std::collections::BTreeMap;

use corniche_areas::{AreaClass, Coastline};

use crate::AreaLoss;

/// What was in an extract and what became of it. `objects = kept + lost`, in number.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AreaSummary {
    /// Ways and relations with the tags of an area.
    pub objects: u64,
    /// Areas that were handed out, by class.
    pub kept: BTreeMap<AreaClass, KeptAreas>,
    /// Objects that became none.
    pub lost: BTreeMap<AreaLoss, u64>,
    /// Coastlines on the package's lattice, if the table wants the sea. They do not count as objects.
    pub coastlines: Vec<Coastline>,
}

/// Areas of one class.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct KeptAreas {
    /// How many.
    pub areas: u64,
    /// The number of their polygons.
    pub polygons: u64,
    /// The points of all rings.
    pub points: u64,
    /// The true area of the objects, square metres. Where areas overlap, each counts.
    pub area_m2: f64,
}
