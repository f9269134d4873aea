//! Hostile packages that lie about layers: in their sections, tables and counts.

use corniche_geom::{LatticePoint, TileId};
use corniche_layers::{LayerGeometry, OsmObject};
use corniche_tileset::{
    AreaPolygon, LayerCoding, LayerObject, LayerShape, LayerSlot, encode_layer,
    limits::{MAX_LAYER_NAMES, MAX_LAYER_OBJECTS, MAX_LAYER_TEXTS, MAX_POINTS, MAX_RINGS},
};
use serde_json::{Value, json};

use crate::{
    package,
    pmtiles::{gzip, put_varint},
};

use super::{
    case::{Case, ReadOutcome, refused},
    parts::{PackageParts, column, metadata, numbers, payload, section_of},
    tile_cases::with_sections,
};

/// The sections of the layers of the valid package, in the order of [`LayerGeometry::ALL`].
const LINES: u16 = 64;
const AREAS: u16 = 65;
const POINTS: u16 = 66;

/// The columns of a section: class and type, ids, texts, the attributes (a number, names, a text,
/// yes or no), and shapes.
const KINDS: usize = 0;
const TEXTS: usize = 2;
const NUMBER: usize = 3;
const NUMBER_VALUES: usize = 4;
const NAMES: usize = 5;
const LANGUAGES: usize = 6;
const NAME_TEXTS: usize = 7;
const TEXT: usize = 8;
const YES_NO: usize = 9;
const SHAPES: usize = 10;

/// A section of this number of objects with these columns.
fn section(objects: u64, columns: &[Vec<u8>]) -> Vec<u8> {
    let mut raw = vec![1];
    put_varint(&mut raw, objects);
    raw.extend(columns.concat());
    raw
}

/// The texts of a section, and their numbers of bytes.
fn texts(texts: &[&[u8]]) -> Vec<u8> {
    let mut table = Vec::new();
    put_varint(&mut table, texts.len() as u64);
    table.extend(numbers(&texts.iter().map(|text| text.len() as u64).collect::<Vec<_>>()));
    table.extend(texts.concat());
    table
}

/// Columns of node 0 of class 0 without values, then those of shapes.
fn columns(shapes: &[Vec<u8>]) -> Vec<Vec<u8>> {
    let mut columns = vec![vec![0]; SHAPES];
    columns[TEXTS] = texts(&[]);
    columns.extend_from_slice(shapes);
    columns
}

/// A line of two points in the tile.
fn line() -> Vec<Vec<u8>> {
    columns(&[numbers(&[0]), numbers(&[2, 2]), numbers(&[2, 0])])
}

/// A point in the tile's south-western corner.
fn point() -> Vec<Vec<u8>> {
    columns(&[numbers(&[0]), numbers(&[0])])
}

/// A triangle, with the range-coded bits of the real encoder.
fn area() -> Vec<Vec<u8>> {
    let corner = package::frame().tile_lattice_bounds(TileId::ROOT).min;
    let at = |u, v| LatticePoint::new(corner.u + u, corner.v + v);
    let rings = vec![vec![at(0, 0), at(99, 0), at(0, 99)]];
    let triangle = LayerObject {
        class: 0,
        object: OsmObject::Node(0),
        values: vec![],
        shape: LayerShape::Area(vec![AreaPolygon { rings }]),
    };
    let coding = LayerCoding { geometry: LayerGeometry::Area, classes: 1, attributes: vec![] };
    let (frame, slot) = (package::frame(), LayerSlot::new(0).unwrap());
    let encoded = encode_layer(TileId::ROOT, &frame, slot, &coding, 1, &[triangle]).unwrap();
    // The spacing, a count, two columns, no texts, three columns of shapes.
    let bits = encoded.unwrap().into_bytes().split_off(9);
    columns(&[numbers(&[0]), numbers(&[0]), numbers(&[0]), bits])
}

/// A package with this section.
fn with(kind: u16, raw: &[u8]) -> Vec<u8> {
    with_sections(&[section_of(kind, raw)])
}

/// The valid package with other layers in its manifest.
fn with_layers(change: impl FnOnce(&mut Vec<Value>)) -> PackageParts {
    let mut metadata = metadata();
    change(metadata["corniche"]["layers"].as_array_mut().unwrap());
    PackageParts { metadata: gzip(metadata.to_string().as_bytes()), ..PackageParts::good() }
}

pub(crate) fn all() -> Vec<Case> {
    let mut cases = sections();
    cases.extend(large_sections());
    cases.extend(manifests());
    cases
}

