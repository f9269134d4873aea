use super::*;

#[test]
fn packages_have_letters_however_many_they_are() {
    let found = [0, 1, 25, 26, 27, 51, 52, 701, 702].map(letters);
    assert_eq!(found, ["A", "B", "Z", "AA", "AB", "AZ", "BA", "ZZ", "AAA"]);
}

fn of(manifests: &[Manifest]) -> Vec<Compared<'_>> {
    let compared = |(index, manifest)| Compared {
        label: letters(index),
        name: format!("{index}.pmtiles"),
        manifest,
    };
    manifests.iter().enumerate().map(compared).collect()
}

/// Each thing that makes growth tell of something else is named with who has it; cell and error bound are what is studied.
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
    let changes: [(&str, Change); 9] = [
        ("", |manifest| manifest.settings.max_error_m = 1.0),
        ("extract", |manifest| manifest.inputs[1].sha256 = "3".repeat(64)),
        ("elevation data", |manifest| manifest.inputs[0].sha256 = "3".repeat(64)),
        ("classes", |manifest| manifest.settings.classes = Some(vec![0, 1])),
        ("classes", |manifest| manifest.settings.frc_table_sha256 = "4".repeat(64)),
        ("classes by level", |manifest| manifest.settings.class_max_cell_m[7] = Some(40.0)),
        ("simplification", |manifest| manifest.settings.simplify_cells = 0.0),
        ("CRS", |manifest| manifest.crs = "EPSG:2056".to_owned()),
        ("bounds", |manifest| manifest.settings.bounds_deg = Some([9.0, 47.0, 10.0, 48.0])),
    ];
    for (what, change) in changes {
        let mut manifests = vec![base.clone(); 3];
        change(&mut manifests[1]);
        let packages = of(&manifests);
        let found = differences(&packages);
        let named: Vec<&str> = found.iter().map(|difference| difference.what).collect();
        assert_eq!(
            named,
            [what].iter().filter(|what| !what.is_empty()).copied().collect::<Vec<_>>()
        );
        let text = to_text(&packages, Digits::Plain);
        assert_eq!(text.contains("Not like with like"), !found.is_empty(), "{text}");
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
