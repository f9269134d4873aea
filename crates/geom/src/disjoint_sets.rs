//! Disjoint sets of whole numbers (union-find).

/// Whole numbers from 0 in disjoint sets; the smallest number of each set, its first, represents
/// the set.
#[derive(Debug, Clone)]
pub struct DisjointSets {
    /// Another number of the same set, or the first itself.
    before: Vec<usize>,
}

impl DisjointSets {
    /// Creates sets of `count` numbers, each number in a set of its own.
    #[must_use]
    pub fn new(count: usize) -> Self {
        Self { before: (0..count).collect() }
    }

    /// Adds the next number in a set of its own, and returns it.
    pub fn add(&mut self) -> usize {
        self.before.push(self.before.len());
        self.before.len() - 1
    }

    /// Returns the smallest number of a set.
    pub fn first_of(&mut self, number: usize) -> usize {
        let mut first = number;
        while self.before[first] != first {
            self.before[first] = self.before[self.before[first]];
            first = self.before[first];
        }
        first
    }

    /// Joins the sets of two numbers.
    pub fn join(&mut self, one: usize, other: usize) {
        let (one, other) = (self.first_of(one), self.first_of(other));
        self.before[one.max(other)] = one.min(other);
    }
}

#[cfg(test)]
#[path = "disjoint_sets_tests.rs"]
mod tests;
