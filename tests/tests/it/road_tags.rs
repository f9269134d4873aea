//! Tags of ways in all outputs: through build, `tile`, `export`, `info` and `verify`.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{collections::BTreeMap, fs, path::Path};

use corniche_testing::{pbf, sample};
use e2e::{build_from, copy_pass, corniche, json, manifest, text, write_ascii_grid};
use gdal::{
    Dataset, DriverManager,
    vector::{FieldValue, LayerAccess as _, OGRFieldType},
};
use serde_json::{Value, json};

/// The tags of ways, and the expected values: highway, lanes, width, maxspeed, `sac_scale`,
/// tracktype.
fn ways() -> Vec<(Vec<(&'static str, &'static str)>, Value)> {
    vec![
        (
            vec![("highway", "primary"), ("lanes", "3"), ("width", "9.5"), ("maxspeed", "80")],
            json!(["primary", 3, 9.5, "80", null, null]),
        ),
        (
            vec![("highway", "residential"), ("width", "12'6\""), ("maxspeed", "30mph")],
            json!(["residential", null, 3.81, "30 mph", null, null]),
        ),
        (
            vec![("highway", "track"), ("tracktype", "grade2"), ("lanes", "1.5"), ("width", "0")],
            json!(["track", null, null, null, null, "grade2"]),
        ),
        (
            vec![("highway", "path"), ("sac_scale", "hiking"), ("width", "0.4 m")],
            json!(["path", null, 0.4, null, "hiking", null]),
        ),
        (
            vec![("highway", "motorway"), ("maxspeed", "none"), ("width", "-4")],
            json!(["motorway", null, null, "none", null, null]),
        ),
        (vec![("highway", "service")], json!(["service", null, null, null, null, null])),
    ]
}

/// Builds a package of these ways, side by side on a slope, in this folder.
fn built(folder: &Path) {
    let place = "xllcenter 497000\nyllcenter 5197000\ncellsize 10\nNODATA_value -9999";
    let dem = folder.join("plane.asc");
    write_ascii_grid(&dem, [601, 601], place, |column, _| 500.0 + 0.7 * column as f64);
    let line = |(k, tags)| {
        let lat = 46.945 + 0.002 * k as f64;
        pbf::WayToWrite { tags, points_deg: vec![[8.98, lat], [9.02, lat]] }
    };
    let lines: Vec<pbf::WayToWrite<'_>> =
        ways().into_iter().map(|(tags, _)| tags).enumerate().map(line).collect();
    let osm = folder.join("plane.osm.pbf");
    fs::write(&osm, pbf::extract(&[], &lines)).unwrap();
    let options = ["-q", "--dem-crs", "EPSG:32632", "--classes", "0-8"];
    build_from([&dem, &osm], &folder.join("plane.pmtiles"), &options);
}

