//! Annotations on a finished picture: a title, the attribution, and a legend with scale bar and
//! north arrow.

mod credits;
mod legend;
mod legend_row;
mod letters;
mod title;

pub use self::{
    credits::draw_attribution,
    legend::{
        Legend, LegendHeights, OccupiedMargins, bar_length, bar_length_m, draw_legend, grouped,
    },
    legend_row::{LegendEdge, LegendRoad, LegendRow, LegendSample},
    title::{TitleFlaws, WrittenTitle, draw_title},
};
