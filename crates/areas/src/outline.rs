//! The ways of an outline, and the reasons why an outline may enclose nothing.

use corniche_geom::LatticePoint;

/// A way of an outline: consecutive points are connected. Its direction does not matter.
#[derive(Debug, Clone, Copy)]
pub struct OutlineWay<'a> {
    /// Its points in order.
    pub points: &'a [LatticePoint],
}

impl AsRef<[LatticePoint]> for OutlineWay<'_> {
    fn as_ref(&self) -> &[LatticePoint] {
        self.points
    }
}

/// The reason why an outline encloses nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum OutlineError {
    #[error("the outline is not closed: {ends} ends are open")]
    Open { ends: u64, first: LatticePoint },
    #[error("the outline crosses itself between its points")]
    Crossing { at: LatticePoint },
    #[error("the outline encloses nothing: it has no segments, or each segment occurs twice")]
    Nothing,
    #[error("the outline has too many long segments close together to be checked for crossings")]
    TooIntricate,
}
