//! The georeference of an image from above, in the package's CRS.

use corniche_tileset::Manifest;
use gdal::spatial_ref::SpatialRef;

use crate::{error::CoordinatesError, places::crs_of};

/// The georeference of an image from above.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaceOfPicture {
    /// The package's CRS as WKT2, without heights.
    crs_wkt: String,
    crs_from_pixel: [f64; 6],
}

impl PlaceOfPicture {
    /// Returns the georeference of an image of a package. `working_from_pixel` maps columns and
    /// rows, counted from the upper left corner, to working metres: x is
    /// `[0] + [1] · column + [2] · row`, and y follows likewise from the last three numbers, as in
    /// GDAL.
    ///
    /// # Errors
    /// When the package's CRS cannot be read.
    pub fn new(
        manifest: &Manifest,
        working_from_pixel: [f64; 6],
    ) -> Result<Self, CoordinatesError> {
        let crs_wkt = crs_of(manifest)?.wkt().to_owned();
        Ok(Self { crs_wkt, crs_from_pixel: in_units(working_from_pixel, manifest.metres_per_unit) })
    }

    /// The CRS as WKT2.
    #[must_use]
    pub fn crs(&self) -> &str {
        &self.crs_wkt
    }

    /// The transformation from columns and rows to the CRS, in GDAL's form: 0, 0 is the upper left
    /// corner of the first pixel.
    #[must_use]
    pub fn crs_from_pixel(&self) -> [f64; 6] {
        self.crs_from_pixel
    }

    /// The text of a world file, such as `map.pgw`: the steps along a row and down a column, and
    /// the middle of the first pixel.
    ///
    /// ```text
    ///   x of a column    y of a column    x of a row    y of a row    x of the middle    y of the middle
    /// ```
    #[must_use]
    pub fn world_file(&self) -> String {
        let [x, x_of_column, x_of_row, y, y_of_column, y_of_row] = self.crs_from_pixel;
        let middle_x = x + f64::midpoint(x_of_column, x_of_row);
        let middle_y = y + f64::midpoint(y_of_column, y_of_row);
        let numbers = [x_of_column, y_of_column, x_of_row, y_of_row, middle_x, middle_y];
        // Adding 0 removes the sign of a negative zero.
        let lines = numbers.map(|number| (number + 0.0).to_string()).join("\n");
        format!("{lines}\n")
    }

    /// The text of a `.prj` file: the CRS in Esri's WKT, which all programs that read such files
    /// understand. A CRS that Esri's WKT cannot express is written as WKT2.
    #[must_use]
    pub fn prj(&self) -> String {
        let esri = SpatialRef::from_definition(&self.crs_wkt)
            .and_then(|crs| crs.morph_to_esri().and_then(|()| crs.to_wkt()));
        let text = esri.ok().filter(|text| !text.is_empty());
        format!("{}\n", text.as_deref().unwrap_or(&self.crs_wkt))
    }
}

/// Converts the transformation to coordinates with this number of working metres to a unit, along
/// both axes.
fn in_units(working_from_pixel: [f64; 6], [unit_x, unit_y]: [f64; 2]) -> [f64; 6] {
    let [x, x_of_column, x_of_row, y, y_of_column, y_of_row] = working_from_pixel;
    let (along_x, along_y) = ([x, x_of_column, x_of_row], [y, y_of_column, y_of_row]);
    let ([a, b, c], [d, e, f]) = (along_x.map(|m| m / unit_x), along_y.map(|m| m / unit_y));
    [a, b, c, d, e, f]
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "place_of_picture_tests.rs"]
mod tests;
