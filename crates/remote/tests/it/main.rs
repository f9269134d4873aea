//! Integration tests of `corniche-remote`, in one binary. The first line of each module says what
//! it tests.

mod misbehaving;
mod reading;
mod support;
