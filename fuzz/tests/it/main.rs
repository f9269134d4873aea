//! What fuzzing found and starts from, in one binary. The first line of each module says what holds.

mod replay;
mod seeds;
