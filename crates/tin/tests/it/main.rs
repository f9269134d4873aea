//! Integration tests of `corniche-tin`, in one binary. The first line of each module says what holds.

mod extremes;
mod triangulated;
