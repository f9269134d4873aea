//! Heights of the elevation files, judged and read: for the build, and once more for `verify`.

pub(crate) mod audit;
pub(crate) mod pyramid;
