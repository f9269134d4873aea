//! Each setting that determines bytes changes the record and its hash.

use corniche_dem::PlanOptions;
use corniche_geom::Cell;
use corniche_tileset::ReliefLevels;

use super::*;
use crate::PhotoChoice;

const MAX_ERROR_M: f64 = 5.0;

type Settings = (TerrainSettings, RoadSettings);
type Change = (&'static str, fn(&mut Settings));

fn settings() -> Settings {
    let terrain = TerrainSettings {
        plan: PlanOptions { fill_voids: 32, ..PlanOptions::default() },
        allow_fine_cell: true,
        allow_ballpark: true,
        max_error_m: Some(MAX_ERROR_M),
        ..TerrainSettings::default()
    };
    (
        terrain,
        RoadSettings {
            table: table("one"),
            filter: ClassFilter::usual(),
            simplify_cells: 0.25,
            spans: false,
        },
    )
}

fn table(name: &str) -> FrcTable {
    FrcTable::new(name, vec![("motorway".to_owned(), 0)], Vec::new(), 0).unwrap()
}

fn record((terrain, roads): &Settings) -> SettingsRecord {
    let photo = Some(PhotoRecord { levels: 2, quality: 80 });
    let settings = PlanSettings {
        dem: Vec::new(),
        terrain_of: None,
        osm: Vec::new(),
        terrain: terrain.clone(),
        roads: roads.clone(),
        layers: Vec::new(),
        photo: PhotoChoice::Off,
        attribution: Vec::new(),
        generator: String::new(),
    };
    record_settings(&settings, terrain.max_error_m.unwrap_or(MAX_ERROR_M), photo)
}

/// Every setting that determines bytes, with another value for it.
const CHANGES: [Change; 18] = [
    ("dem_crs", |(terrain, _)| terrain.open.dem_crs = Some("EPSG:4326".to_owned())),
    ("nodata", |(terrain, _)| terrain.open.nodata = vec![-9999.0]),
    ("dem_band", |(terrain, _)| terrain.open.band = Some(2)),
    ("dem_vertical_crs", |(terrain, _)| {
        terrain.open.dem_vertical_crs = Some("EPSG:5773".to_owned());
    }),
    ("vertical_crs", |(terrain, _)| terrain.open.vertical_crs = Some("EPSG:5773".to_owned())),
    ("vertical_shift_m", |(terrain, _)| terrain.open.vertical_shift_m = -1.5),
    ("vertical_unit", |(terrain, _)| terrain.open.vertical_unit = Some("foot".to_owned())),
    ("crs", |(terrain, _)| terrain.plan.crs = Some("utm".to_owned())),
    ("cell", |(terrain, _)| terrain.plan.cell = Some(Cell::from([30.0, 40.0]))),
    ("cell_every", |(terrain, _)| terrain.plan.cell_every = Some(3)),
    ("scale_latitude_deg", |(terrain, _)| terrain.plan.scale_latitude_deg = Some(47.0)),
    ("fill_voids", |(terrain, _)| terrain.plan.fill_voids = 0),
    ("height_range_m", |(terrain, _)| terrain.height_range_m = Some([-500.0, 9000.0])),
    ("relief", |(terrain, _)| terrain.relief = ReliefLevels::Full),
    ("max_error_m", |(terrain, _)| terrain.max_error_m = Some(7.5)),
    ("table", |(_, roads)| roads.table = table("two")),
    ("filter", |(_, roads)| roads.filter = ClassFilter::all()),
    ("simplify_cells", |(_, roads)| roads.simplify_cells = 0.0),
];

#[test]
fn each_setting_changes_the_record_and_its_hash_and_comes_back_from_it() {
    let usual = record(&settings());
    for (name, change) in CHANGES {
        let mut changed = settings();
        change(&mut changed);
        let said = record(&changed);
        assert_ne!(said, usual, "{name}");
        assert_ne!(sha256(&said), sha256(&usual), "{name}");
        let found = terrain(&said);
        assert_eq!(found, changed.0, "{name}");
        let found = (found, roads(&said, changed.1.table.clone()).unwrap());
        assert_eq!(record(&found), said, "{name}");
    }
}

#[test]
fn what_only_lets_a_build_begin_is_not_recorded() {
    let mut careful = settings();
    careful.0.allow_fine_cell = false;
    careful.0.allow_ballpark = false;
    assert_eq!(record(&careful), record(&settings()));
}
