//! Findings and seeds of fuzzing, in one test binary. The first line of each module says what is
//! tested.

mod replay;
mod seeds;
