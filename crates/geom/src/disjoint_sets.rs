//! Whole numbers in disjoint sets: which of them belong together.

/// Whole numbers from 0 in disjoint sets; each set is known by its smallest number, its first.
#[derive(Debug, Clone)]
pub struct DisjointSets {
    /// Another number of the same set, or the first itself.
    before: Vec<usize>,
}

impl DisjointSets {
    /// So many numbers, each alone.
    #[must_use]
    pub fn new(count: usize) -> Self {
        Self { before: (0..count).collect() }
    }

    /// Adds the next number, alone, and returns it.
    pub fn add(&mut self) -> usize {
        self.before.push(self.before.len());
        self.before.len() - 1
    }

    /// The smallest number of a set.
    pub fn first_of(&mut self, number: usize) -> usize {
        let mut first = number;
        while self.before[first] != first {
            self.before[first] = self.before[self.before[first]];
            first = self.before[first];
        }
        first
    }

    /// Makes one set of those of two numbers.
    pub fn join(&mut self, one: usize, other: usize) {
        let (one, other) = (self.first_of(one), self.first_of(other));
        self.before[one.max(other)] = one.min(other);
    }
}

#[cfg(test)]
#[path = "disjoint_sets_tests.rs"]
mod tests;
