//! The request for a model of a package: format, axes, roads and colours.

use std::fmt::Write as _;

use corniche_roads::FunctionalRoadClass;
use corniche_styles::{Rgb, Style};
use corniche_tileset::Manifest;

use crate::{
    bounds::DegreeBounds,
    gltf::{SLAB_COLOR, y_up},
    surfaces::SurfaceKind,
};

/// Formats of models.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeshFormat {
    /// Binary glTF 2.0.
    Glb,
    /// Polygon File Format, binary, positions as f64.
    Ply,
    /// Wavefront OBJ.
    Obj,
}

impl MeshFormat {
    /// The axis that points up by default.
    #[must_use]
    pub const fn usual_up(self) -> UpAxis {
        match self {
            // In glTF, y is always up.
            Self::Glb | Self::Obj => UpAxis::Y,
            Self::Ply => UpAxis::Z,
        }
    }
}

/// Which axis of a model points up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UpAxis {
    /// x east, y up, z south.
    Y,
    /// x east, y north, z up.
    Z,
}

impl UpAxis {
    /// Converts east, north and up to the model's axes.
    pub(crate) fn along_axes<T: std::ops::Neg<Output = T>>(self, at: [T; 3]) -> [T; 3] {
        match self {
            Self::Y => y_up(at),
            Self::Z => at,
        }
    }
}

/// The form of roads in a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModelRoads {
    /// Roads are centre-lines on the ground.
    Lines,
    /// Roads are surfaces of their true width, cut into the ground's own triangles, and bridges are
    /// slabs if the package knows their heights; tunnels are omitted.
    Surfaces,
    /// Roads are omitted.
    None,
}

pub(crate) const GROUND_COLOR: Rgb = [0.85, 0.86, 0.78];

/// Returns the colour of a model's surfaces.
pub(crate) fn color_of(kind: SurfaceKind, style: &Style) -> Rgb {
    match kind {
        SurfaceKind::Ground => GROUND_COLOR,
        SurfaceKind::Road(class) => style.road(class).bands.main_color(),
        SurfaceKind::Slab(_) => SLAB_COLOR,
    }
}

/// The ground, and the roads of all classes.
pub(crate) fn ground_and_roads() -> impl Iterator<Item = SurfaceKind> {
    let roads = FunctionalRoadClass::all().map(SurfaceKind::Road);
    std::iter::once(SurfaceKind::Ground).chain(roads)
}

/// Returns the name of a coloured group, as one word.
pub(crate) fn group_name(kind: SurfaceKind) -> String {
    kind.name().to_lowercase().replace(' ', "_")
}

/// The part of a package that becomes a model, and the form of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshRequest {
    /// The format of the file.
    pub format: MeshFormat,
    /// Which axis points up; glTF has only [`UpAxis::Y`].
    pub up: UpAxis,
    /// The level; `None` means the finest.
    pub level: Option<u8>,
    /// Ground that may be in this rectangle is exported in whole triangles; roads are clipped to
    /// it.
    pub bounds: Option<DegreeBounds>,
    /// The form of roads.
    pub roads: ModelRoads,
    /// The classes of roads that are exported.
    pub classes: Vec<FunctionalRoadClass>,
    /// Whether the package's reliefs become normal maps, which only GLB has.
    pub relief: bool,
    /// Colours of roads, widths of surfaces, and the strength of photos, which only GLB has.
    pub style: Style,
    /// The name of the material file that OBJ with surfaces needs; [`MeshRequest::materials`]
    /// returns its content.
    pub material_file: Option<String>,
}

impl MeshRequest {
    /// Returns the content of the material file of an OBJ; colours are sRGB.
    #[must_use]
    pub fn materials(&self, package: &Manifest) -> String {
        let mut text = String::new();
        let slabs = FunctionalRoadClass::all().map(SurfaceKind::Slab).take(1);
        let slabs = slabs.filter(|_| package.spans.is_some());
        for kind in ground_and_roads().chain(slabs) {
            let (name, [red, green, blue]) = (group_name(kind), color_of(kind, &self.style));
            // Writing to a text cannot fail.
            let _ = write!(text, "newmtl {name}\nKd {red:.4} {green:.4} {blue:.4}\nillum 1\n");
        }
        text
    }
}
