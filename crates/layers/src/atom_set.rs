//! Sets of small numbers, one bit each.

/// A set of atoms of a key, by their numbers; see [`shadowing`](crate::shadowing).
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct AtomSet(Box<[u64]>);

impl AtomSet {
    /// The set of these numbers, all less than `count`.
    pub(crate) fn new(count: usize, atoms: impl IntoIterator<Item = usize>) -> Self {
        let mut bits = vec![0; count.div_ceil(64)];
        for atom in atoms {
            bits[atom / 64] |= 1 << (atom % 64);
        }
        Self(bits.into())
    }

    /// The set of all numbers less than `count` but these.
    pub(crate) fn without(count: usize, atoms: impl IntoIterator<Item = usize>) -> Self {
        Self::new(count, 0..count).minus(&Self::new(count, atoms))
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.iter().all(|&bits| bits == 0)
    }

    pub(crate) fn is_disjoint(&self, other: &Self) -> bool {
        self.0.iter().zip(&other.0).all(|(own, other)| own & other == 0)
    }

    pub(crate) fn is_subset(&self, other: &Self) -> bool {
        self.0.iter().zip(&other.0).all(|(own, other)| own & !other == 0)
    }

    pub(crate) fn minus(&self, other: &Self) -> Self {
        Self(self.0.iter().zip(&other.0).map(|(own, other)| own & !other).collect())
    }

    pub(crate) fn and(&self, other: &Self) -> Self {
        Self(self.0.iter().zip(&other.0).map(|(own, other)| own & other).collect())
    }
}
