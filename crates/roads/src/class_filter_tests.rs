//! The default filter shows fewer classes as cells grow, and filters with wrong order are rejected.

use super::*;

fn class(number: u8) -> FunctionalRoadClass {
    FunctionalRoadClass::new(number).unwrap()
}

#[test]
fn usual_is_a_valid_ladder_and_thins_out_with_the_cell() {
    let usual = ClassFilter::usual();
    assert_eq!(ClassFilter::new(*usual.class_max_cell_m()), Ok(usual.clone()));
    for (cell_m, expected) in [
        (1.0, 8),
        (30.0, 8),
        (30.1, 7),
        (60.0, 7),
        (61.0, 5),
        (200.0, 4),
        (401.0, 2),
        (2000.0, 1),
        (1e9, 0),
    ] {
        assert_eq!(usual.least_class(cell_m), Some(class(expected)), "{cell_m} m");
    }
    assert_eq!(ClassFilter::all().least_class(1e9), Some(class(8)));
}

#[test]
fn a_level_may_show_no_roads() {
    let only_fine = ClassFilter::new([Some(10.0); 9]).unwrap();
    assert_eq!(only_fine.least_class(10.0), Some(class(8)));
    assert_eq!(only_fine.least_class(10.5), None);
}

#[test]
fn refuses_cells_that_make_no_ladder() {
    let mut cells = *ClassFilter::usual().class_max_cell_m();
    cells[5] = Some(300.0);
    assert_eq!(ClassFilter::new(cells), Err(ClassFilterError::Order { class: class(5) }));
    cells[5] = None;
    assert_eq!(ClassFilter::new(cells), Err(ClassFilterError::Order { class: class(5) }));
    for bad_m in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let cells = [Some(bad_m); 9];
        assert!(matches!(ClassFilter::new(cells), Err(ClassFilterError::Cell { .. })), "{bad_m}");
    }
}
