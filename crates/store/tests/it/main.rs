//! Integration tests of `corniche-store`, in one binary. The first line of each module states what
//! it tests.

mod common;
mod faults;
mod local_store;
mod long_names;
mod own_files;
mod parts;
