//! Windows of heights from rasters created by GDAL, compared with closed forms, and from real data.
#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::float_cmp,
    reason = "tests: helpers unwrap too, and what is exact is compared exactly"
)]

mod all_real_data;
mod audit;
mod blocks;
mod bounds;
mod closed_form;
mod datum_operations;
mod datums;
mod fill_rule;
mod fixture;
mod formats;
mod georeference;
mod names;
mod own_crs;
mod own_grid;
mod polygon;
mod real_data;
mod refusals;
mod samples;
mod several_files;
mod vertical;
mod voids;
