//! How far TINs are from the DEM's own samples: sums that can be merged in any order.

use serde::{Deserialize, Serialize};

use super::levels::SampleErrorRecord;

/// Distances are summed in whole parts of the height quantum; this is the number of parts per
/// quantum.
const PARTS_TO_A_QUANTUM: f64 = 256.0;
/// Up to this many quanta, bins are one quantum wide; farther out, the width of a bin is a 4096th
/// of the distance.
const FINE_BINS: u64 = 1 << 12;
/// The largest summed distance, in parts: its square times 2^60 samples fits in 128 bits.
const MOST_PARTS: f64 = (1_u64 << 33) as f64;

/// How far a level's TINs are from samples of the DEM.
///
/// All sums are integers, and a maximum: the result does not depend on the order in which samples
/// are added or sums are merged.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SampleSums {
    quantum_m: f64,
    on_tin: u64,
    off_tin: u64,
    max_m: f64,
    /// Squares of distances in parts of a quantum.
    squares: u128,
    /// Number of distances in each bin, starting at distance 0.
    #[serde(with = "sparse")]
    bins: Vec<u64>,
}

impl SampleSums {
    /// The sums of no samples, for a package with this height quantum.
    #[must_use]
    pub fn new(quantum_m: f64) -> Self {
        Self { quantum_m, on_tin: 0, off_tin: 0, max_m: 0.0, squares: 0, bins: Vec::new() }
    }

    /// Adds a sample with its distance to the TIN; `None` if there is no triangle at the sample.
    #[inline]
    pub fn add(&mut self, distance_m: Option<f64>) {
        let Some(distance_m) = distance_m else {
            self.off_tin += 1;
            return;
        };
        self.on_tin += 1;
        self.max_m = self.max_m.max(distance_m);
        let quanta = distance_m / self.quantum_m;
        let parts = round((quanta * PARTS_TO_A_QUANTUM).min(MOST_PARTS));
        self.squares += u128::from(parts) * u128::from(parts);
        let bin = bin_of(quanta as u64);
        if bin >= self.bins.len() {
            self.bins.resize(bin + 1, 0);
        }
        self.bins[bin] += 1;
    }

    /// Adds the samples of `other`.
    pub fn merge(&mut self, other: &Self) {
        self.on_tin += other.on_tin;
        self.off_tin += other.off_tin;
        self.max_m = self.max_m.max(other.max_m);
        self.squares += other.squares;
        if other.bins.len() > self.bins.len() {
            self.bins.resize(other.bins.len(), 0);
        }
        for (own, &others) in self.bins.iter_mut().zip(&other.bins) {
            *own += others;
        }
    }

    /// The numbers that the package stores.
    #[must_use]
    pub fn record(&self) -> SampleErrorRecord {
        let part_m = self.quantum_m / PARTS_TO_A_QUANTUM;
        let mean = self.squares as f64 / self.on_tin.max(1) as f64;
        SampleErrorRecord {
            on_tin: self.on_tin,
            off_tin: self.off_tin,
            max_m: self.max_m,
            rms_m: (mean.sqrt() * part_m).min(self.max_m),
            p99_m: self.p99_m(),
        }
    }

    /// The distance that 99 % of the samples do not exceed: the end of its bin, at most the largest
    /// distance.
    fn p99_m(&self) -> f64 {
        let wanted = self.on_tin - self.on_tin / 100;
        let mut seen = 0;
        for (bin, &count) in self.bins.iter().enumerate() {
            seen += count;
            let end = end_of(bin);
            // The last bin also holds all distances beyond 64 bits.
            if seen >= wanted && end < 2_f64.powi(63) {
                return (end * self.quantum_m).min(self.max_m);
            }
        }
        self.max_m
    }
}

/// Most bins of a tile are empty, so only pairs of bin and count are written.
mod sparse {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(crate) fn serialize<S: Serializer>(bins: &[u64], serializer: S) -> Result<S::Ok, S::Error> {
        let filled = bins.iter().enumerate().filter(|&(_, &count)| count > 0);
        filled.map(|(bin, &count)| (bin as u32, count)).collect::<Vec<_>>().serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<u64>, D::Error> {
        let mut bins = Vec::new();
        for (bin, count) in Vec::<(u32, u64)>::deserialize(deserializer)? {
            if bins.len() <= bin as usize {
                bins.resize(bin as usize + 1, 0);
            }
            bins[bin as usize] = count;
        }
        Ok(bins)
    }
}

/// Rounds a number from 0 to [`MOST_PARTS`], half up. `f64::round` is a function call on the
/// processors for which the programs are compiled.
#[inline]
fn round(number: f64) -> u64 {
    let whole = number as i64;
    (whole + i64::from(number - whole as f64 >= 0.5)) as u64
}

/// The bin of a distance of this many whole quanta.
fn bin_of(quanta: u64) -> usize {
    // The number of times that the distance is halved until it is less than 2 · `FINE_BINS`.
    let halved = (quanta / FINE_BINS).checked_ilog2().unwrap_or(0);
    if quanta < FINE_BINS {
        quanta as usize
    } else {
        (u64::from(halved) * FINE_BINS + (quanta >> halved)) as usize
    }
}

/// The end of a bin, in quanta.
fn end_of(bin: usize) -> f64 {
    let bin = bin as u64;
    if bin < FINE_BINS {
        return (bin + 1) as f64;
    }
    let halved = bin / FINE_BINS - 1;
    ((bin - halved * FINE_BINS + 1) as f64) * 2_f64.powi(halved as i32)
}

#[cfg(test)]
#[path = "sample_sums_tests.rs"]
mod tests;
