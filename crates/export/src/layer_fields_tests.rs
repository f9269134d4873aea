//! Each attribute has fields of its type and unit, whatever its key; databases find no name twice.

use corniche_tileset::LayerShape;

use super::*;
use corniche_geom::LatticePoint;

fn table(attributes: &serde_json::Value) -> LayerForm {
    let table = serde_json::json!({
        "id": "stops", "geometry": "point", "attributes": attributes,
        "class": [{ "id": "bus", "tags": { "highway": "bus_stop" } }],
    });
    serde_json::from_value(table).unwrap()
}

fn names(table: &LayerForm, languages: &[&str]) -> Vec<String> {
    let languages: Vec<String> = languages.iter().map(|&language| language.to_owned()).collect();
    let fields = LayerFields::new(table, &languages).fields();
    fields.into_iter().map(|field| field.name.into_owned()).collect()
}

#[test]
fn attributes_are_typed_and_have_units() {
    let table = table(&serde_json::json!({
        "ele": { "number": "m" }, "name": "names", "ref": "text", "shelter": "yes-no",
    }));
    let languages = ["de".to_owned(), "fr".to_owned()];
    let fields = LayerFields::new(&table, &languages);
    let told: Vec<(String, FieldKind, &str)> = fields
        .fields()
        .into_iter()
        .map(|field| (field.name.into_owned(), field.kind, field.unit))
        .collect();
    let expected = [
        ("object", FieldKind::Text, ""),
        ("id", FieldKind::Integer64, ""),
        ("class", FieldKind::Text, ""),
        ("ele", FieldKind::Real, "m"),
        ("name", FieldKind::Text, ""),
        ("name:de", FieldKind::Text, ""),
        ("name:fr", FieldKind::Text, ""),
        ("ref", FieldKind::Text, ""),
        ("shelter", FieldKind::Integer, ""),
    ];
    assert_eq!(told, expected.map(|(name, kind, unit)| (name.to_owned(), kind, unit)));

    let values = |values| {
        let shape = LayerShape::Point(LatticePoint::new(0, 0));
        let of = LayerObject { class: 0, object: OsmObject::Node(5), values, shape };
        let text = |value| match value {
            FieldValue::Integer(number) => number.to_string(),
            FieldValue::Real(number) => format!("{number:?}"),
            FieldValue::Text(text) => text,
            FieldValue::Null => "null".to_owned(),
        };
        let values = fields.values(&of, "bus", LayerMeasures::default());
        values.into_iter().map(text).collect::<Vec<String>>().join(" ")
    };
    let known = vec![("de".to_owned(), "Dorf".to_owned()), ("fr".to_owned(), "Village".to_owned())];
    let with_own = [vec![(String::new(), "Vitg".to_owned())], known[..1].to_vec()].concat();
    let all = vec![
        Some(AttributeValue::Number(431.5)),
        Some(AttributeValue::Names(with_own)),
        Some(AttributeValue::Text("7".to_owned())),
        Some(AttributeValue::YesNo(false)),
    ];
    assert_eq!(values(all), "node 5 bus 431.5 Vitg Dorf null 7 0");
    let few = vec![None, Some(AttributeValue::Names(known)), None, None];
    assert_eq!(values(few), "node 5 bus null Dorf Dorf Village null null");
}

#[test]
fn no_two_fields_have_one_name() {
    let own = serde_json::json!({
        "id": "text", "Class": "text", "class": "text", "class_": "text", "fid": "text",
        "Geom": "text", "name:de": "text", "name": "names",
    });
    let found = names(&table(&own), &["de", "de"]);
    let expected = [
        "object",
        "id",
        "class",
        "Class_",
        "Geom_",
        "class__",
        "class___",
        "fid_",
        "id_",
        "name",
        "name:de",
        "name:de_",
        "name:de__",
    ];
    assert_eq!(found, expected);
}
