//! The settings with which a window opens.

use std::collections::BTreeSet;

use corniche_roads::FunctionalRoadClass;
use corniche_viewer::RoadOptions;

use crate::{
    WindowRequest, panel,
    settings::{Compare, Refinement, Settings},
};

/// The settings with which a window of this width in points opens. `is_software` says that the processor draws.
pub(crate) fn first_settings(
    request: &WindowRequest,
    is_software: bool,
    width_points: f32,
) -> Settings {
    let usual_samples = if is_software { 1 } else { 2 };
    Settings {
        roads: RoadOptions {
            method: request.software_method.filter(|_| is_software).unwrap_or(request.roads.method),
            ..request.roads
        },
        compare: Compare::Off,
        divider_share: 0.5,
        width_factors: [1.0; FunctionalRoadClass::COUNT],
        style: 0,
        photo: request.photo,
        areas: request.areas,
        boundaries: request.boundaries,
        hidden_overlays: BTreeSet::new(),
        exaggeration: request.exaggeration,
        screen_space_error_px: request.screen_space_error_px,
        cell_px: request.cell_px,
        samples_per_side: request.samples_per_side.unwrap_or(usual_samples),
        is_wireframe: false,
        refinement: Refinement::Live,
        is_panel_open: panel::first_width(width_points) > 0.0,
        is_help_open: false,
        place: String::new(),
    }
}
