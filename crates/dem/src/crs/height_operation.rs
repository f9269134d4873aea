//! PROJ's operation from one vertical CRS to another, for the samples of one file.

use std::path::Path;

use corniche_geom::{Bounds, GeoTransform};

use crate::DemError;
use crate::crs::horizontal::Crs;
use crate::crs::operation::Operation;
use crate::crs::vertical::VerticalCrs;

/// Carries heights of one file to the vertical CRS asked for, sample by sample.
#[derive(Debug, Clone)]
pub(crate) struct HeightOperation {
    /// The operation from the horizontal system of the file to that of the ellipsoidal heights, where these differ.
    place: Option<Operation>,
    operation: Operation,
    /// Value in the source system for a metre upwards.
    values_per_m: f64,
    /// Metres upwards for a value in the target system.
    m_per_value: f64,
    target: String,
}

impl HeightOperation {
    /// Between two systems over the horizontal system of a file.
    pub(crate) fn new(file: &Crs, [from, to]: [&VerticalCrs; 2], area_deg: Bounds) -> Self {
        let place = (from.is_ellipsoidal && from.wkt != file.wkt)
            .then(|| Operation::new(file, &from.with(file), Some(area_deg)));
        Self {
            place,
            operation: Operation::exact(&from.with(file), &to.with(file), area_deg),
            values_per_m: 1.0 / from.m_per_value(),
            m_per_value: to.m_per_value(),
            target: to.name.clone(),
        }
    }

    /// Values of the source system, at positions in the file's horizontal one, to those of the target.
    pub(crate) fn carry(
        &self,
        mut points: Vec<[f64; 2]>,
        values: &mut [f64],
    ) -> Result<(), DemError> {
        if let Some(place) = &self.place {
            place.apply(&mut points)?;
        }
        self.operation.apply_heights(&points, values)
    }

    /// Carries heights in metres, in place; voids (NaN) stay.
    ///
    /// Each height is carried at the position of its own sample, counted in the whole file: the result does not
    /// depend on the rectangle that is read.
    pub(crate) fn apply(
        &self,
        path: &Path,
        crs_from_pixel: &GeoTransform,
        [column, row]: [usize; 2],
        columns: usize,
        heights_m: &mut [f64],
    ) -> Result<(), DemError> {
        let places: Vec<usize> =
            (0..heights_m.len()).filter(|&at| !heights_m[at].is_nan()).collect();
        let points: Vec<[f64; 2]> = places
            .iter()
            .map(|at| [(column + at % columns) as f64 + 0.5, (row + at / columns) as f64 + 0.5])
            .map(|pixel| crs_from_pixel.crs_from_pixel(pixel))
            .collect();
        let mut values: Vec<f64> =
            places.iter().map(|&at| heights_m[at] * self.values_per_m).collect();
        self.carry(points, &mut values)?;
        for (&at, value) in places.iter().zip(values) {
            if value.is_nan() {
                let (column, row) = (column + at % columns, row + at / columns);
                let to = self.target.clone();
                return Err(DemError::VerticalPosition {
                    path: path.to_path_buf(),
                    column,
                    row,
                    to,
                });
            }
            heights_m[at] = value * self.m_per_value;
        }
        Ok(())
    }
}
