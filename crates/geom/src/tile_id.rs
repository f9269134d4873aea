//! The name of a tile in the quadtree: level, column and row.

use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

use crate::MAX_LEVEL;

/// A tile of the quadtree, printed `z/x/y`: level, column from the west, row from the north.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "(u8, u32, u32)", into = "(u8, u32, u32)")]
pub struct TileId {
    z: u8,
    x: u32,
    y: u32,
}

/// Why a value is not a tile id.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TileIdError {
    /// The level is beyond the deepest level.
    #[error("level {z} is beyond the deepest level {MAX_LEVEL}")]
    Level {
        /// The requested level.
        z: u8,
    },
    /// The column or the row does not exist on the level.
    #[error("level {z} has columns and rows 0 to {max}; {x}/{y} is not one of them", max = (1_u64 << z) - 1)]
    Outside {
        /// Level.
        z: u8,
        /// Column.
        x: u32,
        /// Row.
        y: u32,
    },
    /// The text does not consist of three numbers.
    #[error("{text:?} is not a tile id; write Z/X/Y, for example 3/1/4")]
    Text {
        /// The given text.
        text: String,
    },
}

impl TryFrom<(u8, u32, u32)> for TileId {
    type Error = TileIdError;

    fn try_from((z, x, y): (u8, u32, u32)) -> Result<Self, TileIdError> {
        Self::new(z, x, y)
    }
}

impl From<TileId> for (u8, u32, u32) {
    fn from(id: TileId) -> Self {
        (id.z, id.x, id.y)
    }
}

impl TileId {
    /// The tile that covers everything.
    pub const ROOT: Self = Self { z: 0, x: 0, y: 0 };

    /// Creates tile `z/x/y`.
    ///
    /// # Errors
    /// When the level is too deep, or has no such column or row.
    pub fn new(z: u8, x: u32, y: u32) -> Result<Self, TileIdError> {
        if z > MAX_LEVEL {
            return Err(TileIdError::Level { z });
        }
        if x >> z != 0 || y >> z != 0 {
            return Err(TileIdError::Outside { z, x, y });
        }
        Ok(Self { z, x, y })
    }

    /// Level, 0 = root.
    #[must_use]
    pub const fn z(self) -> u8 {
        self.z
    }

    /// Column, from the west.
    #[must_use]
    pub const fn x(self) -> u32 {
        self.x
    }

    /// Row, from the north.
    #[must_use]
    pub const fn y(self) -> u32 {
        self.y
    }

    /// The parent tile; `None` for the root.
    #[must_use]
    pub fn parent(self) -> Option<Self> {
        self.z.checked_sub(1).map(|z| self.ancestor(z))
    }

    /// The tile of level `z` (at most its own) that contains this tile.
    #[must_use]
    pub fn ancestor(self, z: u8) -> Self {
        let up = self.z - z.min(self.z);
        Self { z: self.z - up, x: self.x >> up, y: self.y >> up }
    }

    /// The four child tiles: north-west, north-east, south-west, south-east. Empty at the deepest
    /// level.
    pub fn children(self) -> impl Iterator<Item = Self> {
        let deeper = self.z < MAX_LEVEL;
        [(0, 0), (1, 0), (0, 1), (1, 1)]
            .into_iter()
            .filter(move |_| deeper)
            .map(move |(dx, dy)| Self { z: self.z + 1, x: self.x * 2 + dx, y: self.y * 2 + dy })
    }

    /// The tile `dx` columns east and `dy` rows south on the same level, if it exists.
    #[must_use]
    pub fn neighbour(self, dx: i32, dy: i32) -> Option<Self> {
        let x = self.x.checked_add_signed(dx)?;
        let y = self.y.checked_add_signed(dy)?;
        Self::new(self.z, x, y).ok()
    }
}

impl fmt::Display for TileId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}/{}", self.z, self.x, self.y)
    }
}

impl fmt::Debug for TileId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl FromStr for TileId {
    type Err = TileIdError;

    fn from_str(text: &str) -> Result<Self, TileIdError> {
        let bad = || TileIdError::Text { text: text.to_owned() };
        let mut parts = text.split('/');
        let mut next = || parts.next().and_then(|part| part.parse::<u32>().ok()).ok_or_else(bad);
        let (z, x, y) = (next()?, next()?, next()?);
        if parts.next().is_some() {
            return Err(bad());
        }
        Self::new(u8::try_from(z).map_err(|_| bad())?, x, y)
    }
}

#[cfg(test)]
#[path = "tile_id_tests.rs"]
mod tests;
