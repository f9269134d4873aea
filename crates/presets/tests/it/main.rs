//! Integration tests of `corniche-presets`, in one binary. The first line of each module says what holds.

mod area_presets;
mod frc_presets;
