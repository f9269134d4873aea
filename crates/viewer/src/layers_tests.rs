//! Which layers are shown, and how a style draws their classes.

use corniche_layers::{LayerForm, LayerGeometry};
use corniche_tileset::{LayerClassRecord, LayerCounts, LayerRecord};

use super::*;

/// A package with layers of these tables and with objects of these classes.
pub(crate) fn package(layers: Vec<(LayerForm, Vec<u8>)>) -> Manifest {
    let record = |(table, kept): (LayerForm, Vec<u8>)| {
        let of = |class| LayerClassRecord { class, objects: 3, length_um: 0, area_km2: 0.0 };
        let kept = kept.into_iter().map(of).collect();
        let counts = LayerCounts { objects: 1, kept, lost: Vec::new(), unread_values: Vec::new() };
        LayerRecord { table, counts, levels: Vec::new() }
    };
    let layers = layers.into_iter().map(record).collect();
    Manifest { layers, ..corniche_testing::package::manifest() }
}

/// A built-in table.
pub(crate) fn built_in(id: &str) -> LayerForm {
    let table = corniche_config::LAYERS.iter().find(|(name, _)| *name == id).unwrap();
    toml::from_str(table.1).unwrap()
}

/// A layer that no style knows.
pub(crate) fn own(id: &str, geometry: LayerGeometry, classes: usize) -> LayerForm {
    let mut text = format!("id = \"{id}\"\ngeometry = \"{}\"\n", geometry.name());
    text.extend((0..classes).map(|class| format!("[[class]]\nid = \"class-{class}\"\n")));
    toml::from_str(&text).unwrap()
}

/// A class of the layer in this position.
pub(crate) fn class(layer: u8, class: u8) -> LayerClass {
    LayerClass { layer: LayerSlot::new(layer).unwrap(), class }
}

fn manifest() -> Manifest {
    let tables = [
        built_in("areas"),
        own("walls", LayerGeometry::Line, 2),
        built_in("boundaries"),
        own("trees", LayerGeometry::Point, 1),
    ];
    package(tables.into_iter().map(|table| (table, Vec::new())).collect())
}

#[test]
fn lists_name_the_layers_that_are_shown() {
    let shown = |list| {
        let shown = ShownLayers::from_list(list);
        ["areas", "walls", "boundaries", "trees"].map(|id| shown.contains(id))
    };
    assert_eq!(shown("none"), [false; 4]);
    assert_eq!(shown(""), [false; 4]);
    assert_eq!(shown("walls, trees"), [false, true, false, true]);
    assert!(ShownLayers::default().contains("anything"));
    let manifest = manifest();
    assert_eq!(ShownLayers::from_list("areas,trees").check(&manifest), Ok(()));
    assert_eq!(ShownLayers::ALL.check(&manifest), Ok(()));
    let error = ShownLayers::from_list("areas,hedges").check(&manifest).unwrap_err().to_string();
    assert_eq!(
        error,
        "the package has no layer \"hedges\"; its layers are areas, walls, boundaries, trees"
    );
    let none = package(Vec::new());
    let error = ShownLayers::from_list("areas").check(&none).unwrap_err().to_string();
    assert!(error.ends_with("it has no layers at all"), "{error}");
}

#[test]
fn layers_are_hidden_and_shown_one_by_one() {
    let mut shown = ShownLayers::ALL;
    let all = || ["areas", "walls", "trees"].into_iter();
    shown.toggle("walls", all());
    assert_eq!(all().map(|id| shown.contains(id)).collect::<Vec<_>>(), [true, false, true]);
    shown.toggle("trees", all());
    shown.toggle("walls", all());
    assert_eq!(shown, ShownLayers::from_list("areas,walls"));
}

#[test]
fn only_shown_layers_are_drawn_and_read() {
    let (manifest, style) = (manifest(), Style::road_atlas());
    let drawn = |shown: &ShownLayers| {
        let layers = PackageLooks::new(&manifest, &style, shown).drawn_layers();
        layers.into_iter().map(LayerSlot::index).collect::<Vec<_>>()
    };
    assert_eq!(drawn(&ShownLayers::ALL), [0, 1, 2, 3]);
    assert_eq!(drawn(&ShownLayers::from_list("trees,walls")), [1, 3]);
    assert!(drawn(&ShownLayers::from_list("none")).is_empty());
    // The style for photos draws water alone.
    let photo = corniche_styles::parse_style(corniche_styles::style_preset("photo").unwrap());
    let looks = PackageLooks::new(&manifest, &photo.unwrap(), &ShownLayers::ALL);
    assert!(looks.area(class(0, 3)).is_some() && looks.area(class(0, 5)).is_none());
    assert_eq!(looks.point(class(0, 3)), None, "an area is no point");
    assert_eq!(looks.look(class(9, 0)), None);
}

/// Lines have the styles of their classes, a smaller number for what is above others.
#[test]
fn lines_are_drawn_with_the_styles_of_their_classes() {
    let (manifest, style) = (manifest(), Style::road_atlas());
    let looks = PackageLooks::new(&manifest, &style, &ShownLayers::ALL);
    for (of, look) in looks.all() {
        let place = looks.places.place(of);
        match look {
            LayerLook::Line(line) => {
                let Some((LineLayer::Package(group), number)) = place else { panic!("{of:?}") };
                assert_eq!(looks.lines(group)[usize::from(number)], line);
            }
            _ => assert_eq!(place, None),
        }
    }
    assert!(looks.lines(9).is_empty());
    let hidden = PackageLooks::new(&manifest, &style, &ShownLayers::from_list("walls"));
    let drawn = (0..2).flat_map(|group| hidden.lines(group)).filter(|line| line.opacity > 0.0);
    assert_eq!(drawn.count(), 2);
}
