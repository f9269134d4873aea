//! The lines for single ways add up to the growth table.

use corniche_roads::FunctionalRoadClass;
use corniche_testing::package;
use corniche_tileset::GrowthRow;

use super::*;
use crate::exit::ExitCode;

fn way(class: u8, source_vertices: u64, geo_vertices: &[u64]) -> WayGrowth {
    WayGrowth {
        way_id: 7,
        class: FunctionalRoadClass::new(class).unwrap(),
        length_m: 12.5,
        source_vertices,
        geo_vertices: geo_vertices.to_vec(),
    }
}

#[test]
fn a_line_has_as_many_cells_as_the_headings() {
    let manifest = package::manifest();
    let cells = |text: &str| text.trim_end().split(',').count();
    let line_of_a_way = line(&way(3, 4, &[5, 6, 8]));
    assert_eq!(line_of_a_way, "7,3,12.500000,4,5,6,8,19,2.000000,4.750000\n");
    assert_eq!(cells(&headings(&manifest)), cells(&line_of_a_way));
    assert_eq!(line(&way(3, 0, &[5, 0, 0])), "7,3,12.500000,0,5,0,0,5,,\n");
}

/// Vertices of the table that belong to no way are listed by class; vertices that do not add up are
/// rejected.
#[test]
fn lines_add_up_to_the_table() {
    let mut manifest = package::manifest();
    let row = |level, class, source_vertices, geo_vertices| GrowthRow {
        level,
        class,
        source_vertices,
        geo_vertices,
        ..GrowthRow::default()
    };
    manifest.growth = vec![row(0, 3, 9, 5), row(2, 3, 9, 14), row(2, 5, 2, 3)];
    let mut sums = Sums::new(&manifest);
    sums.add(&way(3, 4, &[5, 0, 8]));
    sums.add(&way(3, 3, &[0, 0, 6]));
    sums.add(&way(5, 2, &[0, 0, 3]));
    let path = Path::new("a.pmtiles");
    sums.fit(&manifest, path).unwrap();
    assert_eq!(sums.left(&manifest), [(3, 2)]);
    manifest.growth[1].geo_vertices += 1;
    let refused = sums.fit(&manifest, path).unwrap_err();
    assert_eq!(refused.code(), ExitCode::Unusable);
    assert!(refused.to_string().contains("FRC 3 has 15 vertices on level 2"), "{refused}");
}

#[test]
fn the_note_says_what_is_on_no_ground() {
    let path = Path::new("a.csv");
    assert_eq!(note(path, 3, 0, Digits::Plain), "a.csv: 3 OSM ways");
    assert!(note(path, 3, 5, Digits::Plain).contains("5 points"));
}
