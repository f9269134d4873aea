use corniche_roads::FunctionalRoadClass;

use crate::{
    WindowRequest,
    settings::{Compare, Refinement, Settings},
};

/// The settings with which a window opens. `is_software` says that the processor draws.
pub(crate) fn first_settings(request: &WindowRequest, is_software: bool) -> Settings {
    let usual_samples = if is_software { 1 } else { 2 };
    Settings {
        roads: request.roads,
        compare: Compare::Off,
        divider_share: 0.5,
        width_factors: [1.0; FunctionalRoadClass::COUNT],
        style: 0,
        photo: request.photo,
        exaggeration: request.exaggeration,
        screen_space_error_px: request.screen_space_error_px,
        cell_px: request.cell_px,
        samples_per_side: request.samples_per_side.unwrap_or(usual_samples),
        is_wireframe: false,
        refinement: Refinement::Live,
        is_panel_open: true,
    }
}
