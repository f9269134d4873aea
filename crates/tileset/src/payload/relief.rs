//! The relief of a tile: the raster of its level, compressed for shading.
//!
//! ```text
//!   heights ─► whole units ─► wavelet ─► quantised ─► range coder ─► bytes
//!   slopes of the border nodes ─► whole 256ths ─► minus those of the decoded heights ─┘
//! ```
//!
//! Shading shows slopes, so coefficients are quantised by how much they change slopes ([`steps`]).
//! The remaining errors differ from tile to tile, and would be visible along a border. So the
//! slopes of border nodes are stored separately, and all tiles that have a node compute its slopes
//! from the same heights.

mod border;
mod coefficients;
#[cfg(feature = "write")]
mod fill;
mod head;
mod quantise;
#[cfg(feature = "write")]
mod steps;
#[cfg(feature = "write")]
mod water;
mod wavelet;

use corniche_geom::{Cell, HeightGrid};

#[cfg(feature = "write")]
use crate::payload::range_coder::BitWriter;
use crate::payload::{
    damage::{Damage, Result},
    number_codes::Cursor,
    range_coder::{BitReader, Bits},
};
use border::BORDER_NODES;
use coefficients::{NumberModel, code_band, code_mask, code_smooth};
use head::ReliefHead;
use wavelet::{LEVELS, SIDE, SMOOTH, rough_bands};

/// The relief of a tile: heights of all its nodes, which are exact enough for shading, and the
/// slopes of the nodes on its border, which are the same in all tiles that have the node.
#[derive(Debug, Clone)]
pub struct Relief {
    coded: Vec<u8>,
    heights: HeightGrid,
    greatest_error_m: f64,
    /// The slopes of the border nodes, by [`border::index`]; `None` if the node has no height.
    border: Vec<Option<[i32; 2]>>,
    /// Marks of water, row by row; empty if there is no water.
    water: Vec<bool>,
}

// All other fields follow from the bytes.
impl PartialEq for Relief {
    fn eq(&self, other: &Self) -> bool {
        self.coded == other.coded
    }
}

impl Relief {
    /// Heights of the tile's own 257 × 257 nodes in metres; row 0 is in the north. Gaps are those
    /// of the level's raster.
    #[must_use]
    pub fn heights(&self) -> &HeightGrid {
        &self.heights
    }

    /// Which of the tile's own nodes are water, row by row: nodes at or below 0 m whose neighbours
    /// have the same height. `None` if there are none.
    #[must_use]
    pub fn water(&self) -> Option<&[bool]> {
        (!self.water.is_empty()).then_some(&self.water[..])
    }

    /// The largest distance of a height from the level's raster, apart from the rounding to 32-bit
    /// numbers.
    #[must_use]
    pub fn greatest_error_m(&self) -> f64 {
        self.greatest_error_m
    }

    /// The rise in metres per metre east and per metre north at a node on the tile's border, in
    /// whole 256ths: the slopes of the raster, rounded. `None` if the node has no height or is not
    /// on the border.
    #[must_use]
    pub fn border_slope(&self, column: usize, row: usize) -> Option<[f64; 2]> {
        let steps = self.border[border::index(column, row)?]?;
        Some(steps.map(|steps| f64::from(steps) / border::STEPS_PER_ONE))
    }

    /// The rise in metres per metre east and per metre north at all nodes, row by row, row 0 in the
    /// north; `cell` is the spacing of its nodes. On the border these are the stored slopes, inside
    /// the slopes of the heights, by the rule of vertex normals ([`corniche_tin::gradient`]). Nodes
    /// without a height are level.
    pub fn slopes(&self, cell: Cell) -> impl Iterator<Item = [f64; 2]> {
        let last = SIDE - 1;
        (0..SIDE).flat_map(move |row| {
            (0..SIDE).map(move |column| {
                if (1..last).contains(&column) && (1..last).contains(&row) {
                    corniche_tin::gradient(&self.heights, [column, row], cell)
                } else {
                    self.border_slope(column, row).unwrap_or_default()
                }
            })
        })
    }

