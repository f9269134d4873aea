//! Integration tests of `corniche-export`, in one binary. The first line of each module says what holds.

mod small_package;
