//! The plan that a store is bound to, and its hash.

/// SHA-256 of what a store is bound to.
pub type PlanHash = [u8; 32];

/// What a store is bound to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredPlan {
    /// Says whether two plans are the same.
    pub hash: PlanHash,
    /// The plan as the caller writes it; the store only keeps it.
    pub bytes: Vec<u8>,
}
