//! Layers of one's own, which no style knows: from a package on disk to a picture and its legend.
#![allow(clippy::unwrap_used, reason = "this is test code, helpers included")]

use std::path::Path;

use corniche_geom::{LatticePoint, TileId};
use corniche_layers::{LayerForm, OsmObject};
use corniche_styles::{Style, parse_style};
use corniche_testing::package::{encoded, frame, ids, manifest, with_section, written_with};
use corniche_tileset::{
    AreaPolygon, LayerClassRecord, LayerCoding, LayerCounts, LayerObject, LayerRecord, LayerShape,
    LayerSlot, Manifest, Sections, encode_layer,
};
use corniche_viewer::{
    CameraRequest, DrawError, PackageLooks, PictureOptions, RenderRequest, Rendered, RoadMethod,
    RoadOptions, ShownLayers,
    tiles::{LineLayer, MapPackage as _, PackageSource, TileDecoder, TileSource as _},
};

use crate::support::gpu;

/// A layer's id, its geometry, and its colour in [`style`].
const LAYERS: [(&str, &str, [u8; 3]); 3] = [
    ("plants", "area", [255, 0, 0]),
    ("walls", "line", [0, 255, 0]),
    ("trees", "point", [0, 0, 255]),
];

fn table(id: &str, geometry: &str) -> LayerForm {
    let class = |id: &str| format!("[[class]]\nid = \"{id}\"\ntags = {{ barrier = \"{id}\" }}\n");
    let text =
        format!("id = \"{id}\"\ngeometry = \"{geometry}\"\n{}{}", class("one"), class("two"));
    toml::from_str(&text).unwrap()
}

fn with_layers() -> Manifest {
    let layer = |(id, geometry, _): &(&str, &str, [u8; 3])| {
        let kept = vec![LayerClassRecord { class: 1, objects: 1, length_um: 0, area_km2: 0.0 }];
        let counts = LayerCounts { objects: 1, kept, lost: Vec::new(), unread_values: Vec::new() };
        LayerRecord { table: table(id, geometry), counts, levels: Vec::new() }
    };
    Manifest { layers: LAYERS.iter().map(layer).collect(), ..manifest() }
}

/// The object of a layer in a tile: a square, a line along its lower side, or a point above it.
fn object(geometry: &str, id: TileId) -> LayerObject {
    let bounds = frame().tile_lattice_bounds(id);
    let side = bounds.max.u - bounds.min.u;
    let at = |x: i64, y: i64| {
        LatticePoint::new(bounds.min.u + side / 64 * x, bounds.min.v + side / 64 * y)
    };
    let shape = match geometry {
        "area" => LayerShape::Area(vec![AreaPolygon {
            rings: vec![vec![at(8, 40), at(20, 40), at(20, 56), at(8, 56)]],
        }]),
        "line" => LayerShape::Line(vec![at(8, 36), at(28, 36)]),
        _ => LayerShape::Point(at(12, 60)),
    };
    LayerObject { class: 1, object: OsmObject::Way(5), values: Vec::new(), shape }
}

/// A tile of the small package with an object of each layer.
fn tile(id: TileId) -> Vec<u8> {
    LAYERS.iter().zip(0_u8..).fold(encoded(id), |bytes, ((name, geometry, _), slot)| {
        let coding = LayerCoding::from_table(&table(name, geometry));
        let (slot, objects) = (LayerSlot::new(slot).unwrap(), [object(geometry, id)]);
        let section = encode_layer(id, &frame(), slot, &coding, 1, &objects).unwrap().unwrap();
        with_section(&bytes, id, section)
    })
}

fn package(folder: &Path) -> PackageSource {
    let path = folder.join("small.pmtiles");
    let bytes = written_with(&with_layers(), ids().into_iter().map(|id| (id, tile(id))));
    std::fs::write(&path, bytes).unwrap();
    PackageSource::open(&path).unwrap()
}

/// A style with default looks of layers that nothing else has.
fn style() -> Style {
    let text = "base = \"road-atlas\"\n\
        [layer_defaults.area]\ncolor = \"#FF0000\"\nopacity = 1\n\
        [layer_defaults.line]\ncolor = \"#00FF00\"\nwidth_px = 6\nopacity = 1\n\
        [layer_defaults.point]\ncolor = \"#0000FF\"\nsize_px = 12\noutline = \"#0000FF\"\n\
        [background]\nhaze_reach = 1000\n";
    parse_style(text).unwrap()
}

fn request(style: Style, layers: ShownLayers) -> RenderRequest {
    RenderRequest {
        name: "small".to_owned(),
        options: PictureOptions {
            size_px: [400, 400],
            roads: RoadOptions::for_method(RoadMethod::None),
            screen_space_error_px: 2.0,
            cell_px: f64::INFINITY,
            exaggeration: 1.0,
            supersampling: 1,
            style,
            layers,
        },
        camera: CameraRequest::Overview,
        legend: None,
        title: None,
        is_wireframe: false,
    }
}

