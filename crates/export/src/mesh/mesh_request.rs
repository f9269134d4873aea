//! What a user asks for when a package becomes a model: its format, its axes, its roads and its colours.

use std::{fmt::Write as _, path::Path};

use corniche_roads::FunctionalRoadClass;
use corniche_styles::Style;

use crate::bounds::DegreeBounds;

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
    /// All formats.
    pub const ALL: [Self; 3] = [Self::Glb, Self::Ply, Self::Obj];

    /// The ending of its files.
    #[must_use]
    pub const fn ending(self) -> &'static str {
        match self {
            Self::Glb => "glb",
            Self::Ply => "ply",
            Self::Obj => "obj",
        }
    }

    /// The format that the ending of a name says.
    #[must_use]
    pub fn of_path(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        Self::ALL.into_iter().find(|format| format.ending() == ending)
    }

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
    pub(crate) fn along_axes<T: std::ops::Neg<Output = T>>(
        self,
        [east, north, up]: [T; 3],
    ) -> [T; 3] {
        match self {
            Self::Y => [east, up, -north],
            Self::Z => [east, north, up],
        }
    }
}

/// What a model has of roads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModelRoads {
    /// Roads are there as their centre-lines on the ground.
    Lines,
    /// Surfaces of their true width, cut into the ground's own triangles; tunnels are left out.
    Surfaces,
    /// Roads are left out.
    None,
}

/// Red, green and blue from 0 to 1 (sRGB) of the ground, then of the roads of each class.
pub(crate) type ModelColors = [[f32; 3]; 1 + FunctionalRoadClass::COUNT];

pub(crate) const GROUND_COLOR: [f32; 3] = [0.85, 0.86, 0.78];

/// The name of what has a colour: the ground, or the roads of a class.
pub(crate) fn group_name(class: Option<FunctionalRoadClass>) -> String {
    class.map_or_else(|| "terrain".to_owned(), |class| format!("roads_frc_{}", class.number()))
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
        let mut colors = [GROUND_COLOR; 1 + FunctionalRoadClass::COUNT];
        for (color, road) in colors[1..].iter_mut().zip(&self.style.roads) {
            *color = road.bands.main_color();
        }
        colors
    }

    /// The materials of an OBJ, as a file of their own: colours are sRGB.
    #[must_use]
    pub fn materials(&self) -> String {
        let classes = FunctionalRoadClass::all().map(Some);
        let groups = std::iter::once(None).chain(classes);
        let mut text = String::new();
        for (group, [red, green, blue]) in groups.zip(self.colors()) {
            let name = group_name(group);
            // Writing to a text cannot fail.
            let _ = write!(text, "newmtl {name}\nKd {red:.4} {green:.4} {blue:.4}\nillum 1\n");
        }
        text
    }
}
