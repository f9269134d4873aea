//! The ways that make an outline, and why an outline can fail to surround anything.

use corniche_geom::LatticePoint;

/// A way of an outline: neighbouring points are joined. Its direction does not matter.
#[derive(Debug, Clone, Copy)]
pub struct OutlineWay<'a> {
    /// Its points in order.
    pub points: &'a [LatticePoint],
}

/// Why an outline surrounds nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum OutlineError {
    #[error("the outline is not closed: {ends} ends are open")]
    Open { ends: u64, first: LatticePoint },
    #[error("the outline crosses itself between its points")]
    Crossing { at: LatticePoint },
    #[error("nothing is left of the outline: it has no segments, or each of them twice")]
    Nothing,
    #[error("the outline has too many long segments side by side to be searched for crossings")]
    TooIntricate,
}
