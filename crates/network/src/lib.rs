//! Roads as a network: which roads meet in which nodes, and the chains from junction to junction.
//!
//! ```text
//!      way 7          way 8
//!   A ──●───●── B ──●─────── C          nodes A, C: ends; D: a junction of three; B: a way ends, another continues
//!           D                           chains: A D, D B C, and the way that leaves D
//!           │  way 9
//! ```
//!
//! Two roads meet only if they reference the same OpenStreetMap node; roads that cross in the same
//! place at different nodes do not join. A *stretch* is the part of a way between two neighbouring
//! nodes at which it may join others. A *chain* is a sequence of stretches through nodes at which
//! exactly two of them meet. So chains do not depend on where mappers have split ways, nor on the
//! direction of ways.
//!
//! # Memory
//! A network is held in memory as a whole: 16 bytes for each point, and about 40 for each stretch.
//!
//! This crate never reads heights or files, and never decides which road matters.

mod chains;
mod network;
mod network_builder;

pub use chains::{Breaks, Chain, ChainLengths, ChainNumber, Chains, Link};
pub use network::{Network, NetworkWay, NodeNumber};
pub use network_builder::NetworkBuilder;
