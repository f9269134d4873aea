//! Converts heights to whole units, with values that compress well for nodes without a height.

use corniche_geom::HeightGrid;

use super::wavelet::SIDE;
use crate::payload::damage::refuse_if;

/// Heights have fewer units than this.
const MOST_UNITS: f64 = (1_u64 << 38) as f64;

/// Returns which of the tile's own nodes have a height, and the heights of all of them in whole
/// units. Nodes without a height get the mean of the heights near them.
pub(crate) fn whole_units(
    with_halo: &HeightGrid,
    unit_m: f64,
) -> Result<(Vec<bool>, Vec<i64>), &'static str> {
    let mut mask = Vec::with_capacity(SIDE * SIDE);
    let mut units = Vec::with_capacity(SIDE * SIDE);
    for row in 1..=SIDE {
        for column in 1..=SIDE {
            let height_m = with_halo.height(column, row);
            // The unit is a power of two, so the division is exact.
            let height = height_m.map_or(0.0, |height_m| (f64::from(height_m) / unit_m).round());
            refuse_if(height.abs() >= MOST_UNITS, "heights of 2^38 units or more")?;
            mask.push(height_m.is_some());
            units.push(height as i64);
        }
    }
    refuse_if(!mask.contains(&true), "a tile without any height")?;
    if mask.contains(&false) {
        fill(&mut units, &mask);
    }
    Ok((mask, units))
}

/// Fills gaps from coarser and coarser rasters, in which each node is the mean of the four nodes
/// below it that have a height.
fn fill(units: &mut [i64], mask: &[bool]) {
    let own = units.iter().zip(mask).map(|(&height, &there)| there.then_some(height)).collect();
    let mut rasters: Vec<(usize, Vec<Option<i64>>)> = vec![(SIDE, own)];
    while let Some((side, below)) = rasters.last().filter(|(side, _)| *side > 1) {
        let half = side.div_ceil(2);
        let mean = |at: usize| {
            let (column, row) = (at % half * 2, at / half * 2);
            let (mut sum, mut count) = (0, 0);
            for (c, r) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let inside = column + c < *side && row + r < *side;
                if let Some(height) = inside.then(|| below[(row + r) * side + column + c]).flatten()
                {
                    sum += height;
                    count += 1;
                }
            }
            (count > 0).then(|| sum / count)
        };
        let above = (0..half * half).map(mean).collect();
        rasters.push((half, above));
    }
    for k in (1..rasters.len()).rev() {
        let (below, above) = rasters.split_at_mut(k);
        let ((side, below), (half, above)) = (&mut below[k - 1], &above[0]);
        for (at, height) in below.iter_mut().enumerate() {
            *height = height.or(above[at / *side / 2 * half + at % *side / 2]);
        }
    }
    for (height, filled) in units.iter_mut().zip(&rasters[0].1) {
        *height = filled.unwrap_or(*height);
    }
}
