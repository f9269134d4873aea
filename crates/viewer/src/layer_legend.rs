//! The layers of a package and how their classes look, for the panels and legends of windows and
//! web pages.

use corniche_layers::{LayerGeometry, Titles};
use corniche_styles::{LayerLook, LineStyle, PointStyle};
use corniche_tileset::Manifest;

use crate::{layer_class::LayerClass, layers::PackageLooks};

/// A layer of a package.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerLegend {
    /// The layer's id.
    pub id: String,
    /// The layer's title.
    pub title: String,
    /// Whether the layer has lines, areas or points.
    pub geometry: LayerGeometry,
    /// The classes that the package has and that are drawn, the first one first.
    pub rows: Vec<LayerRow>,
}

/// Classes of a layer that are drawn alike.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerRow {
    /// The titles of these classes.
    pub label: String,
    /// How these classes are drawn.
    pub look: LayerLook,
}

impl LayerLegend {
    /// Returns the layers of a package, the highest first. Classes of a layer that look alike are
    /// merged.
    #[must_use]
    pub fn from_manifest(manifest: &Manifest, looks: &PackageLooks) -> Vec<Self> {
        let mut layers: Vec<Self> = manifest
            .layers()
            .map(|(layer, record)| {
                let mut rows: Vec<LayerRow> = Vec::new();
                let kept = record.counts.kept.iter().filter(|of| of.objects > 0);
                let mut classes: Vec<u8> = kept.map(|of| of.class).collect();
                classes.sort_unstable();
                for class in classes {
                    let of = LayerClass { layer, class };
                    let Some(look) = looks.look(of) else { continue };
                    let title = class_title(manifest, of);
                    match rows.iter_mut().find(|row| at_all_scales(row.look) == at_all_scales(look))
                    {
                        Some(row) => row.label = format!("{}, {title}", row.label),
                        None => rows.push(LayerRow { label: title, look }),
                    }
                }
                let table = &record.table;
                let title = titled(&table.title, &table.id);
                Self { id: table.id.clone(), title, geometry: table.geometry, rows }
            })
            .collect();
        layers.reverse();
        layers
    }
}

/// The title of a class of a package; empty if the package has no such class.
pub(crate) fn class_title(manifest: &Manifest, LayerClass { layer, class }: LayerClass) -> String {
    let layer = manifest.layers.get(layer.index());
    let class = layer.and_then(|layer| layer.table.classes.get(usize::from(class)));
    class.map(|class| titled(&class.title, &class.id)).unwrap_or_default()
}

fn titled(title: &Titles, id: &str) -> String {
    title.title(&["en"]).unwrap_or(id).to_owned()
}

/// The look without its limit of scale, which no legend shows.
fn at_all_scales(look: LayerLook) -> LayerLook {
    match look {
        LayerLook::Line(line) => LayerLook::Line(LineStyle { max_pixel_m: None, ..line }),
        LayerLook::Point(point) => LayerLook::Point(PointStyle { max_pixel_m: None, ..point }),
        LayerLook::Area(_) => look,
    }
}

#[cfg(test)]
#[path = "layer_legend_tests.rs"]
mod tests;
