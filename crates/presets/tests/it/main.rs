//! Integration tests of `corniche-presets`, in one binary. The first line of each module states
//! what is tested.

mod frc_presets;
mod layer_presets;
