//! The work on one tile: heights to TIN, TIN to deviations, roads on the TIN, and encoding of
//! payload and record.

pub(crate) mod encode;
pub(crate) mod measure;
pub(crate) mod mesh;
pub(crate) mod record;
pub(crate) mod relief;
