//! The presets in `config/frc` against the published tables.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use corniche_presets::{frc_preset, frc_preset_names, parse_frc_table};
use corniche_roads::{Classified, FrcTable, FunctionalRoadClass, NotARoad};

fn preset(name: &str) -> FrcTable {
    let table = parse_frc_table(frc_preset(name).unwrap()).unwrap();
    assert_eq!(table.name(), name, "a preset is named as its file");
    table
}

const ALL: [&str; 5] = ["default", "valhalla", "fraunhofer", "itinero", "here5"];

/// One row per value, one column per preset, in the order of [`ALL`]; −1 for no road.
const PUBLISHED: [(&str, [i8; 5]); 19] = [
    ("motorway", [0, 0, 0, 0, 0]),
    ("motorway_link", [0, 0, 0, 0, 3]),
    ("trunk", [1, 1, 1, 0, 1]),
    ("trunk_link", [1, 1, 1, 0, 3]),
    ("primary", [2, 2, 2, 1, 2]),
    ("primary_link", [2, 2, 2, 1, 3]),
    ("secondary", [3, 3, 3, 2, 3]),
    ("secondary_link", [3, 3, 3, 2, 4]),
    ("tertiary", [4, 4, 4, 3, 4]),
    ("tertiary_link", [4, 4, 4, 3, 4]),
    ("unclassified", [5, 5, 5, 4, 4]),
    ("residential", [6, 6, 5, 4, 4]),
    ("living_street", [6, 7, 6, 5, 4]),
    ("road", [7, 7, 5, 4, 7]),
    ("service", [7, 7, -1, 7, 4]),
    ("track", [7, 7, -1, 7, 4]),
    ("footway", [8, 7, -1, 7, 7]),
    ("cycleway", [8, 7, -1, 7, 7]),
    ("steps", [8, 7, -1, 7, 7]),
];

#[test]
fn presets_say_what_their_sources_say() {
    let least = FunctionalRoadClass::new(8).unwrap();
    for (column, name) in ALL.into_iter().enumerate() {
        let table = preset(name).with_least_class(least);
        for (value, classes) in PUBLISHED {
            let expected =
                match u8::try_from(classes[column]).ok().and_then(FunctionalRoadClass::new) {
                    Some(class) => Classified::Road(class),
                    None => Classified::NotARoad(NotARoad::Listed),
                };
            assert_eq!(table.classify(&[("highway", value)]), expected, "{name}: {value}");
        }
    }
}

#[test]
fn all_presets_are_compared() {
    assert_eq!(frc_preset_names().collect::<Vec<_>>(), ALL);
}

#[test]
fn streets_of_towns_are_residential_in_the_default_table() {
    let class = FunctionalRoadClass::new(6).unwrap();
    for value in ["living_street", "pedestrian"] {
        assert_eq!(preset("default").classify(&[("highway", value)]), Classified::Road(class));
    }
}

#[test]
fn a_slip_road_is_never_below_residential() {
    for name in ALL {
        let table = preset(name);
        let class = |value| match table.classify(&[("highway", value)]) {
            Classified::Road(class) => class,
            other => panic!("{name}: {value} is {other:?}"),
        };
        for link in ["motorway_link", "trunk_link", "primary_link"] {
            assert!(class(link) < class("residential"), "{name}: {link}");
        }
    }
}

#[test]
fn what_is_not_there_is_a_road_in_no_preset() {
    for name in ALL {
        let table = preset(name);
        for value in [
            "construction",
            "proposed",
            "razed",
            "rest_area",
            "services",
            "bus_stop",
            "platform",
            "elevator",
        ] {
            assert_eq!(
                table.classify(&[("highway", value)]),
                Classified::NotARoad(NotARoad::Listed),
                "{name}: {value}"
            );
        }
        assert_eq!(table.classify(&[("highway", "yes")]), Classified::Unknown("yes"), "{name}");
    }
}

#[test]
fn by_default_other_roads_are_known_and_off() {
    let (table, other) = (preset("default"), FunctionalRoadClass::new(8).unwrap());
    for value in ["footway", "path", "cycleway", "steps", "bridleway", "corridor", "via_ferrata"] {
        assert_eq!(table.classify(&[("highway", value)]), Classified::NotShown(other), "{value}");
    }
}
