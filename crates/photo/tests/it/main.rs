//! Integration tests of `corniche-photo`, in one binary. The first line of each module states what
//! it tests.

mod photos;