fn sections() -> Vec<Case> {
    // One object, with another column.
    let changed = |kind, mut columns: Vec<Vec<u8>>, at: usize, column: Vec<u8>| {
        columns[at] = column;
        with(kind, &section(1, &columns))
    };
    let point_with = |at, column| changed(POINTS, point(), at, column);
    let line_with = |at, column| changed(LINES, line(), at, column);
    let area_with = |at, column| changed(AREAS, area(), at, column);
    // Names of a point, in the languages with these numbers.
    let names = |languages: &[u64]| {
        let mut columns = point();
        columns[TEXTS] = texts(&[b"de", b"en"]);
        columns[NAMES] = numbers(&[languages.len() as u64]);
        columns[LANGUAGES] = numbers(languages);
        columns[NAME_TEXTS] = numbers(&vec![0; languages.len()]);
        with(POINTS, &section(1, &columns))
    };
    // The number of a point: how it is stored, and its code.
    let number = |head: u64, code: u64| {
        let mut columns = point();
        (columns[NUMBER], columns[NUMBER_VALUES]) = (numbers(&[head]), numbers(&[code]));
        with(POINTS, &section(1, &columns))
    };
    let infinite = f64::INFINITY.to_bits();
    let (huge, far) = (numbers(&[1 << 56]), numbers(&[u64::MAX - 1]));
    let read = |name, bytes| Case { name, bytes, outcome: ReadOutcome::Read, limit_mib: 4 };
    let spaced = |kind, spacing: u64, columns: &[Vec<u8>]| {
        let mut raw = Vec::new();
        put_varint(&mut raw, spacing);
        raw.extend(&section(1, columns)[1..]);
        with(kind, &raw)
    };
    let whole = section(1, &line());
    vec![
        read("a line", with(LINES, &whole)),
        read("an area", with(AREAS, &section(1, &area()))),
        read("a point", with(POINTS, &section(1, &point()))),
        read("names in two languages", names(&[0, 1])),
        read("half a metre", number(2, 0.5_f64.to_bits())),
        read("a section of a layer that the package lacks", with(67, &[0])),
        refused(
            "a class beyond the table",
            point_with(KINDS, numbers(&[1 << 2])),
            "section of layer \"point\": invalid: a class;",
        ),
        refused("class 2^62 - 1", point_with(KINDS, numbers(&[u64::MAX - 3])), "invalid: a class;"),
        refused("an object of type 3", point_with(KINDS, numbers(&[3])), "a type of object"),
        refused("text 0 of none", point_with(TEXT, numbers(&[1])), "the number of a text"),
        refused("text 2^64 - 2", point_with(TEXT, numbers(&[u64::MAX])), "the number of a text"),
        refused(
            "a text that is no text",
            point_with(TEXTS, texts(&[b"a\xff"])),
            "a text that is not UTF-8",
        ),
        refused(
            "a character in two texts",
            point_with(TEXTS, texts(&[b"\xc3", b"\xa9"])),
            "a text that is not UTF-8",
        ),
        refused("texts beyond the bytes", point_with(TEXTS, vec![1, 1, 99]), "bytes of all texts"),
        refused("neither yes nor no", point_with(YES_NO, numbers(&[3])), "an attribute"),
        refused("a number of a third kind", number(3, 0), "an attribute"),
        refused("an infinite number", number(2, infinite), "an attribute"),
        refused("a number that is none", number(2, infinite + 1), "an attribute"),
        refused("languages upside down", names(&[1, 0]), "an attribute"),
        refused("a language twice", names(&[1, 1]), "an attribute"),
        refused("257 names of an object", names(&[0; 257]), "an attribute"),
        refused("2^56 names", point_with(NAMES, huge.clone()), "number of names: "),
        refused("2^56 polygons", area_with(SHAPES, huge.clone()), "number of polygons: "),
        refused("2^56 rings", area_with(SHAPES + 1, huge.clone()), "number of rings: "),
        refused("2^56 points of a ring", area_with(SHAPES + 2, huge.clone()), "number of points: "),
        refused("2^56 points of a line", line_with(SHAPES, huge), "number of points: "),
        refused(
            "a point west of the tile",
            point_with(SHAPES, numbers(&[1])),
            "section of layer \"point\": invalid: a point outside the tile",
        ),
        refused("a point at the end of the world", point_with(SHAPES, far.clone()), "far outside"),
        refused("a line around the world", line_with(SHAPES + 2, far), "end too early"),
        refused(
            "a line to the end of the world",
            line_with(SHAPES + 2, numbers(&[0, u64::MAX - 1])),
            "far outside",
        ),
        refused(
            "a line that stands still",
            line_with(SHAPES + 1, numbers(&[2, 0])),
            "section of layer \"line\": invalid: a line with two equal points",
        ),
        refused(
            "a ring outside the tile",
            spaced(AREAS, 1 << 40, &area()),
            "section of layer \"area\": invalid: a point outside the tile",
        ),
        refused("a ring of nothing", area_with(SHAPES + 3, vec![]), "section of layer \"area\""),
        refused(
            "a ring of ones",
            area_with(SHAPES + 3, vec![255; 99]),
            "section of layer \"area\"",
        ),
        refused("a lattice of no spacing", spaced(LINES, 0, &line()), "the spacing of a layer's"),
        refused(
            "a lattice of 2^40 + 1 steps",
            spaced(LINES, (1 << 40) + 1, &line()),
            "the spacing of a layer's",
        ),
        refused("nine planes", line_with(SHAPES, vec![9]), "more than eight byte planes"),
        refused("a layer cut short", with(LINES, &whole[..whole.len() - 1]), "end too early"),
        refused("a layer and a byte", with(LINES, &[&whole[..], &[0]].concat()), "left over"),
        refused("lines in place of points", with(POINTS, &whole), "left over"),
    ]
}

