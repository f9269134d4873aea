//! In which order the lines that are not roads are drawn: by groups of layers, then those of files.

use corniche_layers::LayerGeometry;
use corniche_styles::LineStyle;
use corniche_tileset::Manifest;
use serde::{Deserialize, Serialize};

use crate::layer_class::LayerClass;

/// Lines that are drawn at once, from the lowest to the highest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum LineLayer {
    /// Lines of some layers of the package, by the number of this group of layers.
    Package(u16),
    /// Lines from users' files.
    Overlays,
    /// Lines that the user draws in the window.
    Drawn,
}

/// In which groups the lines of a package's layers are drawn.
///
/// A group has as many styles as there are classes of roads, and one pass draws it. Layers share a
/// group if all their classes fit; a layer with more classes has several groups.
///
/// ```text
///  layers        2 classes │ 4 classes │ 8 classes         from the lowest to the highest
///  groups        0                     │ 1
///  styles        8 7         6 5 4 3   │ 8 7 6 5 4 3 2 1   a smaller number is drawn above others
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct LinePlaces {
    /// For each layer the number of its last class, and how many classes it has.
    layers: Vec<[usize; 2]>,
    end: usize,
}

impl LinePlaces {
    /// No layers.
    pub(crate) const NONE: Self = Self { layers: Vec::new(), end: 0 };

    /// Places layers with these numbers of classes of lines, from the lowest to the highest.
    pub(crate) fn new(classes: impl Iterator<Item = usize>) -> Self {
        let (mut layers, mut end) = (Vec::new(), 0_usize);
        for count in classes {
            let is_too_full = end % LineStyle::MOST + count > LineStyle::MOST;
            let first = if is_too_full { end.next_multiple_of(LineStyle::MOST) } else { end };
            layers.push([first, count]);
            end = first + count;
        }
        Self { layers, end }
    }

    /// Places the layers of a package.
    pub(crate) fn from_manifest(manifest: &Manifest) -> Self {
        Self::new(manifest.layers.iter().map(|layer| match layer.table.geometry {
            LayerGeometry::Line => layer.table.classes.len(),
            LayerGeometry::Area | LayerGeometry::Point => 0,
        }))
    }

    /// The number of groups.
    pub(crate) fn groups(&self) -> usize {
        self.end.div_ceil(LineStyle::MOST)
    }

    /// The group of a class, and the number of its style there; `None` if it is not a class of
    /// lines.
    pub(crate) fn place(&self, LayerClass { layer, class }: LayerClass) -> Option<(LineLayer, u8)> {
        let &[first, count] = self.layers.get(layer.index())?;
        let number = first + count.checked_sub(usize::from(class) + 1)?;
        let style = LineStyle::MOST - 1 - number % LineStyle::MOST;
        let group = u16::try_from(number / LineStyle::MOST).ok()?;
        Some((LineLayer::Package(group), style as u8))
    }
}

#[cfg(test)]
#[path = "line_places_tests.rs"]
mod tests;
