//! Curves in growth charts can be distinguished without colours, and too many packages are
//! rejected.

use corniche_testing::package;
use corniche_tileset::GrowthRow;

use super::*;

/// A package with this cell size whose levels grow by factors of 1, 2, 3 and so on.
fn manifest(cell_m: f64) -> Manifest {
    let frame = package::frame();
    let frame = corniche_geom::GridFrame::new(
        frame.origin_m(),
        cell_m,
        frame.root_corner(),
        frame.max_level(),
    )
    .unwrap();
    let mut manifest = package::manifest_of(frame);
    let row = |level: u8| GrowthRow {
        level,
        class: 3,
        simplified_vertices: 10,
        geo_vertices: 10 * (u64::from(level) + 1),
        ..GrowthRow::default()
    };
    manifest.growth = (0..=package::MAX_LEVEL).map(row).collect();
    manifest
}

/// The look of curves without colours: dashes of lines and shapes of marks, as written to the SVG.
fn look(number: usize) -> String {
    let manifest = manifest(10.0);
    let curve = Curve {
        name: String::new(),
        color: RGBColor(0, 0, 0),
        points: vec![(0.0, 1.0), (2.0, 2.0)],
        marks: Marks::Shape(number),
    };
    let axes = Axes {
        size_px: (400, 300),
        caption: String::new(),
        x: ChartAxis { description: "", range: -1.0..3.0, ticks: Ticks::Whole(3) },
        y: ChartAxis { description: "", range: 0.0..3.0, ticks: Ticks::Round },
    };
    assert_eq!(manifest.levels.len(), 3);
    draw(&axes, &[curve]).unwrap()
}

#[test]
fn all_packages_of_a_chart_differ_without_colours() {
    let looks: std::collections::BTreeSet<String> = (0..MOST_SHAPES).map(look).collect();
    assert_eq!(looks.len(), MOST_SHAPES);
    assert_eq!(look(MOST_SHAPES), look(0));
}

#[test]
fn a_chart_of_packages_has_their_names_and_cells_and_nothing_between() {
    let manifests = [manifest(10.0), manifest(10.0), manifest(20.0)];
    let packages: Vec<Compared<'_>> = manifests
        .iter()
        .zip(["A", "B", "C"])
        .map(|(manifest, label)| Compared {
            label: label.to_owned(),
            name: format!("folder/{label}-of-a-name-that-is-far-too-long.pmtiles"),
            manifest,
        })
        .collect();
    let svg = comparison(&packages).unwrap();
    let texts: Vec<&str> =
        svg.lines().map(str::trim).filter(|line| !line.starts_with('<')).collect();
    for text in ["10", "20", "40", "80", "A A-of-a-name-that-is-far…"] {
        assert!(texts.contains(&text), "{text}: {texts:?}");
    }
    // Cells between those of levels have no label.
    assert!(!texts.contains(&"14.1") && !texts.contains(&"28.3"), "{texts:?}");
}

#[test]
fn more_packages_than_a_chart_tells_apart_are_refused() {
    assert!(refuse_too_many(MOST_SHAPES).is_ok());
    let refused = refuse_too_many(MOST_SHAPES + 1).unwrap_err();
    assert_eq!(refused.code(), crate::exit::ExitCode::Unusable);
    assert!(refused.to_string().contains("at most 27"), "{refused}");
}
