//! PROJ's operation from one vertical CRS to another, for the horizontal system of one file.

use corniche_geom::Bounds;

use crate::CrsError;
use crate::crs::horizontal::Crs;
use crate::crs::operation::CrsOperation;
use crate::crs::vertical::VerticalCrs;

/// Converts heights of one file to the target vertical CRS, sample by sample.
#[derive(Debug, Clone)]
pub struct HeightOperation {
    /// The operation from the horizontal system of the file to that of the ellipsoidal heights, if
    /// the two differ.
    place: Option<CrsOperation>,
    operation: CrsOperation,
    /// The change of the value in the source system for a metre upwards.
    values_per_m: f64,
    /// The metres upwards for a unit of the value in the target system.
    m_per_value: f64,
    target: String,
}

impl HeightOperation {
    /// The operation between two systems, for the horizontal system of a file.
    #[must_use]
    pub fn new(file: &Crs, [from, to]: [&VerticalCrs; 2], area_deg: Bounds) -> Self {
        let place = (from.is_ellipsoidal && from.wkt != file.wkt)
            .then(|| CrsOperation::new(file, &from.with(file), Some(area_deg)));
        Self {
            place,
            // PROJ may not replace a missing grid by an approximation.
            operation: CrsOperation::new(&from.with(file), &to.with(file), Some(area_deg))
                .exactly(),
            values_per_m: 1.0 / from.m_per_value(),
            m_per_value: to.m_per_value(),
            target: to.name.clone(),
        }
    }

    /// Converts values of the source system, at positions in the file's horizontal system, to
    /// values of the target.
    ///
    /// # Errors
    /// When PROJ knows no operation.
    pub fn carry(&self, mut points: Vec<[f64; 2]>, values: &mut [f64]) -> Result<(), CrsError> {
        if let Some(place) = &self.place {
            place.apply(&mut points)?;
        }
        self.operation.apply_heights(&points, values)
    }

    /// Converts heights in metres at positions in the file's horizontal system, in place; NaN if
    /// there is none.
    ///
    /// # Errors
    /// When PROJ knows no operation.
    pub fn carry_m(&self, points: Vec<[f64; 2]>, heights_m: &mut [f64]) -> Result<(), CrsError> {
        for height in heights_m.iter_mut() {
            *height *= self.values_per_m;
        }
        self.carry(points, heights_m)?;
        for height in heights_m {
            *height *= self.m_per_value;
        }
        Ok(())
    }

    /// The name of the target vertical CRS.
    #[must_use]
    pub fn target(&self) -> &str {
        &self.target
    }
}
