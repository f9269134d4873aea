//! What a road is: its functional class, its attributes, its line, and its simplification per level.
//!
//! This crate never sees terrain or a file.

mod road;

pub use road::{Form, FunctionalRoadClass, Oneway, Road, RoadAttributes, Structure};
