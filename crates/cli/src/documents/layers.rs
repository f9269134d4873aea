//! Layers in the JSON documents of several commands.

use std::collections::BTreeMap;

use corniche_geom::LatticePoint;
use corniche_layers::{AttributeValue, LayerForm};
use corniche_tileset::{LayerObject, LayerRecord, LayerShape, Manifest, SectionLevelRecord};
use schemars::JsonSchema;
use serde::Serialize;

#[cfg(test)]
use crate::documents::record_schemas::SectionLevelDocument;

/// A layer of a package.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct LayerDocument {
    /// The table of the layer, as it was read; defaults are omitted.
    table: LayerForm,
    /// Number of objects in the extract that belong to the layer, converted or not. Each is counted
    /// once.
    objects: u64,
    /// Converted objects per class, also outside the package's extent.
    kept: Vec<LayerClassDocument>,
    /// Objects that were lost, by reason.
    lost: Vec<LayerLossDocument>,
    /// Values of attributes that could not be read, because they are not of the attribute's kind.
    unread_values: Vec<UnreadValuesDocument>,
    /// The layer on each level that has some of it, root first.
    #[cfg_attr(test, schemars(with = "Vec<SectionLevelDocument>"))]
    levels: Vec<SectionLevelRecord>,
}

/// The objects of one class.
#[derive(Serialize, JsonSchema)]
struct LayerClassDocument {
    /// The id of the class.
    class: String,
    /// Number of objects.
    objects: u64,
    /// True length of lines in plan, micrometres; 0 for other geometries.
    length_um: u64,
    /// True area, square kilometres; overlapping areas are all counted in full. 0 for other
    /// geometries.
    area_km2: f64,
}

/// The objects that were lost for one reason.
#[derive(Serialize, JsonSchema)]
struct LayerLossDocument {
    /// The reason.
    reason: String,
    /// Number of objects.
    objects: u64,
}

/// The values of an attribute that could not be read.
#[derive(Serialize, JsonSchema)]
struct UnreadValuesDocument {
    /// The key of the tag.
    key: String,
    /// Number of values.
    values: u64,
}

impl From<&LayerRecord> for LayerDocument {
    fn from(LayerRecord { table, counts, levels }: &LayerRecord) -> Self {
        let kept = counts.kept.iter().map(|kept| LayerClassDocument {
            class: class_id(table, kept.class),
            objects: kept.objects,
            length_um: kept.length_um,
            area_km2: kept.area_km2,
        });
        let lost = counts.lost.iter().cloned();
        let unread = counts.unread_values.iter().cloned();
        Self {
            table: table.clone(),
            objects: counts.objects,
            kept: kept.collect(),
            lost: lost.map(|(reason, objects)| LayerLossDocument { reason, objects }).collect(),
            unread_values: unread
                .map(|(key, values)| UnreadValuesDocument { key, values })
                .collect(),
            levels: levels.clone(),
        }
    }
}

/// The id of a class.
fn class_id(table: &LayerForm, class: u8) -> String {
    // The package reader has rejected other numbers.
    table.classes.get(usize::from(class)).map(|class| class.id.clone()).unwrap_or_default()
}

/// The objects of a layer in a tile.
#[derive(Serialize, JsonSchema)]
pub(crate) struct TileLayerDocument {
    /// The id of the layer.
    layer: String,
    /// Its objects, or the parts of them in or near the tile.
    objects: Vec<TileObjectDocument>,
}

/// An object of a layer, or its part in a tile.
#[derive(Serialize, JsonSchema)]
struct TileObjectDocument {
    /// The type of the OSM object: "node", "way" or "relation".
    object: &'static str,
    /// OSM id of the object.
    id: i64,
    /// The id of the class.
    class: String,
    /// The attributes that the object has, by key.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    attributes: BTreeMap<String, ValueDocument>,
    #[serde(flatten)]
    shape: ShapeDocument,
}

/// The value of an attribute.
#[derive(Serialize, JsonSchema)]
#[serde(untagged)]
enum ValueDocument {
    /// A text.
    Text(String),
    /// Yes or no.
    YesNo(bool),
    /// A number, in the unit of the layer's table.
    Number(f64),
    /// Names by language; the name without a language has the key "".
    Names(BTreeMap<String, String>),
}

/// The positions of an object, x and y.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum ShapeDocument {
    /// Positions of a line. Segments are not clipped: each touches the tile or the margin of its
    /// level's width, and its ends may be outside.
    Line(Vec<[f64; 2]>),
    /// Polygons of rings of positions: first the outer ring, counter-clockwise in working metres,
    /// then holes, clockwise. The first position is not repeated.
    Polygons(Vec<Vec<Vec<[f64; 2]>>>),
    /// The position of a point.
    Point([f64; 2]),
}

impl From<AttributeValue> for ValueDocument {
    fn from(value: AttributeValue) -> Self {
        match value {
            AttributeValue::Text(text) => Self::Text(text),
            AttributeValue::YesNo(yes) => Self::YesNo(yes),
            AttributeValue::Number(number) => Self::Number(number),
            AttributeValue::Names(names) => Self::Names(names.into_iter().collect()),
        }
    }
}

/// The objects of the layers of a tile, as documents; layers without objects are omitted. `place`
/// converts lattice points to coordinates.
pub(crate) fn tile_layers(
    manifest: &Manifest,
    layers: Vec<Vec<LayerObject>>,
    place: impl Fn(LatticePoint) -> [f64; 2],
) -> Vec<TileLayerDocument> {
    let layers = manifest.layers.iter().zip(layers).filter(|(_, objects)| !objects.is_empty());
    layers
        .map(|(record, objects)| TileLayerDocument {
            layer: record.table.id.clone(),
            objects: objects
                .into_iter()
                .map(|object| TileObjectDocument::new(&record.table, object, &place))
                .collect(),
        })
        .collect()
}

impl TileObjectDocument {
    fn new(
        table: &LayerForm,
        LayerObject { class, object, values, shape }: LayerObject,
        place: &impl Fn(LatticePoint) -> [f64; 2],
    ) -> Self {
        let (kind, id) = object.parts();
        let line = |points: Vec<LatticePoint>| points.into_iter().map(place).collect();
        let attributes = table.attributes.keys().zip(values);
        Self {
            object: kind,
            id,
            class: class_id(table, class),
            attributes: attributes
                .filter_map(|(key, value)| Some((key.clone(), value?.into())))
                .collect(),
            shape: match shape {
                LayerShape::Line(points) => ShapeDocument::Line(line(points)),
                LayerShape::Area(polygons) => ShapeDocument::Polygons(
                    polygons
                        .into_iter()
                        .map(|polygon| polygon.rings.into_iter().map(line).collect())
                        .collect(),
                ),
                LayerShape::Point(point) => ShapeDocument::Point(place(point)),
            },
        }
    }
}
