//! Long work: which stage it is in and how far, who is told of it and may end it, and the threads that share it.
//!
//! This crate never knows what the work is.

mod observer;
mod stage;
pub mod workers;

pub use observer::{Interrupted, Observer, Silent};
pub use stage::{Stage, Unit};
