//! The step between distinguishable heights is found by reading all samples.

use std::{fs, path::PathBuf};

use corniche_dem::{Audit, SURFACE_RANGE_M};

use super::fixture;

/// An ASCII grid of 40 × 30 samples, each written by `text`.
fn grid(
    folder: &tempfile::TempDir,
    name: &str,
    left: f64,
    text: impl Fn(i32) -> String,
) -> PathBuf {
    let mut rows = format!("ncols 40\nnrows 30\nxllcorner {left}\nyllcorner 47\ncellsize 0.001\n");
    for row in 0..30 {
        let values: Vec<String> = (0..40).map(|column| text(400 + row + column % 7)).collect();
        rows += &values.join(" ");
        rows += "\n";
    }
    let path = folder.path().join(name);
    fs::write(&path, rows).unwrap();
    fs::write(path.with_extension("prj"), "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433],AUTHORITY[\"EPSG\",\"4326\"]]").unwrap();
    path
}

fn step_m(files: &[PathBuf]) -> f64 {
    let dem = fixture::open(files);
    let plan = fixture::plan(&dem);
    let mut audit = Audit::none_of(&dem, SURFACE_RANGE_M);
    let mut auditor = dem.auditor(SURFACE_RANGE_M);
    for block in dem.audit_blocks(&plan).unwrap() {
        audit.merge(&auditor.look(&block).unwrap());
    }
    audit.height_step_m(&dem)
}

#[test]
fn the_step_of_heights_is_that_of_whole_numbers_where_all_are_whole() {
    let folder = fixture::folder();
    let whole = grid(&folder, "whole.asc", 9.0, |height| height.to_string());
    let floats = grid(&folder, "floats.asc", 9.04, |height| format!("{height}.0"));
    // Few of 1200 samples are enough.
    let one = grid(&folder, "one.asc", 9.08, |height| {
        if height == 435 { "435.5".to_owned() } else { format!("{height}.0") }
    });
    let feet = folder.path().join("feet.vrt");
    fs::write(
        &feet,
        "<VRTDataset rasterXSize=\"40\" rasterYSize=\"30\"><SRS>EPSG:4326</SRS>\
         <GeoTransform>9, 0.001, 0, 47.03, 0, -0.001</GeoTransform>\
         <VRTRasterBand dataType=\"Int32\" band=\"1\"><UnitType>ft</UnitType><Scale>0.5</Scale>\
         <SimpleSource><SourceFilename relativeToVRT=\"1\">whole.asc</SourceFilename></SimpleSource>\
         </VRTRasterBand></VRTDataset>",
    )
    .unwrap();
    let of = |file: &PathBuf| step_m(std::slice::from_ref(file));
    assert_eq!([of(&whole), of(&floats), of(&one)], [1.0, 1.0, 0.0]);
    assert!((of(&feet) - 0.1524).abs() < 1e-9);
    // Of several files, the smallest.
    assert_eq!(step_m(&[whole.clone(), floats]), 1.0);
    assert_eq!(step_m(&[whole, one]), 0.0);
}
