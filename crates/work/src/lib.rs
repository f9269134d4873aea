//! Long work: which stage it is in and how far, who is told of it and may end it, the threads that share it, and what they keep for each other.
//!
//! This crate never knows what the work is.

mod locked;
mod observer;
mod recent;
mod stage;
pub mod workers;

pub use locked::locked;
pub use observer::{Interrupted, Observer, Silent};
pub use recent::Recent;
pub use stage::{Stage, Unit};
