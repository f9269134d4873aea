//! Creates a large elevation raster from a small real one: for measuring, not for maps.
//!
//! ```sh
//! cargo run -p corniche-testing --features rasters --example repeat_dem -- SOURCE OUT.tif SIDE [SEED]
//! ```
//!
//! `OUT.tif` has `SIDE` × `SIDE` samples with the spacing of the source: 20000 results in 400
//! million. The source is in the middle, surrounded by mirrored copies, so that there are no steps.
//! A smooth field of ±60 m over it differs everywhere, so no two tiles are the same. Voids remain
//! voids. The same arguments give the same bytes. Samples are 16-bit integers in metres, in
//! compressed tiles of 512 × 512.
#![allow(clippy::print_stderr, reason = "a program to run by hand")]

use std::{error::Error, process::ExitCode};

use corniche_testing::{Random, raster_creation_options};
use gdal::{
    Dataset, DriverManager,
    raster::{Buffer, GdalDataType},
};

/// The nodata value of the output, and of the source if it declares none.
const VOID: i16 = i16::MIN;
/// Side of a tile of the file in samples.
const BLOCK: usize = 512;

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let parsed = match args.as_slice() {
        [source, out, side] => side.parse().map(|side| (source, out, side, 1)).ok(),
        [source, out, side, seed] => match (side.parse(), seed.parse()) {
            (Ok(side), Ok(seed)) => Some((source, out, side, seed)),
            _ => None,
        },
        _ => None,
    };
    let Some((source, out, side, seed)) = parsed.filter(|&(_, _, side, _)| side > 0) else {
        eprintln!("usage: repeat_dem SOURCE OUT.tif SIDE [SEED]");
        return ExitCode::from(2);
    };
    match Source::open(source).and_then(|source| source.repeat(out, side, &Field { seed })) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: cannot create {out} from {source}: {error}");
            ExitCode::FAILURE
        }
    }
}

/// The small raster.
struct Source {
    dataset: Dataset,
    columns: usize,
    rows: usize,
    /// Heights in metres, row by row from the north.
    heights_m: Vec<f32>,
    nodata: f32,
}

impl Source {
    fn open(path: &str) -> Result<Self, Box<dyn Error>> {
        let dataset = Dataset::open(path)?;
        let (columns, rows) = dataset.raster_size();
        if columns < 2 || rows < 2 {
            return Err("the source must have at least 2 × 2 samples".into());
        }
        let band = dataset.rasterband(1)?;
        let nodata = band.no_data_value().unwrap_or(f64::from(VOID)) as f32;
        let buffer = band.read_as::<f32>((0, 0), (columns, rows), (columns, rows), None)?;
        Ok(Self { columns, rows, heights_m: buffer.into_shape_and_vec().1, nodata, dataset })
    }

    fn repeat(&self, out: &str, side: usize, field: &Field) -> Result<(), Box<dyn Error>> {
        let driver = DriverManager::get_driver_by_name("GTiff")?;
        let block = format!("BLOCKXSIZE={BLOCK}");
        let rows = format!("BLOCKYSIZE={BLOCK}");
        let options =
            ["TILED=YES", &block, &rows, "COMPRESS=DEFLATE", "PREDICTOR=2", "BIGTIFF=IF_SAFER"];
        let options = raster_creation_options(&options);
        let mut target =
            driver.create_with_band_type_with_options::<i16, _>(out, side, side, 1, &options)?;
        // The number of samples north and west of the source.
        let before = [self.columns, self.rows].map(|source| (side as i64 - source as i64) / 2);
        let mut place = self.dataset.geo_transform()?;
        let [west, north] = before.map(|samples| samples as f64);
        place[0] -= west * place[1] + north * place[2];
        place[3] -= west * place[4] + north * place[5];
        target.set_geo_transform(&place)?;
        target.set_spatial_ref(&self.dataset.spatial_ref()?)?;
        let mut band = target.rasterband(1)?;
        assert_eq!(band.band_type(), GdalDataType::Int16);
        band.set_no_data_value(Some(f64::from(VOID)))?;
        let columns: Vec<usize> =
            (0..side).map(|column| mirrored(column as i64 - before[0], self.columns)).collect();
        for first in (0..side).step_by(BLOCK) {
            let rows = BLOCK.min(side - first);
            let mut values = Vec::with_capacity(rows * side);
            for row in first..first + rows {
                let from = mirrored(row as i64 - before[1], self.rows) * self.columns;
                let added_m = field.row(row as u64, side);
                values.extend(columns.iter().zip(added_m).map(|(column, added_m)| {
                    let height_m = self.heights_m[from + column];
                    let is_void = height_m.is_nan() || height_m.to_bits() == self.nodata.to_bits();
                    if is_void { VOID } else { (f64::from(height_m) + added_m).round() as i16 }
                }));
            }
            band.write((0, first as isize), (side, rows), &mut Buffer::new((side, rows), values))?;
        }
        target.close()?;
        Ok(())
    }
}

/// Returns the index of the sample, out of `count`, at `index` of a line that is mirrored at both
/// ends, again and again.
fn mirrored(index: i64, count: usize) -> usize {
    let last = count as i64 - 1;
    let at = index.rem_euclid(2 * last);
    at.min(2 * last - at) as usize
}

/// The field that is added to heights: random values at the knots of two lattices, with a smooth
/// transition in between.
struct Field {
    seed: u64,
}

impl Field {
    /// The spacing of the knots in samples, and the largest value at a knot in metres.
    const OCTAVES: [(u64, f64); 2] = [(311, 52.0), (41, 8.0)];

    /// Returns the first `count` values of a row.
    fn row(&self, row: u64, count: usize) -> Vec<f64> {
        let mut sums = vec![0.0; count];
        for (octave, (spacing, height_m)) in (0..).zip(Self::OCTAVES) {
            let south = smooth(row, spacing);
            let knots: Vec<f64> = (0..=count as u64 / spacing + 1)
                .map(|column| {
                    let [upper, lower] = [0, 1].map(|below| {
                        let mixed = [self.seed, octave, column, row / spacing + below]
                            .iter()
                            .fold(0, |mixed, part| Random::new(mixed ^ part).bits());
                        Random::new(mixed).share() * 2.0 - 1.0
                    });
                    height_m * (upper + (lower - upper) * south)
                })
                .collect();
            for (column, sum) in (0..).zip(&mut sums) {
                let knot = (column / spacing) as usize;
                *sum += knots[knot] + (knots[knot + 1] - knots[knot]) * smooth(column, spacing);
            }
        }
        sums
    }
}

/// Rises from 0 at a knot to 1 at the next, flat at both.
fn smooth(index: u64, spacing: u64) -> f64 {
    let share = (index % spacing) as f64 / spacing as f64;
    share * share * share * (share * (share * 6.0 - 15.0) + 10.0)
}
