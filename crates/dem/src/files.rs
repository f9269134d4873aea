//! One elevation file: the options that describe it, its metadata, and its samples in metres.

pub(crate) mod source;
pub(crate) mod stored_values;
