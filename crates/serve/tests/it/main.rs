//! Integration tests of `corniche-serve`, in one binary. The first line of each module says what holds.

mod connections;
mod serving;