/// Renders a request with the decoder that it needs.
fn rendered(folder: &Path, request: &RenderRequest) -> Result<Rendered, DrawError> {
    let package = package(folder);
    let options = &request.options;
    let looks = options.looks(package.manifest());
    let decoder =
        TileDecoder::default().for_look(options.roads.method, &options.style, looks.drawn_layers());
    corniche_viewer::render(request, &package.with_decoder(decoder), &|| false)
}

/// How many pixels have the colour of each layer.
fn pixels(rendered: &Rendered) -> [usize; 3] {
    LAYERS.map(|(_, _, color)| {
        let is_near = |pixel: &&image::Rgba<u8>| {
            pixel.0[..3].iter().zip(color).all(|(one, other)| one.abs_diff(other) < 24)
        };
        rendered.picture.pixels().filter(is_near).count()
    })
}

#[test]
fn layers_without_a_style_have_the_default_look_and_hidden_ones_are_not_drawn() {
    let Some(_) = gpu() else { return };
    let folder = tempfile::tempdir().unwrap();
    let drawn = |list: ShownLayers| rendered(folder.path(), &request(style(), list)).unwrap();
    let none = drawn(ShownLayers::from_list("none"));
    assert_eq!(pixels(&none), [0; 3]);
    let all = drawn(ShownLayers::ALL);
    let found = pixels(&all);
    assert!(found[0] > 300 && found[1] > 50 && found[2] > 50, "{found:?}");
    assert!(all.report.area_polygons > 0 && all.report.layer_points > 0);
    assert_eq!([none.report.area_polygons, none.report.layer_points], [0, 0]);
    for (layer, (id, _, _)) in LAYERS.iter().enumerate() {
        let found = pixels(&drawn(ShownLayers::from_list(id)));
        for (other, count) in found.into_iter().enumerate() {
            assert_eq!(count > 0, other == layer, "{id}: {found:?}");
        }
    }
    // The built-in style shows them, too.
    let with = |list| rendered(folder.path(), &request(Style::road_atlas(), list)).unwrap().picture;
    assert_ne!(with(ShownLayers::ALL), with(ShownLayers::from_list("none")));
}

#[test]
fn a_layer_that_the_package_lacks_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let error = rendered(folder.path(), &request(style(), ShownLayers::from_list("hedges")));
    let error = error.unwrap_err().to_string();
    assert!(
        error.contains("no layer \"hedges\"") && error.contains("plants, walls, trees"),
        "{error}"
    );
}

#[test]
fn only_what_is_shown_is_decoded() {
    let folder = tempfile::tempdir().unwrap();
    let package = package(folder.path());
    let manifest = package.manifest().clone();
    let has = |decoder: TileDecoder| {
        let tile = decoder.tile(Some(&tile(TileId::ROOT)), TileId::ROOT, &manifest).unwrap();
        let lines = tile.lines.tile_layer(LineLayer::Package(0)).is_some();
        [!tile.areas.is_empty(), lines, !tile.points.places_in_tile.is_empty()]
    };
    assert_eq!(has(TileDecoder::default()), [true; 3]);
    for (list, expected) in [
        ("plants", [true, false, false]),
        ("walls,trees", [false, true, true]),
        ("none", [false; 3]),
    ] {
        let looks = PackageLooks::new(&manifest, &style(), &ShownLayers::from_list(list));
        let decoder = TileDecoder::default().with_layers_of(&style(), looks.drawn_layers());
        assert_eq!(decoder.sections().contains(Sections::LAYERS), list != "none");
        assert_eq!(has(decoder), expected, "{list}");
    }
    // Marks are on the ground.
    let tile = package.load(TileId::ROOT).unwrap();
    let [x, y, z] = tile.points.places_in_tile[0].map(f64::from);
    let [east, north, height_m] = tile.reference_m;
    let ground_m = tile.ground_height_m([east + x, north + y]).unwrap();
    assert!((height_m + z - ground_m).abs() < 0.01, "{} {ground_m}", height_m + z);
}

#[test]
fn the_legend_names_classes_of_points_lines_and_areas_that_are_in_the_picture() {
    let Some(_) = gpu() else { return };
    let folder = tempfile::tempdir().unwrap();
    let legend = corniche_viewer::LegendRequest {
        road_labels: std::array::from_fn(|class| format!("road {class}")),
        scale: None,
    };
    let with = |list: &str| {
        let request = RenderRequest {
            legend: Some(legend.clone()),
            ..request(style(), ShownLayers::from_list(list))
        };
        rendered(folder.path(), &request).unwrap()
    };
    // Samples in the legend have the colours of the layers; without a layer the legend is smaller.
    let all = pixels(&with("plants,walls,trees"));
    let without = rendered(folder.path(), &request(style(), ShownLayers::ALL)).unwrap();
    let plain = pixels(&without);
    for (layer, (with, plain)) in all.into_iter().zip(plain).enumerate() {
        assert!(with != plain, "layer {layer}: {with} {plain}");
    }
    assert_eq!(pixels(&with("none")), [0; 3]);
}
