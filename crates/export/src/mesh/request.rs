use std::path::Path;

use corniche_roads::FunctionalRoadClass;

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
    /// The classes of roads that are taken.
    pub classes: Vec<FunctionalRoadClass>,
    /// Colours of the ground and of the roads of each class, red, green and blue from 0 to 1, where the format has colours.
    pub colors: [[f32; 3]; 1 + FunctionalRoadClass::COUNT],
}
