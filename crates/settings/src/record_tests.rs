//! The record is written with the same bytes as before the table existed, and every key can be
//! compared.

use super::*;

/// A record with every key that existed before the table, as stored in packages: their hashes
/// depend on every byte.
const EVERY_KEY: &str = r#"{"max_error_m":5.0,"fill_voids":32,"nodata":[-9999.0,0.5],
"height_range_m":[-500.0,9000.0],"dem_band":2,"dem_crs":"EPSG:2056",
"dem_vertical_crs":"EPSG:5728","vertical_crs":"EPSG:5773","vertical_shift_m":-1.5,
"vertical_unit":"foot","crs":"utm","cell_m":[20.0,30.0],"cell_every":3,"scale_latitude_deg":47.5,
"bounds_deg":[9.0,47.0,10.0,48.0],"polygon":{"name":"a.gpkg","sha256":"11111111111122"},
"relief":"full","frc_table":"own","frc_table_sha256":"ab","class_labels":["big","small"],
"classes":[0,8],"class_max_cell_m":[null,60.0],"simplify_cells":0.25,
"photo":{"levels":2,"quality":80},"layers":[{"id":"areas","sha256":"22"}],
"spans":true}"#;

/// The record without any given setting.
const DEFAULT: &str = r#"{"max_error_m":0.0,"fill_voids":0,"nodata":[],"height_range_m":null,
"dem_crs":null,"dem_vertical_crs":null,"vertical_crs":null,"vertical_shift_m":0.0,"crs":null,
"cell_m":null,"cell_every":null,"scale_latitude_deg":null,"frc_table":"","frc_table_sha256":"",
"class_max_cell_m":[],"simplify_cells":0.0}"#;

fn whole() -> SettingsRecord {
    serde_json::from_str(EVERY_KEY).unwrap()
}

#[test]
fn keys_come_in_the_order_of_the_first_packages_and_new_ones_are_left_out() {
    let text = |record: SettingsRecord| serde_json::to_string(&record).unwrap();
    assert_eq!(text(whole()), EVERY_KEY.replace('\n', ""));
    assert_eq!(text(SettingsRecord::default()), DEFAULT.replace('\n', ""));
    assert_eq!(serde_json::from_str::<SettingsRecord>(DEFAULT).unwrap(), SettingsRecord::default());
    let without = DEFAULT.replace("\"fill_voids\":0,", "");
    assert!(serde_json::from_str::<SettingsRecord>(&without).is_err());
    let known = KEYS_IN_ORDER.split(' ');
    assert!(known.eq(SettingsRecord::keys().into_iter().take(26)));
}

/// Each key has a fact that changes with the value. The hash of the table is the exception: the
/// entries of the table are compared one by one.
#[test]
fn every_key_has_a_fact() {
    let facts = whole().facts();
    let mut keys: Vec<&str> = facts.iter().map(|fact| fact.key).collect();
    keys.dedup();
    let expected: Vec<&str> =
        SettingsRecord::keys().into_iter().filter(|key| *key != "frc_table_sha256").collect();
    assert_eq!(keys, expected);
    for (fact, usual) in facts.iter().zip(SettingsRecord::default().facts()) {
        let is_there = KEYS_IN_ORDER.split(' ').any(|key| key == fact.key);
        assert_eq!(fact.value != usual.value, is_there, "{}", fact.name);
    }
    let value = |name: &str| facts.iter().find(|fact| fact.name == name).unwrap().value.as_str();
    assert_eq!(value("--cell"), "20,30");
    assert_eq!(value("--nodata"), "-9999, 0.5");
    assert_eq!(value("--polygon"), "a.gpkg (111111111111…)");
    assert_eq!(value("class-max-cell (--all-classes)"), "0: all, 1: 60");
    assert_eq!(value("--structures"), "spans");
    assert_eq!(value("--photo-quality"), "80");
}

#[test]
fn numbers_beyond_their_limits_are_seen() {
    type Change = (&'static str, fn(&mut SettingsRecord));
    assert_eq!(whole().wrong_number(), None);
    let wrong: [Change; 6] = [
        ("max_error_m", |record| record.max_error_m = -1.0),
        ("nodata", |record| record.nodata[1] = f64::NAN),
        ("cell_m", |record| record.cell_m = Some(Cell { east_m: 1.0, north_m: 0.0 })),
        ("height_range_m", |record| record.height_range_m = Some([0.0, f64::INFINITY])),
        ("bounds_deg", |record| record.bounds_deg = Some([9.0, 47.0, 361.0, 48.0])),
        ("class_max_cell_m", |record| record.class_max_cell_m[1] = Some(-1.0)),
    ];
    for (key, change) in wrong {
        let mut record = whole();
        change(&mut record);
        assert_eq!(record.wrong_number().map(|(key, _)| key), Some(key));
    }
}
