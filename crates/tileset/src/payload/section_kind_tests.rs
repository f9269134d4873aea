//! Each kind of section has its own bit and number, and is in the specification.

use corniche_layers::MAX_LAYERS;

use super::*;

#[test]
fn each_kind_has_a_bit_of_its_own_and_all_has_every_bit() {
    let mut seen = Sections::LAYERS;
    for &kind in SectionKind::FIXED {
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
        Sections::LAYERS,
        Sections::SPANS,
    ];
    assert_eq!(named.into_iter().fold(Sections::NONE, BitOr::bitor), Sections::ALL);
    assert_eq!(named.map(|section| section.0.count_ones()), [1, 2, 2, 2, 1, 1, 1, 1]);
}

#[test]
fn each_kind_has_a_number_of_its_own() {
    let layers = (0..MAX_LAYERS).map(|index| SectionKind::Layer(LayerSlot::new(index).unwrap()));
    let kinds: Vec<SectionKind> = SectionKind::FIXED.iter().copied().chain(layers).collect();
    for &kind in &kinds {
        assert_eq!(SectionKind::from_number(kind.number()), Some(kind));
    }
    let known = (0..=u16::MAX).filter(|&number| SectionKind::from_number(number).is_some());
    assert_eq!(known.count(), kinds.len());
    assert_eq!(LayerSlot::new(MAX_LAYERS), None);
    let numbers =
        [kinds[kinds.len() - MAX_LAYERS], kinds[kinds.len() - 1]].map(SectionKind::number);
    assert_eq!(numbers, [64, 127]);
}

#[test]
fn the_specification_lists_each_kind_by_its_number() {
    let text = include_str!("../../FORMAT.md");
    for &kind in SectionKind::FIXED {
        assert!(text.contains(&format!(" section (kind {})", kind.number())), "{kind:?}");
    }
    assert!(text.contains("Layer sections (kinds 64 to 127)"));
}
