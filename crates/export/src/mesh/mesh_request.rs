//! What a user asks for when a package becomes a model: its format, its axes, its roads and its colours.

use std::fmt::Write as _;

use corniche_roads::FunctionalRoadClass;
use corniche_styles::{Rgb, Style};
use corniche_tileset::Manifest;

use crate::{
    bounds::DegreeBounds,
    file_format::FileFormat,
    gltf::{SLAB_COLOR, SLAB_NAME, y_up},
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

impl FileFormat for MeshFormat {
    const ALL: &[Self] = &[Self::Glb, Self::Ply, Self::Obj];

    fn ending(self) -> &'static str {
        match self {
            Self::Glb => "glb",
            Self::Ply => "ply",
            Self::Obj => "obj",
        }
    }
}

impl MeshFormat {
    /// Which axis points up where nothing is said.
    #[must_use]
    pub const fn usual_up(self) -> UpAxis {
        match self {
            // glTF has no other.
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
    /// A vector of east, north and up along the model's axes.
    pub(crate) fn along_axes<T: std::ops::Neg<Output = T>>(self, at: [T; 3]) -> [T; 3] {
        match self {
            Self::Y => y_up(at),
            Self::Z => at,
        }
    }
}

/// What a model has of roads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModelRoads {
    /// Roads are there as their centre-lines on the ground.
    Lines,
    /// Surfaces of their true width, cut into the ground's own triangles, and bridges as slabs where the package knows their heights; tunnels are left out.
    Surfaces,
    /// Roads are left out.
    None,
}

/// Colours of what a model has.
#[derive(Clone)]
pub(crate) struct ModelColors {
    /// Colours of the roads of each class.
    roads: [Rgb; FunctionalRoadClass::COUNT],
}

pub(crate) const GROUND_COLOR: Rgb = [0.85, 0.86, 0.78];

impl ModelColors {
    pub(crate) fn of(&self, kind: SurfaceKind) -> Rgb {
        match kind {
            SurfaceKind::Ground => GROUND_COLOR,
            SurfaceKind::Road(class) => self.roads[usize::from(class.number())],
            SurfaceKind::Slab(_) => SLAB_COLOR,
        }
    }
}

/// The ground, and the roads of all classes.
pub(crate) fn ground_and_roads() -> impl Iterator<Item = SurfaceKind> {
    let roads = FunctionalRoadClass::all().map(SurfaceKind::Road);
    std::iter::once(SurfaceKind::Ground).chain(roads)
}

/// The name of what has a colour. Slabs of all classes have one.
pub(crate) fn group_name(kind: SurfaceKind) -> String {
    match kind {
        SurfaceKind::Ground => "terrain".to_owned(),
        SurfaceKind::Road(class) => format!("roads_frc_{}", class.number()),
        SurfaceKind::Slab(_) => SLAB_NAME.to_owned(),
    }
}

/// What of a package becomes a model, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshRequest {
    /// The format of the file.
    pub format: MeshFormat,
    /// Which axis points up; glTF has only [`UpAxis::Y`].
    pub up: UpAxis,
    /// The level; `None` is the finest.
    pub level: Option<u8>,
    /// Ground that may lie in this rectangle is taken, in whole triangles; roads are cut at it.
    pub bounds: Option<DegreeBounds>,
    /// How roads are there.
    pub roads: ModelRoads,
    /// The classes of roads that are taken.
    pub classes: Vec<FunctionalRoadClass>,
    /// Whether the package's reliefs become normal maps, which GLB has.
    pub relief: bool,
    /// Colours of roads, widths of surfaces, and how strong photos are, which GLB has.
    pub style: Style,
    /// The name of the file of materials that OBJ with surfaces needs; [`MeshRequest::materials`] tells its content.
    pub material_file: Option<String>,
}

impl MeshRequest {
    pub(crate) fn colors(&self) -> ModelColors {
        ModelColors { roads: self.style.roads.map(|road| road.bands.main_color()) }
    }

    /// The materials of an OBJ of a package, as a file of their own: colours are sRGB.
    #[must_use]
    pub fn materials(&self, package: &Manifest) -> String {
        let colors = self.colors();
        let mut text = String::new();
        let slabs = FunctionalRoadClass::all().map(SurfaceKind::Slab).take(1);
        let slabs = slabs.filter(|_| package.spans.is_some());
        for kind in ground_and_roads().chain(slabs) {
            let (name, [red, green, blue]) = (group_name(kind), colors.of(kind));
            // Writing to a text cannot fail.
            let _ = write!(text, "newmtl {name}\nKd {red:.4} {green:.4} {blue:.4}\nillum 1\n");
        }
        text
    }
}
