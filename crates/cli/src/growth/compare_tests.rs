//! A comparison of packages names all of their differences.

use corniche_tileset::PolygonRecord;

use super::*;

#[test]
fn packages_have_letters_however_many_they_are() {
    let found = [0, 1, 25, 26, 27, 51, 52, 701, 702].map(letters);
    assert_eq!(found, ["A", "B", "Z", "AA", "AB", "AZ", "BA", "ZZ", "AAA"]);
}

fn compared(manifests: &[Manifest]) -> Vec<Compared<'_>> {
    let compared = |(index, manifest)| Compared {
        label: letters(index),
        name: format!("{index}.pmtiles"),
        manifest,
    };
    manifests.iter().enumerate().map(compared).collect()
}

fn polygon(digit: &str) -> PolygonRecord {
    PolygonRecord { name: "a.geojson".to_owned(), sha256: digit.repeat(64) }
}

/// Each difference that affects growth is listed with the packages that have it, except cell and
/// error bound, which the comparison is about.
#[test]
fn what_is_not_alike_is_said() {
    type Change = fn(&mut Manifest);
    let input = |kind: &str, sha256: &str| InputRecord {
        kind: kind.to_owned(),
        name: "a".to_owned(),
        bytes: 1,
        sha256: sha256.to_owned(),
    };
    let mut base = corniche_testing::package::manifest();
    base.inputs = vec![input("dem", &"1".repeat(64)), input("osm", &"2".repeat(64))];
    let changes: [(&str, Change); 22] = [
        ("", |manifest| manifest.settings.max_error_m = 1.0),
        ("extract", |manifest| manifest.inputs[1].sha256 = "3".repeat(64)),
        ("elevation data", |manifest| manifest.inputs[0].sha256 = "3".repeat(64)),
        ("classes", |manifest| manifest.settings.classes = Some(vec![0, 1])),
        ("classes", |manifest| manifest.settings.frc_table_sha256 = "4".repeat(64)),
        ("classes by level", |manifest| manifest.settings.class_max_cell_m[7] = Some(40.0)),
        ("simplification", |manifest| manifest.settings.simplify_cells = 0.0),
        ("CRS", |manifest| manifest.crs = "EPSG:2056".to_owned()),
        ("bounds", |manifest| manifest.settings.bounds_deg = Some([9.0, 47.0, 10.0, 48.0])),
        ("polygon", |manifest| manifest.settings.polygon = Some(polygon("5"))),
        ("voids filled", |manifest| manifest.settings.fill_voids = 0),
        ("nodata values", |manifest| manifest.settings.nodata = vec![-32767.0, 0.0]),
        ("height range", |manifest| manifest.settings.height_range_m = Some([-500.0, 9000.0])),
        ("vertical unit", |manifest| manifest.settings.vertical_unit = Some("foot".to_owned())),
        ("band of the elevation data", |manifest| manifest.settings.dem_band = Some(2)),
        ("operations between datums", |manifest| {
            manifest.datum_operations.push(DatumOperationRecord {
                from: "EPSG:4267".to_owned(),
                to: "EPSG:4326".to_owned(),
                operation: "NAD27 to WGS 84 (6)".to_owned(),
                accuracy_m: Some(7.0),
                ballpark: false,
            });
        }),
        ("CRS of the elevation data", |manifest| {
            manifest.settings.dem_crs = Some("EPSG:2056".to_owned());
        }),
        ("vertical CRS of the elevation data", |manifest| {
            manifest.settings.dem_vertical_crs = Some("EPSG:5773".to_owned());
        }),
        ("vertical CRS", |manifest| {
            manifest.settings.vertical_crs = Some("EPSG:5773".to_owned());
        }),
        ("vertical shift", |manifest| manifest.settings.vertical_shift_m = 0.5),
        ("scale latitude", |manifest| manifest.settings.scale_latitude_deg = Some(47.5)),
        ("", |manifest| {
            manifest.settings.cell_m = None;
            manifest.settings.cell_every = Some(3);
            manifest.settings.crs = Some("EPSG:32632".to_owned());
        }),
    ];
    for (what, change) in changes {
        let mut manifests = vec![base.clone(); 3];
        change(&mut manifests[1]);
        let packages = compared(&manifests);
        let found = differences(&packages);
        let named: Vec<&str> = found.iter().map(|difference| difference.what).collect();
        assert_eq!(
            named,
            [what].iter().filter(|what| !what.is_empty()).copied().collect::<Vec<_>>()
        );
        let text = to_text(&packages, Digits::Plain);
        assert_eq!(text.contains("The packages differ not only"), !found.is_empty(), "{text}");
        for difference in &found {
            let line = difference.text(&packages);
            assert!(
                line.starts_with(&format!("{what}: A, C: ")) && line.contains("; B: "),
                "{line}"
            );
        }
        assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
        let document = serde_json::to_value(to_document(&packages)).unwrap();
        assert_eq!(document["differences"].as_array().unwrap().len(), found.len());
    }
}

/// Polygons of the same name are distinguished by their vertices.
#[test]
fn polygons_are_told_by_name_and_hash() {
    let mut manifests = vec![corniche_testing::package::manifest(); 2];
    for (manifest, digit) in manifests.iter_mut().zip(["5", "6"]) {
        manifest.settings.polygon = Some(polygon(digit));
    }
    let packages = compared(&manifests);
    let lines: Vec<String> =
        differences(&packages).iter().map(|difference| difference.text(&packages)).collect();
    assert_eq!(lines, ["polygon: A: a.geojson (555555555555…); B: a.geojson (666666666666…)"]);
    assert!(differences(&[]).is_empty());
}
