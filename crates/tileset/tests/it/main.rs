//! Integration tests of `corniche-tileset`, in one binary. The first line of each module states
//! what it tests.

mod damage;
mod package;
mod sizes;
mod sv_tails;
mod version_2;
