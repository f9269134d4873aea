//! Bridges and tunnels as networks of their own, and how high they are.
//!
//! ```text
//!             B ───────●─────── C       ●  joints of a span: where chains of it meet or end
//!            ╱         │                A, B, C …: supports, where the span ends on the ground
//!   ──────● A          ● D              between them the deck is as straight as it can be
//!   ground
//! ```
//!
//! A *span* is all chains of one kind, bridge or tunnel, that are connected by shared nodes. Elevation models say nothing of a deck but where it
//! ends: there it has the ground's height, and between its supports it is harmonic, the shape of least bends that needs no further number. Where
//! decks cross other roads, they are lifted a little, so that what is above lies above; tunnels are lowered. Heights are estimates.
//!
//! This crate never reads a height: callers bring the ground.

mod chain_lines;
mod connected;
mod contacts;
mod crossing_place;
mod crossings;
mod harmonic;
mod lifts;
#[cfg(test)]
mod network_tests;
mod refusals;
mod span_finder;
mod spans;
mod structure_heights;
mod vicinity;

pub use connected::{SpanLine, connected};
pub use crossing_place::CrossingPlace;
pub use crossings::{Crossing, Crossings, Order, crossings};
pub use spans::{Joint, SpanChain, SpanKind, SpanProblem, SpanReason, Spans, Support};
pub use structure_heights::{Decks, FreeHeight};
pub use vicinity::Vicinity;

/// The true distance between two places of the lattice in plan, metres.
pub type Distance<'a> = dyn Fn([f64; 2], [f64; 2]) -> f64 + 'a;