/// Every tag has the expected value in `tile` and `export roads`; `info` counts unreadable values;
/// and `verify` finds the same in the extract.
#[test]
fn tags_of_ways_come_out_as_they_are_read() {
    let folder = tempfile::tempdir().unwrap();
    built(folder.path());
    let package = folder.path().join("plane.pmtiles");
    let tiles = json(&["info", text(&package), "--json"])["tiles"].take();
    let mut told: BTreeMap<i64, Value> = BTreeMap::new();
    for id in tiles.as_array().unwrap() {
        let tile = json(&["tile", text(&package), id.as_str().unwrap(), "--json"]);
        for way in tile["attributes"].as_array().unwrap() {
            let keys = ["highway", "lanes", "width_m", "maxspeed", "sac_scale", "tracktype"];
            let values = Value::from_iter(keys.map(|key| way[key].clone()));
            let earlier = told.insert(way["way_id"].as_i64().unwrap(), values.clone());
            assert!(earlier.is_none_or(|earlier| earlier == values), "{way}");
        }
    }
    let wanted: BTreeMap<i64, Value> = (1..).zip(ways().into_iter().map(|(_, out)| out)).collect();
    assert_eq!(told, wanted);

    let odd: BTreeMap<String, u64> = manifest(&package)["counts"]["tags_taken_otherwise"]
        .as_array()
        .unwrap()
        .iter()
        .map(|count| (count["name"].as_str().unwrap().to_owned(), count["count"].as_u64().unwrap()))
        .collect();
    let expected = ["lanes=1.5", "width=-4", "width=0"].map(|tag| (tag.to_owned(), 1));
    assert_eq!(odd, BTreeMap::from(expected));

    let target = folder.path().join("roads.gpkg");
    assert_eq!(corniche(["export", "roads", text(&package), "-o", text(&target)]).code, 0);
    let dataset = Dataset::open(&target).unwrap();
    let mut layer = dataset.layer(0).unwrap();
    let kinds: BTreeMap<String, u32> =
        layer.defn().fields().map(|field| (field.name(), field.field_type())).collect();
    for (name, kind) in [
        ("highway", OGRFieldType::OFTString),
        ("lanes", OGRFieldType::OFTInteger),
        ("width", OGRFieldType::OFTReal),
        ("maxspeed", OGRFieldType::OFTString),
        ("sac_scale", OGRFieldType::OFTString),
        ("tracktype", OGRFieldType::OFTString),
    ] {
        assert_eq!(kinds[name], kind, "{name}");
    }
    for feature in layer.features() {
        let fields: BTreeMap<String, Option<FieldValue>> = feature.fields().collect();
        let value = |name: &str| match fields[name].clone() {
            None => Value::Null,
            Some(FieldValue::IntegerValue(number)) => json!(number),
            Some(FieldValue::Integer64Value(number)) => json!(number),
            Some(FieldValue::RealValue(number)) => json!(number),
            Some(FieldValue::StringValue(text)) => json!(text),
            other => panic!("{name}: {other:?}"),
        };
        let names = ["highway", "lanes", "width", "maxspeed", "sac_scale", "tracktype"];
        let found = Value::from_iter(names.map(value));
        assert_eq!(found, wanted[&value("way_id").as_i64().unwrap()]);
    }

    let osm = folder.path().join("plane.osm.pbf");
    let verified = corniche(["verify", text(&package), "--osm", text(&osm)]);
    assert_eq!(verified.code, 0, "{}{}", verified.out, verified.err);
}

/// A text from GDAL's list of other tags, `"key"=>"value","key"=>"value"`.
fn tag_of<'a>(others: &'a str, key: &str) -> Option<&'a str> {
    let (_, rest) = others.split_once(&format!("\"{key}\"=>\""))?;
    rest.split_once('"').map(|(value, _)| value)
}

/// The tags of the sample's roads are those that an independent reader, GDAL, finds in the extract.
#[test]
fn tags_of_the_sample_are_those_that_gdal_reads() {
    if DriverManager::get_driver_by_name("OSM").is_err() {
        return e2e::skip("GDAL has no driver for OSM");
    }
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["-q", "--classes", "0-8"]);
    let target = folder.path().join("roads.csv");
    assert_eq!(corniche(["export", "roads", text(&package), "-o", text(&target)]).code, 0);
    let names = ["lanes", "width", "maxspeed", "sac_scale", "tracktype"];
    let text_of = |value: Option<FieldValue>| {
        value.and_then(FieldValue::into_string).filter(|text| !text.is_empty())
    };
    let extract = Dataset::open(sample("pass/pass.osm.pbf")).unwrap();
    let mut wanted: BTreeMap<String, Vec<Option<String>>> = BTreeMap::new();
    // A closed way may be in another layer.
    for mut layer in extract.layers() {
        for feature in layer.features() {
            let fields: BTreeMap<String, Option<FieldValue>> = feature.fields().collect();
            let field = |name: &str| text_of(fields.get(name).cloned().flatten());
            let id = field("osm_way_id").or_else(|| field("osm_id"));
            let others = field("other_tags").unwrap_or_default();
            let own = |key: &str| field(key).or_else(|| tag_of(&others, key).map(str::to_owned));
            let mut tags = vec![own("highway")];
            tags.extend(names.map(own));
            wanted.insert(id.unwrap(), tags);
        }
    }
    let exported = Dataset::open(&target).unwrap();
    let mut roads = 0;
    let mut tagged = [0; 5];
    for feature in exported.layer(0).unwrap().features() {
        let fields: BTreeMap<String, Option<FieldValue>> = feature.fields().collect();
        let field = |name: &str| text_of(fields[name].clone());
        let mut found = vec![field("highway")];
        found.extend(names.map(field));
        assert_eq!(found, wanted[&field("way_id").unwrap()], "{:?}", field("way_id"));
        roads += 1;
        for (count, tag) in tagged.iter_mut().zip(&found[1..]) {
            *count += u32::from(tag.is_some());
        }
    }
    assert!(roads > 60, "{roads} roads");
    assert!(tagged[0] > 0 && tagged[3] > 0 && tagged[4] > 0, "{tagged:?}: no such tags");
}
