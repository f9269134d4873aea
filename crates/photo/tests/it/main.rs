//! Integration tests of `corniche-photo`, in one binary. The first line of each module says what
//! holds.

mod photos;
