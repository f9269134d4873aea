//! Why roads, and ways with a `highway` tag, are not in a package: codes, and the words under which
//! packages count them.

/// Why a road, a part of one, or a way with a `highway` tag is not in a package.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LossReason {
    /// The table of classes lists its value as no road.
    Listed,
    /// Its class is off.
    ClassOff,
    /// The table does not know its value.
    Unknown,
    /// It is the outline of an area.
    Area,
    /// Another way of the file has the same id.
    Duplicate,
    /// Too few of its nodes are known and have a place, or it goes to and fro over one place.
    WithoutLine,
    /// It lies beside the elevation data.
    OutsideData,
    /// It lies on the elevation data, but where they have no ground.
    NoGround,
    /// It lies outside the bounds that were asked for.
    OutsideBounds,
}

impl LossReason {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Listed,
        Self::ClassOff,
        Self::Unknown,
        Self::Area,
        Self::Duplicate,
        Self::WithoutLine,
        Self::OutsideData,
        Self::NoGround,
        Self::OutsideBounds,
    ];

    /// Why, in words.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Listed => "listed as no road",
            Self::ClassOff => "class is off",
            Self::Unknown => "value in no class",
            Self::Area => "an area",
            Self::Duplicate => "id occurs twice",
            Self::WithoutLine => "no line is left",
            Self::OutsideData => "outside the elevation data",
            Self::NoGround => "where the data have no ground (void or edge)",
            Self::OutsideBounds => "outside the bounds that were asked for",
        }
    }

    /// The reason with these words.
    #[must_use]
    pub fn from_text(text: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|reason| reason.text() == text)
    }
}

#[cfg(test)]
#[path = "loss_reason_tests.rs"]
mod tests;
