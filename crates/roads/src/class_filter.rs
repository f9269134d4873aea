//! The filter that says on which levels each road class is shown.

use crate::FunctionalRoadClass;

/// The levels on which each class is shown, given as the coarsest cell size at which it is still
/// shown.
///
/// The finest level of a package shows every class that is on, whatever its cell size; callers do
/// not consult the filter there.
#[derive(Debug, Clone, PartialEq)]
pub struct ClassFilter {
    class_max_cell_m: [Option<f64>; FunctionalRoadClass::COUNT],
}

/// The reason why cell sizes do not form a [`ClassFilter`].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum ClassFilterError {
    #[error(
        "{class} is shown up to a cell size of {cell_m} m; set a length above 0, or none to show it always"
    )]
    Cell { class: FunctionalRoadClass, cell_m: f64 },
    #[error(
        "{class} is shown on coarser levels than the more important class before it; reduce its cell size"
    )]
    Order { class: FunctionalRoadClass },
}

impl ClassFilter {
    /// Creates a filter from the coarsest cell size, in metres, at which each class is shown;
    /// `None` means always.
    ///
    /// # Errors
    /// When a cell size is not a length, or when a class is shown on coarser levels than a more
    /// important one. Such a level would have no least class, so this must be a mistake.
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

    /// Returns the default filter: class 0 always, then up to cell sizes of 2000, 1000, 400, 200,
    /// 120, 60, 60 and 30 m.
    ///
    /// These numbers were chosen by eye: with them, the roads in a tile are about as dense as on
    /// the next finer level.
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

    /// Returns a filter that shows every class on every level.
    #[must_use]
    pub const fn all() -> Self {
        Self { class_max_cell_m: [None; FunctionalRoadClass::COUNT] }
    }

    /// Returns the coarsest cell size per class, in metres; `None` means always shown.
    #[must_use]
    pub const fn class_max_cell_m(&self) -> &[Option<f64>; FunctionalRoadClass::COUNT] {
        &self.class_max_cell_m
    }

    /// Whether a level with this cell size shows `class`.
    #[must_use]
    pub fn shows(&self, class: FunctionalRoadClass, level_cell_m: f64) -> bool {
        self.class_max_cell_m[usize::from(class.number())]
            .is_none_or(|max_cell_m| level_cell_m <= max_cell_m)
    }

    /// Returns the least important class that a level with this cell size shows; all more important
    /// classes are shown, too. `None` if the level shows no roads.
    #[must_use]
    pub fn least_class(&self, level_cell_m: f64) -> Option<FunctionalRoadClass> {
        FunctionalRoadClass::all().rev().find(|&class| self.shows(class, level_cell_m))
    }
}

#[cfg(test)]
#[path = "class_filter_tests.rs"]
mod tests;
