//! The plan that a store is bound to, and its hash.

/// The SHA-256 of the plan to which a store is bound.
pub type PlanHash = [u8; 32];

/// The plan to which a store is bound.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredPlan {
    /// Plans are equal if their hashes are equal.
    pub hash: PlanHash,
    /// The plan as the caller writes it; the store only stores it.
    pub bytes: Vec<u8>,
}
