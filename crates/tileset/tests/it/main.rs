//! Integration tests of `corniche-tileset`, in one binary. The first line of each module says what holds.

mod damage;
mod package;
mod sizes;
mod version_1;
