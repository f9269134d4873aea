//! A logarithmic slider that keeps values from outside its range.

use std::ops::RangeInclusive;

use egui::{Response, Slider, SliderClamping, Ui, emath::Numeric};

/// A logarithmic slider for a factor or a size. The command line may give a value that is out of the slider's range or has
/// more digits than it shows; such a value stays as it is until the slider is moved.
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
