//! The classes of boundaries, from countries to protected areas, and the tags that make them.

use crate::{class_table::ClassTable, named_classes::named_classes};

named_classes! {
    /// What a boundary divides. A class with a lower number is more important.
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
    /// Districts and parks are too small to be drawn where cells are large.
    pub(crate) const TABLE: ClassTable = ClassTable {
        title: "Boundaries",
        key: "boundary",
        of_tags: |tags| Self::of_tags(tags).map(Self::number),
        has_relations: true,
        names: &Self::NAMES,
        coarsest_cells_m: &{
            let (county, small) = (Some(250.0), Some(80.0));
            [None, None, None, county, county, small, small, small]
        },
    };

    /// OSM's `admin_level` of its relations; `None` for protected areas.
    #[must_use]
    pub const fn admin_level(self) -> Option<u8> {
        match self {
            Self::Protected => None,
            _ => Some(self.number() + 2),
        }
    }

    /// What people call such boundaries, for legends.
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

    /// What a way or relation with these `(key, value)` tags bounds; `None` if it is no such boundary. Of a key that occurs twice the
    /// first counts.
    #[must_use]
    pub fn of_tags(tags: &[(&str, &str)]) -> Option<Self> {
        let value_of = |key: &str| tags.iter().find(|(k, _)| *k == key).map(|&(_, value)| value);
        match value_of("boundary")? {
            "administrative" => {
                let level: usize = value_of("admin_level")?.parse().ok()?;
                Self::ALL[..Self::COUNT - 1].get(level.checked_sub(2)?).copied()
            }
            "protected_area" | "national_park" => Some(Self::Protected),
            _ => None,
        }
    }
}

#[cfg(test)]
#[path = "boundary_class_tests.rs"]
mod tests;
