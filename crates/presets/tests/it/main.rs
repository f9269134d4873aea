//! Integration tests of `corniche-presets`, in one binary. The first line of each module states
//! what is tested.

mod area_presets;
mod frc_presets;
mod layer_presets;