    /// The number of bytes in memory.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        let (heights, border) = (self.heights.raw(), &self.border[..]);
        self.coded.len() + size_of_val(heights) + size_of_val(border) + self.water.len()
    }

    /// The bytes of the relief in a payload.
    #[cfg(feature = "write")]
    pub(crate) fn coded(&self) -> &[u8] {
        &self.coded
    }

    /// Compresses the raster of a tile's level. `with_halo` has the tile's 257 × 257 nodes and one
    /// more node on every side, `cell` is the spacing of its nodes, `quantum_m` is the package's
    /// height step. All tiles of a level must have the same `cell` and `quantum_m`. Equal heights
    /// result in equal bytes on every processor.
    ///
    /// `shown` is the raster that is coded and from which slopes are computed: the raster itself,
    /// or a low-pass filtered one. Gaps and water are those of the raster, and so is the reference
    /// of the error.
    ///
    /// # Errors
    /// When something cannot be encoded: a tile without any height, or heights of 2^38 units and
    /// more (a unit is a 512th of the cell or a 64th of the height step, whichever is larger).
    ///
    /// # Panics
    /// When a grid has another size.
    #[cfg(feature = "write")]
    pub fn of_heights(
        with_halo: &HeightGrid,
        shown: &HeightGrid,
        cell: Cell,
        quantum_m: f64,
    ) -> Result<Self, &'static str> {
        for grid in [with_halo, shown] {
            assert_eq!([grid.columns(), grid.rows()], [SIDE + 2; 2], "a tile with its halo");
        }
        let exponent = steps::unit_exponent(cell, quantum_m);
        let (mask, of_raster) = fill::whole_units(with_halo, head::unit_m(exponent))?;
        let (_, units) = fill::whole_units(shown, head::unit_m(exponent))?;
        let steps = steps::of_cell(cell, head::unit_m(exponent));
        let mut square = units;
        wavelet::forward(&mut square);
        quantise::quantise(&mut square, &steps);
        let mut found = square.clone();
        let unencodable = |_| "heights outside the range of the code";
        quantise::reconstruct(&mut found, &steps).map_err(unencodable)?;
        let errors = of_raster.iter().zip(&found).zip(&mask).filter(|(_, there)| **there);
        // Half a unit more, for the rounding to whole units.
        let error = errors.map(|((unit, found), _)| unit.abs_diff(*found)).max().unwrap_or(0) + 1;
        let water = water::of_raster(with_halo);
        let head = ReliefHead {
            has_voids: mask.iter().any(|there| !there),
            has_water: water.contains(&true),
            exponent,
            slope_factors: steps::slope_factors(cell, head::unit_m(exponent)),
            steps,
            greatest_error: error,
        };
        let border = border::of_raster(shown, cell);
        let mut parts = Parts { mask, water, square, border };
        let mut writer = BitWriter::new(head.to_bytes());
        let units = parts.code(&mut writer, &head).map_err(unencodable)?;
        Ok(Self::assemble(writer.finish(), &head, &units, parts))
    }

    /// Decodes the bytes of [`Relief::coded`]. Memory and time do not depend on the content of the
    /// bytes.
    pub(crate) fn decode(bytes: &[u8]) -> Result<Self> {
        let mut cursor = Cursor::new(bytes);
        let head = ReliefHead::read(&mut cursor)?;
        let mut reader = BitReader::new(&bytes[bytes.len() - cursor.left()..]);
        let mut parts = Parts::new();
        let units = parts.code(&mut reader, &head)?;
        Damage::invalid_if(!reader.is_exact(), "the length of the relief")?;
        Ok(Self::assemble(bytes.to_vec(), &head, &units, parts))
    }

    fn assemble(coded: Vec<u8>, head: &ReliefHead, units: &[i64], parts: Parts) -> Self {
        let unit_m = head::unit_m(head.exponent);
        let heights_m = units
            .iter()
            .zip(&parts.mask)
            .map(|(&units, &there)| if there { (units as f64 * unit_m) as f32 } else { f32::NAN })
            .collect();
        Self {
            coded,
            heights: HeightGrid::new(SIDE, SIDE, heights_m),
            greatest_error_m: head.greatest_error as f64 * unit_m,
            border: parts.border,
            water: if head.has_water { parts.water } else { Vec::new() },
        }
    }
}

/// The values that are coded after the head.
struct Parts {
    /// Whether each node has a height.
    mask: Vec<bool>,
    /// Whether each node is water.
    water: Vec<bool>,
    /// Quantised coefficients.
    square: Vec<i64>,
    border: Vec<Option<[i32; 2]>>,
}

impl Parts {
    /// Returns the values with which a reader begins.
    fn new() -> Self {
        Self {
            mask: vec![true; SIDE * SIDE],
            water: vec![false; SIDE * SIDE],
            square: vec![0; SIDE * SIDE],
            border: vec![None; BORDER_NODES],
        }
    }

    /// Codes all values, in either direction, and returns the heights in units.
    fn code<B: Bits>(&mut self, bits: &mut B, head: &ReliefHead) -> Result<Vec<i64>> {
        if head.has_voids {
            code_mask(bits, &mut self.mask);
        }
        if head.has_water {
            code_mask(bits, &mut self.water);
        }
        code_smooth(bits, &mut self.square, SMOOTH);
        // The coarse divisions share their models, because each of them has few numbers.
        let mut numbers = vec![[const { NumberModel::new() }; 3]; KINDS];
        for level in (0..LEVELS).rev() {
            for (k, band) in rough_bands(level).into_iter().enumerate() {
                let parent = (level + 1 < LEVELS).then(|| rough_bands(level + 1)[k]);
                let numbers = &mut numbers[level.min(KINDS - 1)][k];
                code_band(bits, numbers, &mut self.square, band, parent);
            }
        }
        let mut units = self.square.clone();
        quantise::reconstruct(&mut units, &head.steps)?;
        border::code(bits, &mut self.border, &units, &self.mask, head.slope_factors)?;
        Ok(units)
    }
}

/// Number of groups of divisions with their own models: the finest, the next, all others.
const KINDS: usize = 3;

#[cfg(all(test, feature = "write"))]
#[path = "relief_tests.rs"]
mod tests;
