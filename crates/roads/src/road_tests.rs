//! The numbers of road attributes are the numbers that packages store.

use super::*;

/// Packages store these numbers.
#[test]
fn a_variants_number_is_its_index_in_the_list() {
    let forms = [Form::Ordinary, Form::DualCarriageway, Form::Link, Form::Roundabout];
    assert_eq!(Form::ALL, forms);
    assert_eq!(Structure::ALL, [Structure::Ground, Structure::Bridge, Structure::Tunnel]);
    assert_eq!(Oneway::ALL, [Oneway::No, Oneway::Forward, Oneway::Backward]);
    assert!(Form::ALL.iter().enumerate().all(|(index, &form)| form as usize == index));
    assert!(Structure::ALL.iter().enumerate().all(|(index, &found)| found as usize == index));
    assert!(Oneway::ALL.iter().enumerate().all(|(index, &oneway)| oneway as usize == index));
}

#[test]
fn there_are_as_many_classes_as_numbers_of_classes() {
    let classes: Vec<FunctionalRoadClass> = FunctionalRoadClass::all().collect();
    assert_eq!(classes.len(), FunctionalRoadClass::COUNT);
    for (number, &class) in classes.iter().enumerate() {
        assert_eq!(FunctionalRoadClass::new(number as u8), Some(class));
        assert_eq!(usize::from(class.number()), number);
    }
    assert_eq!(FunctionalRoadClass::new(FunctionalRoadClass::COUNT as u8), None);
}
