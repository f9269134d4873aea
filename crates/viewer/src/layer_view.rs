//! Lines that are not roads are drawn as roads of another style; this module chooses the style.

use corniche_roads::FunctionalRoadClass;
use corniche_styles::{LineStyle, Style};

use crate::{
    frame_view::FrameView,
    options::{RoadMethod, RoadOptions},
    tiles::LineLayer,
};

impl LineLayer {
    /// The styles of the lines of the layer.
    pub(crate) fn lines_of<'a>(self, view: &FrameView<'a>) -> &'a [LineStyle] {
        match self {
            Self::Package(group) => view.layers.lines(group),
            Self::Overlays => &view.style.overlays,
            Self::Drawn => std::slice::from_ref(&view.style.drawn),
        }
    }

    /// A style whose roads are the lines of the layer.
    pub(crate) fn style_of(self, view: &FrameView<'_>) -> Style {
        view.style.with_lines_as_roads(self.lines_of(view))
    }
}

/// The view of a picture that shows lines only, in a style from [`LineLayer::style_of`]. If roads
/// are not drawn, lines are drawn as shadow volumes.
pub(crate) fn view_of_lines<'a>(view: &FrameView<'a>, style: &'a Style) -> FrameView<'a> {
    let method = match view.roads.method {
        RoadMethod::Geometry => RoadMethod::Geometry,
        RoadMethod::ShadowVolumes | RoadMethod::None => RoadMethod::ShadowVolumes,
    };
    let is_drawn = |class: &FunctionalRoadClass| style.road(*class).opacity > 0.0;
    let classes = FunctionalRoadClass::all().filter(is_drawn).collect();
    FrameView { style, roads: RoadOptions { classes, ..RoadOptions::for_method(method) }, ..*view }
}
