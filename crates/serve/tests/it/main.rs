//! Integration tests of `corniche-serve`, in one binary. The first line of each module states what
//! is tested.

mod connections;
mod serving;
