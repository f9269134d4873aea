//! Integration tests of `corniche-export`, in one binary. The first line of each module states what
//! it tests.

mod layers;
mod small_package;
