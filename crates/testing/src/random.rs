//! Random numbers that are the same on every machine.

/// Random numbers that are the same on every machine.
///
/// Source: Steele, Lea & Flood 2014, *Fast Splittable Pseudorandom Number Generators* (splitmix64).
#[derive(Debug, Clone)]
pub struct Random {
    state: u64,
}

impl Random {
    /// Creates the generator for a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// Returns 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Returns a number from 0 to below 1.
    pub fn share(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Returns a number from 0 to below `limit`, which must be above 0.
    pub fn below(&mut self, limit: i64) -> i64 {
        (self.bits() % limit as u64) as i64
    }

    /// Returns a number from −`reach` to `reach`.
    pub fn around(&mut self, reach: i64) -> i64 {
        self.below(2 * reach + 1) - reach
    }

    /// Returns an element of `list`, which must not be empty.
    pub fn one_of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len() as i64) as usize]
    }
}
