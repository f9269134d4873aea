//! The filter that says from which level on each road class is shown.

use crate::FunctionalRoadClass;

/// From which level on each class is shown, as the coarsest cell at which it still is.
///
/// The finest level of a package shows every class that is on, whatever its cell: the caller does not ask there.
#[derive(Debug, Clone, PartialEq)]
pub struct ClassFilter {
    class_max_cell_m: [Option<f64>; FunctionalRoadClass::COUNT],
}

/// Why cells do not make a [`ClassFilter`].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum ClassFilterError {
    #[error(
        "{class} is shown up to a cell of {cell_m} m; give a length above 0, or none for always"
    )]
    Cell { class: FunctionalRoadClass, cell_m: f64 },
    #[error(
        "{class} is shown on coarser levels than the more important class before it; lower its cell"
    )]
    Order { class: FunctionalRoadClass },
}

impl ClassFilter {
    /// Takes for each class the coarsest cell, in metres, at which it is shown; `None`: always.
    ///
    /// # Errors
    /// When a cell is not a length, or a class is shown on coarser levels than a more important one (this would be a
    /// mistake, and such a level has no least class).
    pub fn new(
        class_max_cell_m: [Option<f64>; FunctionalRoadClass::COUNT],
    ) -> Result<Self, ClassFilterError> {
        let mut coarsest_m = f64::INFINITY;
        for (class, max_cell_m) in FunctionalRoadClass::all().zip(class_max_cell_m) {
            let cell_m = max_cell_m.unwrap_or(f64::INFINITY);
            if max_cell_m.is_some_and(|cell_m| !(cell_m > 0.0 && cell_m.is_finite())) {
                return Err(ClassFilterError::Cell { class, cell_m });
            }
            if cell_m > coarsest_m {
                return Err(ClassFilterError::Order { class });
            }
            coarsest_m = cell_m;
        }
        Ok(Self { class_max_cell_m })
    }

    /// The usual choice: class 0 always, then up to cells of 2000, 1000, 400, 200, 120, 60, 60 and 30 m.
    ///
    /// These numbers were chosen by eye: with them, the roads in a tile are about as dense as on the next finer
    /// level.
    #[must_use]
    pub const fn usual() -> Self {
        Self {
            class_max_cell_m: [
                None,
                Some(2000.0),
                Some(1000.0),
                Some(400.0),
                Some(200.0),
                Some(120.0),
                Some(60.0),
                Some(60.0),
                Some(30.0),
            ],
        }
    }

    /// Every class on every level.
    #[must_use]
    pub const fn all() -> Self {
        Self { class_max_cell_m: [None; FunctionalRoadClass::COUNT] }
    }

    /// The coarsest cell per class, in metres; `None`: always shown.
    #[must_use]
    pub const fn class_max_cell_m(&self) -> &[Option<f64>; FunctionalRoadClass::COUNT] {
        &self.class_max_cell_m
    }

    /// Whether a level with this cell shows `class`.
    #[must_use]
    pub fn shows(&self, class: FunctionalRoadClass, level_cell_m: f64) -> bool {
        self.class_max_cell_m[usize::from(class.number())]
            .is_none_or(|max_cell_m| level_cell_m <= max_cell_m)
    }

    /// The least important class that a level with this cell shows; all classes above it are shown, too.
    /// `None` when the level shows no roads.
    #[must_use]
    pub fn least_class(&self, level_cell_m: f64) -> Option<FunctionalRoadClass> {
        FunctionalRoadClass::all().rev().find(|&class| self.shows(class, level_cell_m))
    }
}

#[cfg(test)]
#[path = "class_filter_tests.rs"]
mod tests;
