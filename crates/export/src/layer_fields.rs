//! The fields of a layer as features: the object, its attributes, and its measures.

use corniche_layers::{
    AttributeKind, AttributeValue, DerivedNumber, LayerForm, LayerGeometry, OsmObject,
};
use corniche_tileset::LayerObject;

use crate::vector::{FeatureField, FieldKind, FieldValue, fields, fields_of, real};

/// An object with its measures, the input of a feature.
struct LayerFeature<'a> {
    object: OsmObject,
    class: &'a str,
    measures: LayerMeasures,
}

/// The measures of objects of a layer; 0 for those that their geometry does not have.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct LayerMeasures {
    /// Number of lines, polygons or points.
    pub(crate) parts: u64,
    /// Points of all parts; rings without their closing points.
    pub(crate) points: u64,
    /// True length of lines in plan, metres.
    pub(crate) length_m: f64,
    /// True area on the ellipsoid, square metres.
    pub(crate) area_m2: f64,
}

fields! { OBJECT_FIELDS, of: &LayerFeature<'_>:
    "object", Text, "", "type of the OSM object: `node`, `way` or `relation`", of.object.parts().0;
    "id", Integer64, "", "id of the OSM object", of.object.id();
    "class", Text, "", "class of the object, an id of the layer's table", of.class;
}

fields! { LINE_FIELDS, of: &LayerFeature<'_>:
    "length_m", Real, "m", "2D length (in plan) of the part in the package, on the WGS84 ellipsoid",
        real(of.measures.length_m);
    "parts", Integer, "", "number of lines of the feature; gaps separate them", of.measures.parts as i64;
    "points", Integer64, "", "number of points of these lines", of.measures.points as i64;
}

fields! { AREA_FIELDS, of: &LayerFeature<'_>:
    "area_m2", Real, "m²", "area of the part in the package, on the WGS84 ellipsoid",
        (of.measures.area_m2 * 1e3).round() / 1e3;
    "polygons", Integer, "", "number of polygons", of.measures.parts as i64;
    "points", Integer64, "", "number of points of all rings, without the closing points", of.measures.points as i64;
}

/// A field with the function that returns its value.
type LayerField = (FeatureField, fn(&LayerFeature<'_>) -> FieldValue);

/// Names that drivers of GDAL give to fields of their own.
const RESERVED: [&str; 4] = ["fid", "ogc_fid", "geom", "wkt"];

/// The fields of a layer.
pub(crate) struct LayerFields {
    attributes: Vec<AttributeField>,
    measures: &'static [LayerField],
}

/// A field of an attribute.
struct AttributeField {
    field: FeatureField,
    /// The number of the attribute in the layer's table.
    attribute: usize,
    /// The language of the names; `None` for the local name, and for other attributes.
    language: Option<String>,
}

impl LayerFields {
    /// The fields of a layer with this table, and its names in these languages.
    pub(crate) fn new(table: &LayerForm, languages: &[String]) -> Self {
        let measures = match table.geometry {
            LayerGeometry::Line => LINE_FIELDS,
            LayerGeometry::Area => AREA_FIELDS,
            LayerGeometry::Point => &[],
        };
        let mut attributes: Vec<AttributeField> = Vec::new();
        let own = fields_of(&[OBJECT_FIELDS, measures].concat());
        // Databases do not distinguish upper and lower case.
        let mut taken: Vec<String> = own.iter().map(|field| field.name.to_string()).collect();
        taken.extend(RESERVED.map(str::to_owned));
        for (attribute, (key, &kind)) in table.attributes.iter().enumerate() {
            let of_names = languages.iter().filter(|_| kind == AttributeKind::Names);
            for language in std::iter::once(None).chain(of_names.map(Some)) {
                let tag = language.map_or(key.clone(), |language| format!("{key}:{language}"));
                let mut name = tag.clone();
                while taken.contains(&name.to_ascii_lowercase()) {
                    name.push('_');
                }
                taken.push(name.to_ascii_lowercase());
                let (field_kind, meaning) = match kind {
                    AttributeKind::Names if language.is_none() => {
                        (FieldKind::Text, " in the local language; null if not tagged")
                    }
                    AttributeKind::Names | AttributeKind::Text => {
                        (FieldKind::Text, "; null if not tagged")
                    }
                    AttributeKind::YesNo => {
                        (FieldKind::Integer, ": 1 for yes, 0 for no; null if unknown")
                    }
                    AttributeKind::Number(_) => (FieldKind::Real, "; null if unknown"),
                    AttributeKind::Derived(DerivedNumber::Isolation) => (
                        FieldKind::Real,
                        "Distance to the nearest point of the layer with a larger `ele`; null without `ele`",
                    ),
                };
                let (unit, meaning) = match kind {
                    AttributeKind::Derived(_) => ("m", meaning.into()),
                    AttributeKind::Number(unit) => {
                        (unit.symbol(), format!("OSM's `{tag}`{meaning}").into())
                    }
                    _ => ("", format!("OSM's `{tag}`{meaning}").into()),
                };
                let field = FeatureField { name: name.into(), kind: field_kind, unit, meaning };
                attributes.push(AttributeField { field, attribute, language: language.cloned() });
            }
        }
        Self { attributes, measures }
    }

    /// The fields, in their order.
    pub(crate) fn fields(&self) -> Vec<FeatureField> {
        let attributes = self.attributes.iter().map(|of| of.field.clone());
        let own = fields_of(OBJECT_FIELDS).into_iter();
        own.chain(attributes).chain(fields_of(self.measures)).collect()
    }

    /// Returns the values of an object, one for each field.
    pub(crate) fn values(
        &self,
        of: &LayerObject,
        class: &str,
        measures: LayerMeasures,
    ) -> Vec<FieldValue> {
        let feature = LayerFeature { object: of.object, class, measures };
        let own = |fields: &'static [LayerField]| fields.iter().map(|(_, value)| value(&feature));
        let attributes = self.attributes.iter().map(|field| {
            let value = of.values.get(field.attribute).and_then(Option::as_ref);
            value.map_or(FieldValue::Null, |value| field.value(value))
        });
        own(OBJECT_FIELDS).chain(attributes).chain(own(self.measures)).collect()
    }
}

impl AttributeField {
    fn value(&self, value: &AttributeValue) -> FieldValue {
        match (value, &self.language) {
            (AttributeValue::YesNo(yes), _) => i64::from(*yes).into(),
            (AttributeValue::Number(number), _) => (*number).into(),
            (AttributeValue::Names(names), Some(language)) => {
                let name = names.iter().find(|(own, _)| own == language);
                name.map(|(_, name)| name.as_str()).into()
            }
            (value, _) => value.text(&[]).as_str().into(),
        }
    }
}

#[cfg(test)]
#[path = "layer_fields_tests.rs"]
mod tests;
