//! The classes of boundaries, from countries to protected areas, and the tags that make them.

use std::collections::{BTreeMap, BTreeSet};

use crate::named_classes::named_classes;

named_classes! {
    /// The class of a boundary. A class with a lower number is more important.
    BoundaryClass:
    /// Countries: `admin_level=2`.
    Admin2 = "admin-2",
    /// Units of `admin_level=3`, between countries and states.
    Admin3 = "admin-3",
    /// States, provinces, cantons: `admin_level=4`.
    Admin4 = "admin-4",
    /// Units of `admin_level=5`, between states and counties.
    Admin5 = "admin-5",
    /// Counties, districts: `admin_level=6`.
    Admin6 = "admin-6",
    /// Units of `admin_level=7`, between counties and municipalities.
    Admin7 = "admin-7",
    /// Municipalities: `admin_level=8`.
    Admin8 = "admin-8",
    /// National parks and other protected areas.
    Protected = "protected",
}

impl BoundaryClass {
    /// The OSM key that every boundary has.
    pub const KEY: &str = "boundary";

    /// Returns the coarsest cell size, metres, of the levels on which its lines are stored; `None`
    /// for all levels. Districts and parks are too small to be drawn where cells are large.
    #[must_use]
    pub const fn coarsest_cell_m(self) -> Option<f64> {
        match self {
            Self::Admin2 | Self::Admin3 | Self::Admin4 => None,
            Self::Admin5 | Self::Admin6 => Some(250.0),
            Self::Admin7 | Self::Admin8 | Self::Protected => Some(80.0),
        }
    }

    /// Returns the OSM `admin_level` of its relations; `None` for protected areas.
    #[must_use]
    pub const fn admin_level(self) -> Option<u8> {
        match self {
            Self::Protected => None,
            _ => Some(self.number() + 2),
        }
    }

    /// Returns a label for such boundaries, for legends.
    #[must_use]
    pub const fn label(self) -> &'static str {
        match self {
            Self::Admin2 => "country border",
            Self::Admin3 => "boundary, level 3",
            Self::Admin4 => "boundary, level 4",
            Self::Admin5 => "boundary, level 5",
            Self::Admin6 => "boundary, level 6",
            Self::Admin7 => "boundary, level 7",
            Self::Admin8 => "boundary, level 8",
            Self::Protected => "protected area",
        }
    }

    /// Returns the class of a way or relation with these `(key, value)` tags; `None` if it is not
    /// such a boundary. If a key occurs twice, the first value counts.
    #[must_use]
    pub fn of_tags(tags: &[(&str, &str)]) -> Option<Self> {
        let value_of = |key: &str| tags.iter().find(|(k, _)| *k == key).map(|&(_, value)| value);
        match value_of(Self::KEY)? {
            "administrative" => {
                let level: usize = value_of("admin_level")?.parse().ok()?;
                Self::ALL[..Self::COUNT - 1].get(level.checked_sub(2)?).copied()
            }
            "protected_area" | "national_park" => Some(Self::Protected),
            _ => None,
        }
    }
}

/// The names of the objects that each way bounds, by the id of the way and the class of the object.
pub type BoundaryNames = BTreeMap<i64, BTreeMap<BoundaryClass, BTreeSet<String>>>;

#[cfg(test)]
#[path = "boundary_class_tests.rs"]
mod tests;
