//! What is written on a finished picture: credits, and a legend with scale and north arrow.

mod credits;
mod legend;
mod letters;

pub use self::{
    credits::draw_attribution,
    legend::{Legend, LegendArea, LegendLine, LegendRoad, bar_length, bar_length_m, draw_legend},
};
