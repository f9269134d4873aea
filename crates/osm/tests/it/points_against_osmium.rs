//! Points of real extracts match the objects that osmium lists (`osmium cat -f opl`).

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    collections::{BTreeMap, BTreeSet},
    path::Path,
    process::Command,
};

use crate::common::{POOL, outlined::read_points, request, to_lattice};
use corniche_geom::LatticePoint;
use corniche_layers::OsmObject;
use corniche_osm::{ExtractDefect, LayerPoint};
use corniche_presets::parse_layer_table;
use corniche_testing::{MemoryScratch, real_data};

const TABLE: &str = r#"
id = "places"
geometry = "point"
attributes = { name = "names", population = { number = "" } }
[[class]]
id = "place"
tags = { place = ["city", "town", "village", "hamlet"] }
[[class]]
id = "tree"
tags = { natural = "tree" }
[[class]]
id = "crossing"
tags = { highway = "crossing", crossing = { except = "no" } }
[[class]]
id = "shop"
tags = { shop = true }
"#;

/// Returns the class that tags give, implemented independently: `Tkey=value,key=value`.
fn class_of(fields: &str) -> Option<u8> {
    let tags: BTreeMap<&str, &str> =
        fields.split(',').filter_map(|tag| tag.split_once('=')).collect();
    let is = |key: &str, values: &[&str]| tags.get(key).is_some_and(|own| values.contains(own));
    let crosses = is("highway", &["crossing"]) && tags.contains_key("crossing");
    let classes = [
        is("place", &["city", "town", "village", "hamlet"]),
        is("natural", &["tree"]),
        crosses && !is("crossing", &["no"]),
        tags.contains_key("shop"),
    ];
    classes.iter().position(|&is_it| is_it).map(|class| class as u8)
}

/// The class of an object, and its position in units of 1e-7 degrees if it is a node.
type Listed = (u8, Option<[i64; 2]>);

fn of_osmium(extract: &Path) -> Option<BTreeMap<OsmObject, Listed>> {
    let done = Command::new("osmium").args(["cat", "-f", "opl", "-o", "-"]).arg(extract).output();
    let done = done.ok()?;
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let mut objects = BTreeMap::new();
    for line in String::from_utf8(done.stdout).unwrap().lines() {
        let fields: Vec<&str> = line.split(' ').collect();
        let field = |letter: char| {
            fields[1..].iter().find(|field| field.starts_with(letter)).map(|field| &field[1..])
        };
        let Some(class) = class_of(field('T').unwrap_or_default()) else { continue };
        let id: i64 = fields[0][1..].parse().unwrap();
        let object = match &fields[0][..1] {
            "n" => OsmObject::Node(id),
            "w" => OsmObject::Way(id),
            _ => OsmObject::Relation(id),
        };
        let is_area = field('T').is_some_and(|tags| {
            tags.split(',').any(|tag| ["type=multipolygon", "type=boundary"].contains(&tag))
        });
        if matches!(object, OsmObject::Relation(_)) && !is_area {
            continue;
        }
        let steps = |letter| {
            field(letter).map(|degrees| (degrees.parse::<f64>().unwrap() * 1e7).round() as i64)
        };
        objects.insert(object, (class, steps('x').zip(steps('y')).map(|(x, y)| [x, y])));
    }
    Some(objects)
}

#[test]
fn points_are_the_objects_that_osmium_lists() {
    let table = parse_layer_table(TABLE).unwrap();
    for name in [
        "liechtenstein/liechtenstein-2013-08-03.osm.pbf",
        "liechtenstein/liechtenstein-2021-10-28.osm.pbf",
        "portland/portland-central-filtered.osm.pbf",
        "swellendam/swellendam-roads.osm.pbf",
    ] {
        let Some(extract) = real_data(name) else { return };
        let Some(expected) = of_osmium(&extract) else {
            return corniche_testing::skip("there is no program osmium (Debian: osmium-tool)");
        };
        let scratch = MemoryScratch::default();
        let request = request(&extract, &POOL, &to_lattice, &scratch);
        let (mut points, mut lost): (Vec<LayerPoint>, BTreeSet<(&str, i64)>) = Default::default();
        let summary =
            read_points(&request, &table, &mut |point| points.push(point), &mut |defect| {
                if let ExtractDefect::LostArea { .. } = defect {
                    lost.insert(defect.object());
                }
            })
            .unwrap();
        assert_eq!(summary.objects, expected.len() as u64, "{name}");
        assert!(points.is_sorted_by(|one, next| one.object < next.object), "{name}");
        for point in &points {
            let (class, at) = expected[&point.object];
            assert_eq!(point.class, class, "{name}: {}", point.object);
            if let Some([u, v]) = at {
                assert_eq!(point.at, LatticePoint::new(u, v), "{name}: {}", point.object);
            }
        }
        let found: BTreeSet<OsmObject> = points.iter().map(|point| point.object).collect();
        for object in expected.keys().filter(|object| !found.contains(object)) {
            assert!(lost.contains(&object.parts()), "{name}: {object}");
        }
        println!("{name}: {} objects, {} points, {:?}", expected.len(), points.len(), summary.lost);
    }
}
