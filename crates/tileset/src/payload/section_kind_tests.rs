//! Each kind of section has its own bit and is in the specification.

use super::*;

#[test]
fn each_kind_has_a_bit_of_its_own_and_all_has_every_bit() {
    let mut seen = Sections::NONE;
    for &kind in SectionKind::ALL {
        let section = Sections::from_kind(kind);
        assert_eq!(section.0.count_ones(), 1, "{kind:?}");
        assert_eq!(seen.0 & section.0, 0, "{kind:?} shares its bit");
        assert!(Sections::ALL.contains(section), "{kind:?}");
        seen = seen | section;
    }
    assert_eq!(seen, Sections::ALL);
    let named = [
        Sections::TERRAIN,
        Sections::ROADS_GEO,
        Sections::ROADS_SV,
        Sections::ATTRIBUTES,
        Sections::RELIEF,
        Sections::PHOTO,
        Sections::AREAS,
        Sections::BOUNDARIES,
        Sections::SPANS,
    ];
    assert_eq!(named.into_iter().fold(Sections::NONE, BitOr::bitor), Sections::ALL);
    assert_eq!(named.map(|section| section.0.count_ones()), [1, 2, 2, 2, 1, 1, 2, 1, 1]);
}

#[test]
fn the_specification_lists_each_kind_by_its_number() {
    let text = include_str!("../../FORMAT.md");
    for &kind in SectionKind::ALL {
        assert!(text.contains(&format!(" section (kind {})", kind as u16)), "{kind:?}");
    }
}
