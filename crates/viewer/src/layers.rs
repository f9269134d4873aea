//! Which layers of a package are drawn, and how their classes look.

use std::collections::BTreeSet;

use corniche_styles::{AreaStyle, LayerLook, LineStyle, PointStyle, Style};
use corniche_tileset::{LayerSlot, Manifest};
use serde::{Deserialize, Serialize};

use crate::layer_class::LayerClass;
use crate::line_places::{LineLayer, LinePlaces};

/// The layers that are drawn, by their ids.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ShownLayers(Option<BTreeSet<String>>);

/// The reason why layers cannot be shown.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the package has no layer {id:?}; {}", match known.as_slice() {
    [] => "it has no layers at all".to_owned(),
    known => format!("its layers are {}", known.join(", ")),
})]
pub struct UnknownLayer {
    id: String,
    known: Vec<String>,
}

impl ShownLayers {
    /// All layers of a package.
    pub const ALL: Self = Self(None);

    /// The layers of a list such as `areas,railways`; `none` for no layers.
    #[must_use]
    pub fn from_list(list: &str) -> Self {
        let ids = list.split(',').map(str::trim).filter(|id| !id.is_empty() && *id != "none");
        Self(Some(ids.map(str::to_owned).collect()))
    }

    /// The list for [`Self::from_list`]; `None` for all layers.
    #[must_use]
    pub fn to_list(&self) -> Option<String> {
        let ids: Vec<&str> = self.0.as_ref()?.iter().map(String::as_str).collect();
        Some(if ids.is_empty() { "none".to_owned() } else { ids.join(",") })
    }

    /// Whether a layer is shown.
    #[must_use]
    pub fn contains(&self, id: &str) -> bool {
        self.0.as_ref().is_none_or(|ids| ids.contains(id))
    }

    /// Shows a hidden layer, or hides a shown one; `all` are the layers of the package.
    pub fn toggle<'a>(&mut self, id: &str, all: impl Iterator<Item = &'a str>) {
        let ids = self.0.get_or_insert_with(|| all.map(str::to_owned).collect());
        if !ids.remove(id) {
            ids.insert(id.to_owned());
        }
    }

    /// Checks that a package has the layers.
    ///
    /// # Errors
    /// When it lacks one of them.
    pub fn check(&self, manifest: &Manifest) -> Result<(), UnknownLayer> {
        let unknown = self.0.iter().flatten().find(|id| manifest.layer(id).is_none());
        unknown.map_or(Ok(()), |id| {
            let known = manifest.layers.iter().map(|layer| layer.table.id.clone()).collect();
            Err(UnknownLayer { id: id.clone(), known })
        })
    }
}

/// How the classes of a package's layers are drawn.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PackageLooks {
    /// The classes of each layer, in the order of the manifest.
    layers: Vec<Vec<LayerLook>>,
    pub(crate) places: LinePlaces,
    /// The styles of the lines that are drawn at once.
    lines: Vec<[LineStyle; LineStyle::MOST]>,
}

impl PackageLooks {
    /// No layers.
    pub const NONE: &'static Self =
        &Self { layers: Vec::new(), places: LinePlaces::NONE, lines: Vec::new() };

    /// How a style draws the layers of a package. Classes of layers that are not shown are not
    /// drawn.
    #[must_use]
    pub fn new(manifest: &Manifest, style: &Style, shown: &ShownLayers) -> Self {
        let looks = manifest.layers.iter().map(|layer| {
            let table = &layer.table;
            let is_shown = shown.contains(&table.id);
            let look = |class| {
                let look = style.layer_look(table, class);
                if is_shown { look } else { look.with_opacity(0.0) }
            };
            (0..table.classes.len()).map(look).collect()
        });
        Self::from_looks(looks.collect())
    }

    /// Layers with these looks of their classes; the classes of a layer have one geometry.
    #[must_use]
    pub fn from_looks(layers: Vec<Vec<LayerLook>>) -> Self {
        let places = LinePlaces::new(layers.iter().map(|looks| match looks.first() {
            Some(LayerLook::Line(_)) => looks.len(),
            _ => 0,
        }));
        let mut lines = vec![[LineStyle::NOTHING; LineStyle::MOST]; places.groups()];
        let looks = Self { layers, places, lines: Vec::new() };
        for (of, look) in looks.all() {
            if let (LayerLook::Line(line), Some((LineLayer::Package(group), style))) =
                (look, looks.places.place(of))
            {
                lines[usize::from(group)][usize::from(style)] = line;
            }
        }
        Self { lines, ..looks }
    }

    /// All classes with their looks, in the order of the manifest.
    pub fn all(&self) -> impl Iterator<Item = (LayerClass, LayerLook)> {
        self.layers.iter().enumerate().flat_map(|(layer, looks)| {
            let layer = LayerSlot::new(layer);
            let classes = layer
                .into_iter()
                .flat_map(|layer| (0..=u8::MAX).map(move |class| LayerClass { layer, class }));
            classes.zip(looks.iter().copied())
        })
    }

    /// The layers of which something is drawn.
    #[must_use]
    pub fn drawn_layers(&self) -> Vec<LayerSlot> {
        let drawn = self.all().filter(|(_, look)| look.is_drawn()).map(|(of, _)| of.layer);
        let mut drawn: Vec<LayerSlot> = drawn.collect();
        drawn.dedup();
        drawn
    }

    /// How a class is drawn; `None` if it is not drawn.
    #[must_use]
    pub fn look(&self, LayerClass { layer, class }: LayerClass) -> Option<LayerLook> {
        let look = self.layers.get(layer.index())?.get(usize::from(class))?;
        look.is_drawn().then_some(*look)
    }

    /// How a class of areas is drawn; `None` if it is not drawn.
    pub(crate) fn area(&self, of: LayerClass) -> Option<AreaStyle> {
        match self.look(of)? {
            LayerLook::Area(area) => Some(area),
            _ => None,
        }
    }

    /// How a class of points is drawn; `None` if it is not drawn.
    pub(crate) fn point(&self, of: LayerClass) -> Option<PointStyle> {
        match self.look(of)? {
            LayerLook::Point(point) => Some(point),
            _ => None,
        }
    }

    /// The styles of the lines of the package's layers that are drawn at once.
    pub(crate) fn lines(&self, group: u16) -> &[LineStyle] {
        self.lines.get(usize::from(group)).map_or(&[], |lines| lines)
    }

    /// The same layers with other looks.
    #[cfg(all(feature = "annotations", not(target_arch = "wasm32")))]
    pub(crate) fn map(&self, mut look: impl FnMut(LayerLook) -> LayerLook) -> Self {
        let map = |looks: &Vec<LayerLook>| looks.iter().map(|of| look(*of)).collect();
        Self::from_looks(self.layers.iter().map(map).collect())
    }
}

#[cfg(test)]
#[path = "layers_tests.rs"]
pub(crate) mod tests;
