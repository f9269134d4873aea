//! Whether a grid asks for far more nodes than the files have samples.

use crate::plan::sample_steps::{samples_to_a_cell, steps_m};
use crate::{Dem, DemError, GridPlan};

/// More nodes than this per sample, along either axis, are probably a mistake: they are interpolated, cost as much as
/// nodes with data of their own, and add no information.
const MOST_NODES_PER_SAMPLE: f64 = 16.0;
/// Tolerance for the rounding of a spacing.
const ROUNDING: f64 = 1.0 + 1e-9;

impl Dem {
    /// Refuses a grid with more than 16 nodes to a sample of even the finest files, along either axis.
    ///
    /// # Errors
    /// [`DemError::Oversampling`] where it is so, and when a spacing cannot be found.
    pub fn refuse_oversampling(&self, plan: &GridPlan) -> Result<(), DemError> {
        let cell = plan.frame.cell();
        let mut fewest: Option<f64> = None;
        for (mosaic, role) in self.mosaics.iter().zip(&plan.roles) {
            let steps = steps_m(mosaic, &plan.working, &role.working_from_crs)?;
            let Some(samples) = steps.map(|steps| samples_to_a_cell(steps, cell)) else {
                continue;
            };
            let nodes = samples[0].recip().max(samples[1].recip());
            fewest = Some(fewest.map_or(nodes, |fewest| fewest.min(nodes)));
        }
        match fewest {
            Some(nodes) if nodes > MOST_NODES_PER_SAMPLE * ROUNDING => {
                Err(DemError::Oversampling { cell, nodes, limit: MOST_NODES_PER_SAMPLE })
            }
            _ => Ok(()),
        }
    }
}
