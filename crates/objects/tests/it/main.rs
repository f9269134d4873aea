//! Integration tests of `corniche-objects`, in one binary. The first line of each module says what
//! it tests.

mod place;
mod reading;
mod support;
mod writing;
