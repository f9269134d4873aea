//! The classes of boundaries, from countries to protected areas, and the tags that make them.

use std::fmt;

/// What a boundary divides.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum BoundaryClass {
    /// Countries: `admin_level=2`.
    Admin2,
    /// Units of `admin_level=3`, between countries and states.
    Admin3,
    /// States, provinces, cantons: `admin_level=4`.
    Admin4,
    /// Units of `admin_level=5`, between states and counties.
    Admin5,
    /// Counties, districts: `admin_level=6`.
    Admin6,
    /// Units of `admin_level=7`, between counties and municipalities.
    Admin7,
    /// Municipalities: `admin_level=8`.
    Admin8,
    /// National parks and other protected areas.
    Protected,
}

impl BoundaryClass {
    /// How many classes there are.
    pub const COUNT: usize = 8;

    /// All classes, the most important first.
    pub const ALL: [Self; Self::COUNT] = [
        Self::Admin2,
        Self::Admin3,
        Self::Admin4,
        Self::Admin5,
        Self::Admin6,
        Self::Admin7,
        Self::Admin8,
        Self::Protected,
    ];

    /// The class with this number.
    #[must_use]
    pub fn from_number(number: u8) -> Option<Self> {
        Self::ALL.get(usize::from(number)).copied()
    }

    /// Its number, 0 to 7. Lower is more important.
    #[must_use]
    pub const fn number(self) -> u8 {
        self as u8
    }

    /// Its name in settings and styles.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Admin2 => "admin-2",
            Self::Admin3 => "admin-3",
            Self::Admin4 => "admin-4",
            Self::Admin5 => "admin-5",
            Self::Admin6 => "admin-6",
            Self::Admin7 => "admin-7",
            Self::Admin8 => "admin-8",
            Self::Protected => "protected",
        }
    }

    /// OSM's `admin_level` of its relations; `None` for protected areas.
    #[must_use]
    pub const fn admin_level(self) -> Option<u8> {
        match self {
            Self::Protected => None,
            _ => Some(self.number() + 2),
        }
    }

    /// The class with this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|class| class.name() == name)
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

impl fmt::Display for BoundaryClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
#[path = "boundary_class_tests.rs"]
mod tests;
