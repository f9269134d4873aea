//! The stages that only a build has, in their order. Those that `verify` repeats are in [`heights`](crate::heights) and
//! [`roads`](crate::roads).

pub(crate) mod deviations;
pub(crate) mod mesh;
pub(crate) mod package;
pub(crate) mod samples;
pub(crate) mod tiles;
