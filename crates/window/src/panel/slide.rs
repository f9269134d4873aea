use std::ops::RangeInclusive;

use egui::{Response, Slider, SliderClamping, Ui, emath::Numeric};

/// A slider on a factor or a size, logarithmic. A value beyond its range or finer than it shows, as the command line may
/// have it, stays as it is until it is moved.
pub(crate) fn slide<T: Numeric>(
    ui: &mut Ui,
    value: &mut T,
    range: RangeInclusive<T>,
    dressed: impl FnOnce(Slider<'_>) -> Slider<'_>,
) -> Response {
    let mut moved = *value;
    let slider = Slider::new(&mut moved, range).logarithmic(true).clamping(SliderClamping::Edits);
    let response = ui.add(dressed(slider));
    if response.changed() {
        *value = moved;
    }
    response
}
