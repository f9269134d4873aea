//! One elevation file: how it is to be understood, what it says about itself, and its samples as
//! metres.

pub(crate) mod source;
pub(crate) mod stored_values;
