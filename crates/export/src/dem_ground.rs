//! The ground of the elevation files themselves, bilinear between their samples, and lines that lie on it.

mod dem_nodes;
mod lay;

pub(crate) use dem_nodes::DemNodes;
pub(crate) use lay::{DemLine, lay, off_dem_m, places_between};
