//! Reasons why roads, and ways with a `highway` tag, are not in a package: codes, and the words
//! under which packages count them.

crate::listed! {
    /// The reason why a road, a part of a road, or a way with a `highway` tag is not in a package.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum LossReason {
        /// The table of classes lists the way's value as no road.
        Listed = "listed as no road",
        /// The road's class is off.
        ClassOff = "class is off",
        /// The table does not know the way's value.
        Unknown = "value in no class",
        /// The way is the outline of an area.
        Area = "an area",
        /// Another way of the file has the same id.
        Duplicate = "id occurs twice",
        /// Too few nodes of the way are known and have a position, or the way goes to and fro over
        /// one place.
        WithoutLine = "no line is left",
        /// The road is outside the elevation data.
        OutsideData = "outside the elevation data",
        /// The road is within the elevation data, but the data has no ground there.
        NoGround = "where the data have no ground (void or edge)",
        /// The road is outside the requested bounds.
        OutsideBounds = "outside the bounds that were asked for",
    }

    /// Returns the reason, in words.
    pub fn text() -> &'static str;
}

impl LossReason {
    /// Returns the reason with these words.
    #[must_use]
    pub fn from_text(text: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|reason| reason.text() == text)
    }
}

#[cfg(test)]
#[path = "loss_reason_tests.rs"]
mod tests;
