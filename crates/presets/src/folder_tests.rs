//! Paths in a settings file are relative to its folder.

use super::*;
use crate::InputFiles;

fn paths(names: &[&str]) -> Vec<PathBuf> {
    names.iter().map(PathBuf::from).collect()
}

#[test]
fn files_are_named_one_by_one_or_in_a_list() {
    let dem = |text: &str| {
        Config::parse(&format!("[inputs]\ndem = {text}\n")).map(|config| config.inputs.dem)
    };
    assert_eq!(dem("\"a.tif\"").unwrap(), paths(&["a.tif"]));
    assert_eq!(dem("[\"a.tif\", \"b.tif\"]").unwrap(), paths(&["a.tif", "b.tif"]));
    assert!(dem("3").unwrap_err().to_string().contains("list of names"));
    assert!(Config::parse("[inputs]\npbf = \"a\"\n").is_err());
    assert!(Config::parse("[output]\noverwrite = true\n").is_err());
}

#[test]
fn paths_begin_at_the_settings_file() {
    let text = "[inputs]\ndem = [\"a.tif\", \"/data/b.tif\", \"s3://bucket/c.tif\", \"../d.tif\"]\nosm = \"e.osm.pbf\"\n\
                [output]\npackage = \"out/f.pmtiles\"\ndefects = \"g.csv\"\n[roads]\nfrc-table = \"mine.toml\"\n\
                [resources]\ntmp = \"work\"\n";
    let config = Config::parse(text).unwrap().in_folder(Path::new("/maps"));
    let expected = ["/maps/a.tif", "/data/b.tif", "s3://bucket/c.tif", "/maps/../d.tif"];
    assert_eq!(config.inputs.dem, paths(&expected));
    assert_eq!(config.inputs.osm, paths(&["/maps/e.osm.pbf"]));
    assert_eq!(config.output.package, Some("/maps/out/f.pmtiles".into()));
    assert_eq!(config.output.defects, Some("/maps/g.csv".into()));
    assert_eq!(config.roads.frc_table.as_deref(), Some("/maps/mine.toml"));
    assert_eq!(config.resources.tmp, Some("/maps/work".into()));
    let preset =
        Config::parse("[inputs]\nterrain = \"old.pmtiles\"\n[roads]\nfrc-table = \"valhalla\"\n")
            .unwrap();
    let preset = preset.in_folder(Path::new("/maps"));
    assert_eq!(preset.roads.frc_table.as_deref(), Some("valhalla"));
    assert_eq!(preset.inputs.terrain, Some("/maps/old.pmtiles".into()));
}

#[test]
fn photos_that_are_off_are_no_file() {
    let photo = |text: &str| {
        let config = Config::parse(&format!("[inputs]\nphoto = {text}\n")).unwrap();
        config.in_folder(Path::new("/maps")).inputs.photo
    };
    assert_eq!(photo("\"off\""), paths(&["off"]));
    assert_eq!(photo("\"./off\""), paths(&["/maps/./off"]));
    assert_eq!(photo("[\"off\", \"a.tif\"]"), paths(&["/maps/off", "/maps/a.tif"]));
}

#[test]
fn layers_are_names_or_files() {
    let layers = |text: &str| {
        let config = Config::parse(&format!("[layers]\nlayers = {text}\n")).unwrap();
        config.in_folder(Path::new("/maps")).layers.tables
    };
    assert_eq!(layers("\"none\""), ["none"]);
    assert_eq!(layers("\"areas\""), ["areas"]);
    assert_eq!(layers("[\"walls.toml\", \"railways\"]"), ["/maps/walls.toml", "railways"]);
}

#[test]
fn lists_stay_lists_and_names_of_drivers_stay_as_they_are() {
    let text = "[inputs]\ndem = [\"@list.txt\", \"@/all/list.txt\", \"GTIFF_DIR:1:a.tif\", \"/vsizip/a.zip/b.tif\", \"c:d.tif\"]\n";
    let config = Config::parse(text).unwrap().in_folder(Path::new("/maps"));
    let expected = [
        "@/maps/list.txt",
        "@/all/list.txt",
        "GTIFF_DIR:1:a.tif",
        "/vsizip/a.zip/b.tif",
        "/maps/c:d.tif",
    ];
    assert_eq!(config.inputs.dem, paths(&expected));
}

#[test]
fn terrain_comes_from_one_place() {
    let of = |dem: &[&str], terrain: Option<&str>| InputFiles {
        dem: paths(dem),
        terrain: terrain.map(Into::into),
        polygon: None,
        osm: Vec::new(),
        photo: Vec::new(),
    };
    let rasters = of(&["a.tif"], None);
    let package = of(&[], Some("old.pmtiles"));
    assert_eq!(rasters.clone().or(package.clone()), rasters);
    assert_eq!(package.clone().or(rasters.clone()), package);
    let with_roads = InputFiles { osm: paths(&["a.osm.pbf"]), ..InputFiles::default() };
    let merged = with_roads.clone().or(rasters.clone());
    assert_eq!((merged.dem, merged.osm), (rasters.dem, with_roads.osm));
}
