//! Settings files are parsed completely or rejected, and the command line has precedence.

use super::*;

#[test]
fn settings_files_are_read_whole_or_refused() {
    let config = Config::parse(
        "[terrain]\nmax-error = 5.0\nvertical-shift = -1.5\n[roads]\nsimplify = 0.5\n[resources]\nthreads = 2\n",
    )
    .unwrap();
    assert_eq!(config.terrain.max_error, Some(5.0));
    assert_eq!(config.terrain.vertical_shift, Some(-1.5));
    assert_eq!(config.roads.simplify, Some(0.5));
    assert_eq!(config.resources.threads, NonZeroUsize::new(2));
    for bad in ["[terrain]\nmaxerror = 5.0\n", "[terain]\n", "[resources]\nthreads = 0\n", "a"] {
        assert!(matches!(Config::parse(bad), Err(PresetError::Toml(_))), "{bad}");
    }
}

#[test]
fn one_value_for_no_data_is_said_as_shortly_as_before() {
    let nodata = |text: &str| Config::parse(text).map(|config| config.terrain.nodata);
    assert_eq!(nodata("[terrain]\nnodata = -9999\n").unwrap(), Some(vec![-9999.0]));
    assert_eq!(nodata("[terrain]\nnodata = [-9999, 0.5]\n").unwrap(), Some(vec![-9999.0, 0.5]));
    for nothing in ["[terrain]\n", "[terrain]\nnodata = []\n"] {
        assert_eq!(nodata(nothing).unwrap(), None, "{nothing}");
    }
    assert!(nodata("[terrain]\nnodata = \"none\"\n").is_err());
    let config = Config::parse("[terrain]\nheight-range = [-500, 9000]\n").unwrap();
    assert_eq!(config.terrain.height_range, Some([-500.0, 9000.0]));
    assert!(Config::parse("[terrain]\nheight-range = [1]\n").is_err());
}

#[test]
fn a_cell_is_a_square_or_a_rectangle() {
    let cell = |text: &str| {
        let config = Config::parse(&format!("[terrain]\ncell = {text}\n"));
        config.map(|config| config.terrain.cell.map(Cell::to_array))
    };
    assert_eq!(cell("30").unwrap(), Some([30.0, 30.0]));
    assert_eq!(cell("2.5").unwrap(), Some([2.5, 2.5]));
    assert_eq!(cell("[20, 30.5]").unwrap(), Some([20.0, 30.5]));
    for bad in ["[]", "[1]", "[1, 2, 3]", "\"30\"", "true", "{ east = 1 }"] {
        let said = cell(bad).unwrap_err().to_string();
        assert!(said.contains("[east, north]"), "{bad}: {said}");
    }
    let rest = "[terrain]\ncrs = \"dem\"\ncell-every = 3\nscale-latitude = -46.5\n";
    let terrain = Config::parse(rest).unwrap().terrain;
    assert_eq!((terrain.crs.as_deref(), terrain.cell_every), (Some("dem"), Some(3)));
    assert_eq!(terrain.scale_latitude, Some(-46.5));
    assert!(Config::parse("[terrain]\ncell-every = -1\n").is_err());
}

#[test]
fn a_text_that_is_no_settings_is_not_even_parsed() {
    let long = "#".repeat(crate::error::MAX_TEXT_BYTES + 1);
    assert!(matches!(Config::parse(&long), Err(PresetError::TooLong { .. })));
    let deep = format!("a = {}{}", "[".repeat(100_000), "]".repeat(100_000));
    assert!(matches!(Config::parse(&deep), Err(PresetError::Toml(_))));
}