/// Sections with the largest numbers of something, and with a few more.
fn large_sections() -> Vec<Case> {
    let limited = |limit_mib, case: Case| Case { limit_mib, ..case };
    let read = |name, limit_mib, bytes| Case { name, bytes, outcome: ReadOutcome::Read, limit_mib };
    let points = |count: usize| section(count as u64, &point());
    let named = |count: usize| {
        let objects = count / 256;
        let mut columns = point();
        let languages: Vec<String> = (0..256).map(|number| format!("{number:03}")).collect();
        columns[TEXTS] = texts(&languages.iter().map(String::as_bytes).collect::<Vec<_>>());
        columns[NAMES] = numbers(&vec![256; objects]);
        columns[LANGUAGES] = numbers(&(0..count as u64).map(|k| k % 256).collect::<Vec<_>>());
        with(POINTS, &section(objects as u64, &columns))
    };
    let shared_text = |objects: usize| {
        let mut columns = point();
        columns[TEXTS] = texts(&[&vec![b'x'; 1 << 20]]);
        columns[TEXT] = column(1, objects, 1);
        with(POINTS, &section(objects as u64, &columns))
    };
    let line_of = |points: usize| {
        let mut columns = line();
        columns[SHAPES] = numbers(&[points as u64 - 2]);
        columns[SHAPES + 1] = column(1, points, 2);
        columns[SHAPES + 2] = column(0, points, 0);
        with(LINES, &section(1, &columns))
    };
    let rings = |count: u64| {
        let mut columns = area();
        columns[SHAPES + 1] = numbers(&[count - 1]);
        columns[SHAPES + 2] = vec![0];
        with(AREAS, &section(1, &columns))
    };
    let mut many_texts = point();
    many_texts[TEXTS].clear();
    put_varint(&mut many_texts[TEXTS], MAX_LAYER_TEXTS as u64 + 1);
    // With 64 attributes, 2^15 objects have all values that a section may have.
    let wide = |objects: u64| {
        let columns = columns(&vec![vec![0]; 64 - (SHAPES - NUMBER) + 2]);
        let tile = payload(&[section_of(POINTS, &section(objects, &columns))]);
        let parts = with_layers(|layers| {
            let attributes = (0..64).map(|n| (format!("key{n}"), json!("text")));
            layers[2]["table"]["attributes"] = Value::Object(attributes.collect());
        });
        PackageParts { metadata: parts.metadata, ..PackageParts::of_tiles(&[tile]) }.assemble()
    };
    vec![
        read("a quarter of a million points", 96, with(POINTS, &points(MAX_LAYER_OBJECTS))),
        refused("a point too many", with(POINTS, &points(MAX_LAYER_OBJECTS + 1)), "of objects"),
        read("a million names", 128, named(MAX_LAYER_NAMES)),
        limited(16, refused("names too many", named(MAX_LAYER_NAMES + 256), "number of names: ")),
        read("64 MiB of texts", 72, shared_text(64)),
        limited(72, refused("a text too many", shared_text(65), "bytes of all texts: ")),
        refused("a million texts", with(POINTS, &section(1, &many_texts)), "number of texts"),
        read("four million points of a line", 128, line_of(MAX_POINTS)),
        limited(16, refused("a line too long", line_of(MAX_POINTS + 1), "number of points: ")),
        refused("many rings, few bits", rings(MAX_RINGS as u64), "section of layer \"area\""),
        refused("a ring too many", rings(MAX_RINGS as u64 + 1), "number of rings: "),
        read("two million values that are absent", 128, wide(1 << 15)),
        refused("two million and 64 values", wide((1 << 15) + 1), "number of attribute values: "),
    ]
}

