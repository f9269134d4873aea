//! Integration tests of `corniche-tin`, in one binary. The first line of each module states what it
//! tests.

mod extremes;
mod triangulated;