#[test]
fn what_the_first_leaves_out_is_taken_from_the_second() {
    let read = |text: &str| Config::parse(text).unwrap();
    let first = read("[terrain]\ncell-every = 3\nnodata = -1\n[resources]\nmemory = \"64M\"\n");
    let second = read(
        "[terrain]\ncell = 30\nnodata = [-2, -3]\nmax-error = 7\n[roads]\nall-classes = true\n\
         [resources]\nthreads = 2\nmemory = \"1G\"\n",
    );
    let terrain = first.terrain.clone().or(second.terrain.clone());
    assert_eq!((terrain.cell, terrain.cell_every), (None, Some(3)));
    assert_eq!((terrain.nodata, terrain.max_error), (Some(vec![-1.0]), Some(7.0)));
    assert!(first.roads.or(second.roads).all_classes);
    let resources = first.resources.or(second.resources);
    assert_eq!(resources.threads, NonZeroUsize::new(2));
    assert_eq!(resources.memory.as_deref(), Some("64M"));
    let terrain = TerrainOptions::default().or(second.terrain);
    assert_eq!((terrain.cell, terrain.cell_every), (Some(Cell::from(30.0)), None));
}

/// Options with a different value in each field for each `n`. Every field is named, so that a new
/// one cannot be forgotten.
fn all_options(n: u8) -> (TerrainOptions, RoadOptions, LayerOptions, ResourceOptions) {
    let (text, number) = (|name: &str| format!("{name} {n}"), f64::from(n));
    let terrain = TerrainOptions {
        crs: Some(text("crs")),
        dem_band: Some(n.into()),
        allow_ballpark: true,
        dem_crs: Some(text("dem-crs")),
        dem_vertical_crs: Some(text("dem-vertical-crs")),
        vertical_crs: Some(text("vertical-crs")),
        vertical_shift: Some(number),
        vertical_unit: Some(text("unit")),
        nodata: Some(vec![number]),
        height_range: Some([0.0, number]),
        scale_latitude: Some(number),
        cell: Some(Cell::from(number)),
        cell_every: Some(n.into()),
        max_error: Some(number),
        fill_voids: Some(n.into()),
        relief: Some(if n == 1 { ReliefLevels::Off } else { ReliefLevels::Full }),
        bounds: Some(BoundsChoice::Osm),
        attribution: vec![text("attribution")],
    };
    let roads = RoadOptions {
        frc_table: Some(text("table")),
        classes: Some(Classes::parse(&n.to_string()).unwrap()),
        all_classes: true,
        simplify: Some(number),
        spans: Some(n == 1),
        class_max_cell: Some(BTreeMap::from([(text("class"), number)])),
    };
    let layers = LayerOptions { tables: vec![text("layers")] };
    let resources = ResourceOptions {
        threads: NonZeroUsize::new(n.into()),
        memory: Some(text("memory")),
        tmp: Some(text("tmp").into()),
    };
    (terrain, roads, layers, resources)
}

#[test]
fn each_option_is_the_firsts_and_only_without_it_the_seconds() {
    let (terrain, roads, layers, resources) = all_options(1);
    let (other_terrain, other_roads, other_layers, other_resources) = all_options(2);
    assert_eq!(terrain.clone().or(other_terrain), terrain);
    assert_eq!(TerrainOptions::default().or(terrain.clone()), terrain);
    assert_eq!(roads.clone().or(other_roads), roads);
    assert_eq!(RoadOptions::default().or(roads.clone()), roads);
    assert_eq!(layers.clone().or(other_layers), layers);
    assert_eq!(LayerOptions::default().or(layers.clone()), layers);
    assert_eq!(resources.clone().or(other_resources), resources);
    assert_eq!(ResourceOptions::default().or(resources.clone()), resources);
}

#[test]
fn memory_is_written_as_on_the_command_line() {
    let memory = |text: &str| Config::parse(&format!("[resources]\nmemory = {text}\n"));
    assert_eq!(memory("\"512M\"").unwrap().resources.memory.as_deref(), Some("512M"));
    assert!(memory("1").is_err());
}

#[test]
fn what_only_the_command_line_has_is_refused_in_a_file() {
    assert!(Config::parse("[terrain]\nforce = true\n").is_err());
}
