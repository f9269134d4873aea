//! The plan of a build is the same for the same files and settings, and differs for any others.

#![expect(clippy::unwrap_used, reason = "helpers of tests may unwrap")]

use std::fs;

use corniche_dem::PlanOptions;
use corniche_layers::LayerTable;
use corniche_plan::BuildPlan;
use corniche_roads::{ClassFilter, FrcTable};
use corniche_spec::{PhotoChoice, PlanSettings, RoadSettings, TerrainSettings};
use corniche_testing::sample;
use serde_json::{Value, json};

fn settings() -> PlanSettings {
    let classes = [("motorway", 0), ("primary", 2), ("track", 8)];
    let classes = classes.map(|(value, class)| (value.to_owned(), class)).to_vec();
    let table = FrcTable::new("few", classes, vec!["steps".to_owned()], 7).unwrap();
    PlanSettings {
        dem: vec![sample("pass/pass-dem.tif")],
        terrain_of: None,
        osm: vec![sample("pass/pass.osm.pbf")],
        terrain: TerrainSettings {
            plan: PlanOptions { fill_voids: 32, ..PlanOptions::default() },
            ..TerrainSettings::default()
        },
        roads: RoadSettings {
            table,
            filter: ClassFilter::usual(),
            simplify_cells: 0.25,
            spans: false,
        },
        photo: PhotoChoice::Off,
        layers: Vec::new(),
        attribution: vec!["a credit".to_owned()],
        generator: "corniche 0.0.0".to_owned(),
    }
}

#[test]
fn the_plan_of_the_same_files_and_settings_is_the_same() {
    let plan = BuildPlan::make(&settings()).unwrap();
    let again = BuildPlan::make(&settings()).unwrap();
    assert_eq!(plan, again);
    assert_eq!(plan.hash(), again.hash());
    assert_eq!(plan.differences(&again), [""; 0]);
    // After writing and reading, the plan is the same to the last bit.
    let text = plan.to_json().unwrap();
    let read = BuildPlan::from_json(&text).unwrap();
    assert_eq!(read, plan);
    assert_eq!(read.to_json().unwrap(), text);
    assert_eq!(read.hash(), plan.hash());
    // A worker creates the same plan again from the plan's own settings.
    let own = read.settings().unwrap();
    read.check_same(&BuildPlan::make(&own).unwrap()).unwrap();
}

/// Every value of a plan as a JSON pointer, lists without elements included.
fn leaves(value: &Value, pointer: &str, found: &mut Vec<String>) {
    match value {
        Value::Object(fields) => {
            for (name, value) in fields {
                leaves(value, &format!("{pointer}/{name}"), found);
            }
        }
        Value::Array(items) if !items.is_empty() => {
            for (index, value) in items.iter().enumerate() {
                leaves(value, &format!("{pointer}/{index}"), found);
            }
        }
        _ => found.push(pointer.to_owned()),
    }
}

/// Other valid values for a value.
fn others(value: &Value) -> Vec<Value> {
    match value {
        Value::String(text) => vec![json!(format!("{text}x"))],
        Value::Bool(is) => vec![json!(!is)],
        Value::Array(_) => vec![json!([7.5]), json!(["x"])],
        Value::Number(number) if number.is_f64() => {
            let number = number.as_f64().unwrap();
            vec![json!(number * 2.0 + 0.5), json!(number * 2.0)]
        }
        Value::Number(number) => {
            let number = number.as_i64().unwrap();
            vec![json!(number + 1), json!(number + 256)]
        }
        Value::Null => vec![json!(7.5), json!(7), json!("x"), json!([1.5, 2.5])],
        Value::Object(_) => Vec::new(),
    }
}

/// The name of the option in the message about a changed setting, derived from the field's name.
fn option(pointer: &str) -> String {
    let field = pointer.split('/').nth(2).unwrap();
    let units = ["_m", "_deg", "_cells"];
    let name = units.iter().find_map(|unit| field.strip_suffix(unit)).unwrap_or(field);
    match field {
        "frc_table_sha256" => "edited by hand".to_owned(),
        "class_max_cell_m" => "class-max-cell".to_owned(),
        _ => format!("--{} is ", name.replace('_', "-")),
    }
}

#[test]
fn every_other_value_makes_another_plan_and_is_named() {
    let plan = BuildPlan::make(&settings()).unwrap();
    let written: Value = serde_json::from_str(&plan.to_json().unwrap()).unwrap();
    let mut pointers = Vec::new();
    leaves(&written, "", &mut pointers);
    assert!(pointers.len() > 80, "{pointers:?}");
    for pointer in pointers {
        let changed = others(written.pointer(&pointer).unwrap()).into_iter().find_map(|other| {
            let mut changed = written.clone();
            *changed.pointer_mut(&pointer).unwrap() = other;
            serde_json::from_value::<BuildPlan>(changed).ok()
        });
        let changed = changed.unwrap_or_else(|| panic!("{pointer} has no other valid value"));
        assert_ne!(changed.hash(), plan.hash(), "{pointer}");
        let said = changed.differences(&plan);
        assert_eq!(said.len(), 1, "{pointer}: {said:?}");
        let expected = match pointer.split('/').nth(1).unwrap() {
            "plan_version" => "version".to_owned(),
            "generator" => {
                "this is corniche 0.0.0x, but the store was created by corniche 0.0.0".to_owned()
            }
            "libraries" => "GDAL".to_owned(),
            "inputs" => "pass".to_owned(),
            "settings" => option(&pointer),
            "frc_table" => {
                if pointer.ends_with("name") { "by hand" } else { "--frc-table" }.to_owned()
            }
            "attribution" => {
                "--attribution is a creditx, but the store was created with a credit".to_owned()
            }
            "grid" => "the store was created with".to_owned(),
            "levels" => "level ".to_owned(),
            other => panic!("no expected message is known for {other}"),
        };
        assert!(said[0].contains(&expected), "{pointer}: {said:?}");
    }
}

