//! Distributes a sum over road classes.

use corniche_roads::FunctionalRoadClass;

/// Returns the share of `total` for `parts[index]`; all shares add up to `total` exactly.
#[must_use]
pub fn share(total: u64, parts: &[u64; FunctionalRoadClass::COUNT], index: usize) -> u64 {
    let sum: u64 = parts.iter().sum();
    if sum == 0 {
        return 0;
    }
    let up_to = |end: usize| {
        (u128::from(total) * u128::from(parts[..end].iter().sum::<u64>()) / u128::from(sum)) as u64
    };
    up_to(index + 1) - up_to(index)
}

#[cfg(test)]
#[path = "proportions_tests.rs"]
mod tests;
