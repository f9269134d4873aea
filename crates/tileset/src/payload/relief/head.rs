//! The fixed part of the relief section.

use corniche_varints::zigzag;
#[cfg(feature = "write")]
use corniche_varints::{push_varint, to_zigzag};

use crate::payload::{
    damage::{Damage, Result},
    number_codes::Cursor,
};

/// Number of quantisation steps: one for the smooth band, then three for each division, the
/// coarsest first.
pub(crate) const BANDS: usize = 1 + 3 * super::wavelet::LEVELS;
/// The largest quantisation step, in units.
pub(crate) const MOST_STEP: u64 = 1 << 16;
/// The largest slope factor.
pub(crate) const MOST_FACTOR: u64 = 1 << 16;
/// The largest absolute exponent of a unit; units are powers of two.
pub(crate) const MOST_EXPONENT: i32 = 64;
/// Heights, including decoded ones, have fewer units than this.
pub(crate) const MOST_UNITS: u64 = 1 << 40;

/// The fields that the decoder needs before the first bit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ReliefHead {
    /// Whether a mask follows: some nodes have no height.
    pub has_voids: bool,
    /// Whether a second mask follows: some nodes are water.
    pub has_water: bool,
    /// A unit is 2 to this power, in metres.
    pub exponent: i32,
    /// Slope factors east and north: 256ths of slope per unit of the difference between the nodes
    /// on both sides; in 65 536ths.
    pub slope_factors: [i64; 2],
    /// Quantisation steps in units.
    pub steps: [i64; BANDS],
    /// Largest error of a height in units.
    pub greatest_error: u64,
}

/// The length of a unit in metres.
pub(crate) fn unit_m(exponent: i32) -> f64 {
    2_f64.powi(exponent)
}

impl ReliefHead {
    #[cfg(feature = "write")]
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let mut out = vec![u8::from(self.has_voids) | u8::from(self.has_water) << 1];
        push_varint(&mut out, to_zigzag(i64::from(self.exponent)));
        for number in self.slope_factors.iter().chain(&self.steps) {
            push_varint(&mut out, number.unsigned_abs());
        }
        push_varint(&mut out, self.greatest_error);
        out
    }

    pub(crate) fn read(cursor: &mut Cursor<'_>) -> Result<Self> {
        let flags = cursor.byte()?;
        Damage::invalid_if(flags > 3, "the flags of the relief")?;
        let [has_voids, has_water] = [flags & 1 == 1, flags & 2 == 2];
        let exponent = i32::try_from(zigzag(cursor.varint()?)).ok();
        let exponent = exponent
            .filter(|exponent| (-MOST_EXPONENT..=MOST_EXPONENT).contains(exponent))
            .ok_or(Damage::Invalid("the unit of the relief"))?;
        let mut number = |least: u64, most: u64, what| {
            let value = cursor.varint()?;
            if (least..=most).contains(&value) { Ok(value) } else { Err(Damage::Invalid(what)) }
        };
        let mut slope_factors = [0; 2];
        for factor in &mut slope_factors {
            *factor = number(0, MOST_FACTOR, "a slope factor of the relief")? as i64;
        }
        let mut steps = [0; BANDS];
        for step in &mut steps {
            *step = number(1, MOST_STEP, "a quantisation step of the relief")? as i64;
        }
        let greatest_error = number(0, MOST_UNITS, "the greatest error of the relief")?;
        Ok(Self { has_voids, has_water, exponent, slope_factors, steps, greatest_error })
    }
}