#[test]
fn another_table_of_a_layer_is_named() {
    let walls = |cells: f64| {
        let form = json!({
            "id": "walls",
            "geometry": "line",
            "simplify_cells": cells,
            "class": [{ "id": "wall", "tags": { "barrier": "wall" } }],
        });
        LayerTable::new(serde_json::from_value(form).unwrap()).unwrap()
    };
    let plan = |layers| BuildPlan::make(&PlanSettings { layers, ..settings() }).unwrap();
    let [own, other] = [0.5, 1.0].map(|cells| plan(vec![walls(cells)]));
    assert_ne!(own.hash(), other.hash());
    for (store, words) in [(&other, "walls ("), (&plan(Vec::new()), "--layers")] {
        let said = own.differences(store);
        assert_eq!(said.len(), 1, "{said:?}");
        assert!(said[0].contains("--layers") && said[0].contains(words), "{said:?}");
    }
    // The plan contains the tables.
    let read = BuildPlan::from_json(&own.to_json().unwrap()).unwrap();
    assert_eq!(read.settings().unwrap().layers, [walls(0.5)]);
    let text =
        own.to_json().unwrap().replacen("\"barrier\": \"wall\"", "\"barrier\": \"fence\"", 1);
    let said = BuildPlan::from_json(&text).unwrap().differences(&own);
    assert!(said.len() == 1 && said[0].contains("edited by hand"), "{said:?}");
}

#[test]
fn a_changed_file_is_named_with_what_changed() {
    let folder = tempfile::tempdir().unwrap();
    let dem = folder.path().join("dem.tif");
    fs::copy(sample("pass/pass-dem.tif"), &dem).unwrap();
    let own = PlanSettings { dem: vec![dem.clone()], osm: Vec::new(), ..settings() };
    let plan = BuildPlan::make(&own).unwrap();
    assert_eq!(plan.inputs.len(), 1);

    let time = fs::metadata(&dem).unwrap().modified().unwrap();
    let file = fs::File::options().append(true).open(&dem).unwrap();
    file.set_modified(time + std::time::Duration::from_mins(3)).unwrap();
    drop(file);
    let touched = BuildPlan::make(&own).unwrap();
    let error = plan.check_same(&touched).unwrap_err().to_string();
    assert!(error.contains("dem.tif has changed since"), "{error}");
    assert!(error.contains("it was written 3.0 minutes later"), "{error}");
    assert_ne!(touched.hash(), plan.hash());

    let size = fs::metadata(&dem).unwrap().len();
    let mut bytes = fs::read(&dem).unwrap();
    bytes.extend(b"more");
    fs::write(&dem, bytes).unwrap();
    let said = BuildPlan::make(&own).unwrap().differences(&plan);
    assert!(said[0].contains(&format!("it had {size} bytes and now has {}", size + 4)), "{said:?}");

    // The same file at another path is another input, because its name alone does not identify the
    // release.
    let other = folder.path().join("other");
    fs::create_dir(&other).unwrap();
    fs::rename(&dem, other.join("dem.tif")).unwrap();
    let moved = PlanSettings { dem: vec![other.join("dem.tif")], ..own };
    let said = BuildPlan::make(&moved).unwrap().differences(&plan);
    assert!(said[0].contains("the list of input files"), "{said:?}");
}

/// The last bits of numbers follow from the settings, so a worker with other libraries notices the
/// difference.
#[test]
fn a_worker_that_derives_another_grid_says_so() {
    let plan = BuildPlan::make(&settings()).unwrap();
    let mut other = plan.clone();
    other.grid.metres_per_unit[0] *= 1.0 + f64::EPSILON;
    let error = plan.check_same(&other).unwrap_err().to_string();
    assert!(error.contains("the number of metres per unit of the CRS"), "{error}");
}

#[test]
fn what_is_no_plan_is_refused() {
    let text = BuildPlan::make(&settings()).unwrap().to_json().unwrap();
    let later = text.replace("\"plan_version\": 11", "\"plan_version\": 12");
    let error = BuildPlan::from_json(&later).unwrap_err().to_string();
    assert!(error.contains("version 12") && error.contains("version 11"), "{error}");
    for bad in ["", "{}", "[7]", &text[..text.len() / 2], "\"plan\""] {
        let error = BuildPlan::from_json(bad).unwrap_err().to_string();
        assert!(error.contains("corniche plan -o"), "{bad}: {error}");
    }
    let more = text.replacen('{', "{\"unknown\": 1,", 1);
    assert!(BuildPlan::from_json(&more).is_err());
    for (field, bad) in [("\"least_class\": 7", "\"least_class\": 70"), ("2000.0", "-1.0")] {
        let plan = BuildPlan::from_json(&text.replacen(field, bad, 1)).unwrap();
        assert!(plan.settings().is_err(), "{bad}");
    }
}
