//! The grid of a package: working CRS, cell, extent, and how nodes get their heights from samples.

pub(crate) mod grid_plan;
pub(crate) mod planning;

pub(crate) mod clip;
pub(crate) mod layout;
pub(crate) mod sample_steps;
pub(crate) mod working_crs;

pub(crate) mod kernel;
pub(crate) mod node_positions;

pub(crate) mod datum_operations;
pub(crate) mod description;
pub(crate) mod footprint;