fn manifests() -> Vec<Case> {
    let layers = |name, change: fn(&mut Vec<Value>), reason| {
        refused(name, with_layers(change).assemble(), reason)
    };
    vec![
        layers(
            "a table of 257 classes",
            |layers| {
                let class = |n| json!({ "id": format!("c{n}"), "tags": { "a": true } });
                layers[0]["table"]["class"] = (0..257).map(class).collect();
            },
            "layer \"line\": class: a layer has 1 to 256 classes, got 257",
        ),
        layers(
            "a table of no classes",
            |layers| layers[0]["table"]["class"] = json!([]),
            "a layer has 1 to 256 classes, got 0",
        ),
        layers(
            "a class without tags",
            |layers| layers[1]["table"]["class"] = json!([{ "id": "one" }]),
            "layer \"area\": class[0].tags: the class has no tags",
        ),
        layers(
            "a name that commands",
            |layers| layers[0]["table"]["id"] = json!("\u{1b}[2J"),
            "is not an id",
        ),
        layers(
            "a key that runs backwards",
            |layers| layers[0]["table"]["attributes"] = json!({ "\u{202e}eman": "text" }),
            "is not accepted as a key",
        ),
        layers(
            "a key that no table has",
            |layers| layers[0]["table"]["color"] = json!("red"),
            "unknown field `color`",
        ),
        layers(
            "a geometry that is none",
            |layers| layers[0]["table"]["geometry"] = json!("volume"),
            "unknown variant `volume`",
        ),
        layers(
            "two layers of one name",
            |layers| layers[1]["table"]["id"] = json!("line"),
            "two layers are called \"line\"",
        ),
        layers(
            "a layer below one that it covers",
            |layers| layers[0]["table"]["above"] = json!(["point"]),
            "the order of layers is [1, 2, 0]",
        ),
        layers(
            "layers in a circle",
            |layers| {
                layers[0]["table"]["above"] = json!(["point"]);
                layers[2]["table"]["above"] = json!(["line"]);
            },
            "form a cycle: line above point above line",
        ),
        layers(
            "65 layers",
            |layers| {
                let layer = layers[0].clone();
                layers.extend((3..65).map(|n| {
                    let mut layer = layer.clone();
                    layer["table"]["id"] = json!(format!("layer-{n}"));
                    layer
                }));
            },
            "at most 64 layers, got 65",
        ),
        layers(
            "objects of a class beyond the table",
            |layers| layers[0]["counts"]["kept"] = json!([{ "class": 1, "objects": 1 }]),
            "layer \"line\".counts.kept.class is [1]",
        ),
        layers(
            "objects of class 256",
            |layers| layers[0]["counts"]["kept"] = json!([{ "class": 256, "objects": 1 }]),
            "damaged",
        ),
        layers(
            "objects that overflow",
            |layers| {
                layers[0]["counts"]["kept"] = json!([{ "class": 0, "objects": u64::MAX }]);
                layers[0]["counts"]["lost"] = json!([["reason", 1]]);
            },
            "the counts of layer \"line\".counts add up",
        ),
        layers(
            "lengths of 2^64 - 1",
            |layers| {
                let kept = json!([{ "class": 0, "objects": 1, "length_um": u64::MAX }]);
                layers[0]["counts"]["kept"] = kept;
            },
            "the counts of layer \"line\": counts.kept.length_um add up",
        ),
        layers(
            "an area of 1e308",
            |layers| {
                let kept = json!([{ "class": 0, "objects": 1, "area_km2": 1e308 }]);
                layers[1]["counts"]["kept"] = kept;
            },
            "layer \"area\": counts.kept.area_km2 is 1e308",
        ),
        layers(
            "values that overflow",
            |layers| {
                let values = json!([["name", u64::MAX], ["ele", u64::MAX]]);
                layers[2]["counts"]["unread_values"] = values;
            },
            "the counts of layer \"point\": counts.unread_values add up",
        ),
        layers(
            "bytes that overflow",
            |layers| {
                let level = |level: u8| json!({ "level": level, "tiles": 1, "parts": 1, "points": 1, "bytes": u64::MAX });
                layers[2]["levels"] = json!([level(0), level(1)]);
            },
            "the counts of layer \"point\".levels add up",
        ),
        layers(
            "objects of a level that is not",
            |layers| {
                let level = json!({ "level": 3, "tiles": 1, "parts": 1, "points": 1, "bytes": 1 });
                layers[2]["levels"] = json!([level]);
            },
            "layer \"point\".levels.level is [3]",
        ),
    ]
}
