//! The fixed part of the terrain section, and the limits of its numbers.

use corniche_geom::Cell;
#[cfg(feature = "write")]
use corniche_varints::push_varint;

use crate::{
    limits::MAX_TRIANGLES,
    payload::{
        damage::{Damage, Result, refuse_if},
        number_codes::Cursor,
    },
};
use corniche_settings::MAX_MEASURE_M;

/// The fixed part of the section.
pub(crate) struct TerrainSectionHead {
    pub geometric_error_m: f64,
    pub height_range_m: [f64; 2],
    pub uncovered_nodes: u64,
    pub triangles: usize,
    /// All heights are multiples of 2^`height_shift` steps: a DEM in whole metres has no finer
    /// heights.
    pub height_shift: u8,
    /// All normals are multiples of 2^`normal_shift` steps.
    pub normal_shift: u8,
}

/// The largest exponent of the common factor of heights.
pub(crate) const MAX_HEIGHT_SHIFT: u8 = 31;
/// The largest exponent of the common factor of normals.
pub(crate) const MAX_NORMAL_SHIFT: u8 = 7;

impl TerrainSectionHead {
    #[cfg(feature = "write")]
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let mut out = Vec::new();
        for measure in [self.geometric_error_m, self.height_range_m[0], self.height_range_m[1]] {
            out.extend(measure.to_le_bytes());
        }
        push_varint(&mut out, self.uncovered_nodes);
        push_varint(&mut out, self.triangles as u64);
        out.extend([self.height_shift, self.normal_shift]);
        out
    }

    pub(crate) fn read(cursor: &mut Cursor<'_>, scale: Scale) -> Result<Self> {
        let [geometric_error_m, lowest_m, highest_m] =
            [(); 3].map(|()| cursor.array().map(f64::from_le_bytes));
        let (geometric_error_m, height_range_m) = (geometric_error_m?, [lowest_m?, highest_m?]);
        let uncovered_nodes = cursor.varint()?;
        check_measures(geometric_error_m, height_range_m, uncovered_nodes, scale)
            .map_err(Damage::Invalid)?;
        let triangles = cursor.varint()?;
        Damage::limit("number of triangles", triangles, MAX_TRIANGLES)?;
        let [height_shift, normal_shift] = cursor.array()?;
        Damage::invalid_if(height_shift > MAX_HEIGHT_SHIFT, "the common factor of the heights")?;
        Damage::invalid_if(normal_shift > MAX_NORMAL_SHIFT, "the common factor of the normals")?;
        let triangles = triangles as usize;
        Ok(Self {
            geometric_error_m,
            height_range_m,
            uncovered_nodes,
            triangles,
            height_shift,
            normal_shift,
        })
    }
}

/// The factors that turn slopes of the TIN, in height steps per node, into metres per metre.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scale {
    pub quantum_m: f64,
    /// The cell of the level.
    pub cell: Cell,
    /// The largest number of full-resolution nodes beneath the tile; border nodes of its finest
    /// tiles count for each of these tiles.
    pub nodes_beneath: u64,
}

/// Checks the numbers that a tile states about itself: they must be finite, so that later code need
/// not check, and possible.
pub(crate) fn check_measures(
    geometric_error_m: f64,
    height_range_m: [f64; 2],
    uncovered_nodes: u64,
    scale: Scale,
) -> Result<(), &'static str> {
    refuse_if(!(0.0..=MAX_MEASURE_M).contains(&geometric_error_m), "the geometric error")?;
    let [low, high] = height_range_m;
    refuse_if(
        !(low <= high && low >= -MAX_MEASURE_M && high <= MAX_MEASURE_M),
        "the height range",
    )?;
    refuse_if(uncovered_nodes > scale.nodes_beneath, "the number of uncovered nodes")?;
    Ok(())
}
