//! Layers of lines of which each has a class: the list of them, and how their classes are asked for.

use std::{
    collections::{BTreeMap, BTreeSet},
    fmt,
};

use serde::{Deserialize, Serialize};

use crate::{boundary_class::BoundaryClass, class_table::ClassTable};

/// A text that names a layer of lines, one line of it or many: `line_text!(layer, "number of " many)`.
#[macro_export]
macro_rules! line_text {
    ($layer:expr, $($before:literal)? one $($after:literal)?) => {
        match $layer {
            $crate::ClassedLayer::Boundaries => concat!($($before,)? "boundary", $($after)?),
        }
    };
    ($layer:expr, $($before:literal)? many $($after:literal)?) => {
        match $layer {
            $crate::ClassedLayer::Boundaries => concat!($($before,)? "boundaries", $($after)?),
        }
    };
}

/// A layer of lines: ways of the extract with a class each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum ClassedLayer {
    /// Administrative boundaries, and those of protected areas.
    Boundaries,
}

impl ClassedLayer {
    /// All layers, in the order of their sections.
    pub const ALL: [Self; 1] = [Self::Boundaries];

    /// The table of its classes.
    #[must_use]
    pub const fn table(self) -> &'static ClassTable {
        match self {
            Self::Boundaries => &BoundaryClass::TABLE,
        }
    }

    /// The layer's name in options, manifests and files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        line_text!(self, many)
    }

    /// All classes, the most important first.
    #[must_use]
    pub fn classes(self) -> Vec<LineClass> {
        (0..).map_while(|number| self.class(number)).collect()
    }

    /// The class with this number.
    #[must_use]
    pub fn class(self, number: u8) -> Option<LineClass> {
        (usize::from(number) < self.table().names.len())
            .then_some(LineClass { layer: self, number })
    }
}

/// The class of a line. A class with a lower number is more important.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LineClass {
    layer: ClassedLayer,
    number: u8,
}

impl LineClass {
    /// Its number in its layer, from 0.
    #[must_use]
    pub const fn number(self) -> u8 {
        self.number
    }

    /// Its name in settings, styles and exports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.layer.table().names[self.number as usize]
    }

    /// The coarsest cell, metres, on whose level its lines are stored; `None`: all.
    #[must_use]
    pub const fn coarsest_cell_m(self) -> Option<f64> {
        self.layer.table().coarsest_cells_m[self.number as usize]
    }
}

/// The names of what each way of a layer bounds, by the id of the way and the class of what it bounds.
pub type LineNames = BTreeMap<i64, BTreeMap<LineClass, BTreeSet<String>>>;

impl fmt::Display for LineClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
#[path = "classed_layer_tests.rs"]
mod tests;
