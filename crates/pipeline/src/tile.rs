//! The work on one tile: heights to TIN, TIN to deviations, roads on the TIN, all of it to bytes and to a record.

pub(crate) mod encode;
pub(crate) mod measure;
pub(crate) mod mesh;
pub(crate) mod record;
pub(crate) mod relief;
