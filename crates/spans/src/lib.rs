//! Bridges and tunnels as separate networks, and their heights.
//!
//! ```text
//!             B ───────●─────── C       ●  joints of a span: where chains of it meet or end
//!            ╱         │                A, B, C …: supports, where the span ends on the ground
//!   ──────● A          ● D              between them the deck is as straight as it can be
//!   ground
//! ```
//!
//! A *span* consists of all chains of one kind, bridge or tunnel, that shared nodes connect. An
//! elevation model says nothing about a deck except where it ends: there, the deck has the ground's
//! height. Between its supports a deck is harmonic, which is the shape with the least bends that
//! needs no further parameter. Where decks cross other roads, they are lifted a little, so that the
//! upper road is above the lower one; tunnels are lowered. Heights are estimates.
//!
//! This crate never reads heights: callers supply the ground.

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

/// Returns the true distance between two positions of the lattice in plan, metres.
pub type Distance<'a> = dyn Fn([f64; 2], [f64; 2]) -> f64 + 'a;
