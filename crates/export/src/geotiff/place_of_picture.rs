//! Where the pixels of a picture from above are, in the package's CRS.

use corniche_gis::RecordedCrs;
use corniche_tileset::Manifest;
use gdal::spatial_ref::SpatialRef;

use crate::error::CoordinatesError;

/// Where the pixels of a picture from above are.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaceOfPicture {
    /// The package's CRS as WKT2, without heights.
    crs_wkt: String,
    crs_from_pixel: [f64; 6],
}

impl PlaceOfPicture {
    /// The place of a picture of a package. `working_from_pixel` is the map from columns and rows, counted from the upper left corner, to working metres:
    /// x is `[0] + [1] · column + [2] · row`, and y is likewise that of the last three, as in GDAL.
    ///
    /// # Errors
    /// When the package's CRS cannot be read.
    pub fn new(
        manifest: &Manifest,
        working_from_pixel: [f64; 6],
    ) -> Result<Self, CoordinatesError> {
        let Manifest { crs_wkt, metres_per_unit, .. } = manifest;
        let crs = RecordedCrs::new(crs_wkt, *metres_per_unit, manifest.whole_data_bounds())?;
        let crs_from_pixel = in_units(working_from_pixel, *metres_per_unit);
        Ok(Self { crs_wkt: crs.wkt().to_owned(), crs_from_pixel })
    }

    /// The CRS as WKT2.
    #[must_use]
    pub fn crs(&self) -> &str {
        &self.crs_wkt
    }

    /// The map from columns and rows to the CRS, as GDAL has it: 0, 0 is the upper left corner of the first pixel.
    #[must_use]
    pub fn crs_from_pixel(&self) -> [f64; 6] {
        self.crs_from_pixel
    }

    /// The text of a world file, such as `map.pgw`: the steps along a row and down a column, and the middle of the first pixel.
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
        // Without the sign of a negative zero.
        let lines = numbers.map(|number| (number + 0.0).to_string()).join("\n");
        format!("{lines}\n")
    }

    /// The text of a file `.prj`: the CRS in the WKT of Esri, which all programs read that know such files. A CRS for which this has no words
    /// is written as WKT2.
    #[must_use]
    pub fn prj(&self) -> String {
        let esri = SpatialRef::from_definition(&self.crs_wkt)
            .and_then(|crs| crs.morph_to_esri().and_then(|()| crs.to_wkt()));
        let text = esri.ok().filter(|text| !text.is_empty());
        format!("{}\n", text.as_deref().unwrap_or(&self.crs_wkt))
    }
}

/// The same map to coordinates of which each has so many working metres along both axes.
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
