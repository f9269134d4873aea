//! Long operations: their stages and progress, the observer that is informed and may cancel, worker
//! threads, and a cache that the threads share.
//!
//! This crate does not know what the work is.

mod locked;
mod observer;
mod recent;
mod stage;
pub mod workers;

pub use locked::locked;
pub use observer::{Interrupted, Observer, Silent};
pub use recent::Recent;
pub use stage::{Stage, Unit};
