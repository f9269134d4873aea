//! Integration tests of `corniche-remote`, in one binary. The first line of each module says what holds.

mod misbehaving;
mod reading;
mod support;
