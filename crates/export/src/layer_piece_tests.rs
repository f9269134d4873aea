//! A piece of an object of a layer can be decoded from its bytes unchanged, and lines of several
//! tiles have each stretch once.

use corniche_store::SortRecord;
use corniche_tileset::AreaPolygon;

use super::*;

fn at(u: i64, v: i64) -> LatticePoint {
    LatticePoint::new(u, v)
}

fn vertex(u: f64, z_m: f64) -> Vertex {
    Vertex { at: [u, 0.0], z_m, is_source: true }
}

fn piece(tile: u64, shape: LayerShape, laid: Vec<LaidStretch>) -> LayerPiece {
    let names = vec![(String::new(), "Gänglesee".to_owned()), ("de".to_owned(), "See".to_owned())];
    let values = vec![
        None,
        Some(AttributeValue::Names(names)),
        Some(AttributeValue::Number(-0.5)),
        Some(AttributeValue::YesNo(true)),
        Some(AttributeValue::Text("x".to_owned())),
    ];
    let of = LayerObject { class: 2, object: OsmObject::Way(-7), values, shape };
    LayerPiece { tile, part: 3, of, laid }
}

#[test]
fn a_piece_comes_back_as_it_was_and_never_from_less() {
    let line = LayerShape::Line(vec![at(0, 0), at(1 << 40, -3), at(5, 5)]);
    let stretch = LaidStretch {
        segment: [at(1 << 40, -3), at(5, 5)],
        vertices: vec![vertex(0.5, 9.25), vertex(7.0, -1.0)],
    };
    let ring = vec![at(1, 1), at(2, 1), at(2, 2), at(1, 2)];
    let polygon = AreaPolygon { rings: vec![ring.clone(), ring] };
    for (object, shape, laid) in [
        (OsmObject::Way(-7), line, vec![stretch]),
        (OsmObject::Relation(i64::MAX), LayerShape::Area(vec![polygon]), Vec::new()),
        (OsmObject::Node(1), LayerShape::Point(at(-1, 1)), Vec::new()),
    ] {
        let mut piece = piece(1 << 40, shape, laid);
        piece.of.object = object;
        let mut bytes = Vec::new();
        SortRecord::encode(&piece, &mut bytes);
        assert_eq!(LayerPiece::decode(&mut bytes.as_slice()), Some(piece));
        for length in 0..bytes.len() {
            assert_eq!(LayerPiece::decode(&mut &bytes[..length]), None, "{length}");
        }
    }
}

/// The tiles meet at 10. Both have the segment from 5 to 20 whole, each its own stretch of it, and
/// both have all of the segment from 20 to 30, which is on their border; one of them has ground
/// only up to 26.
#[test]
fn stretches_of_several_tiles_are_joined_once_and_gaps_stay() {
    let laid = |from, to, places: &[f64]| {
        let vertices = places.iter().map(|&place| vertex(place, place)).collect();
        LaidStretch { segment: [at(from, 0), at(to, 0)], vertices }
    };
    let line = |points: &[i64]| LayerShape::Line(points.iter().map(|&u| at(u, 0)).collect());
    let west = piece(
        1,
        line(&[0, 5, 20, 30, 40]),
        vec![laid(0, 5, &[1.0, 3.0, 5.0]), laid(5, 20, &[5.0, 10.0]), laid(20, 30, &[20.0, 26.0])],
    );
    let east = piece(
        2,
        line(&[5, 20, 30, 40, 50]),
        vec![
            laid(5, 20, &[12.0, 20.0]),
            laid(5, 20, &[10.0, 11.0]),
            laid(20, 30, &[20.0, 25.0, 30.0]),
            laid(30, 40, &[30.0, 40.0]),
        ],
    );
    let expected: [&[f64]; 2] = [&[1.0, 3.0, 5.0, 10.0, 11.0], &[12.0, 20.0, 25.0, 30.0, 40.0]];
    for pieces in [[west.clone(), east.clone()], [east, west]] {
        let places = |line: &Vec<Vertex>| line.iter().map(|one| one.at[0]).collect::<Vec<f64>>();
        let found: Vec<Vec<f64>> = lines_of(&pieces).iter().map(places).collect();
        assert_eq!(found, expected);
    }
}

#[test]
fn pieces_of_an_object_agree() {
    let shape = LayerShape::Point(at(0, 0));
    let one = piece(1, shape.clone(), Vec::new());
    let same = piece(2, shape, Vec::new());
    assert!(check_same(&[one.clone(), same.clone()]).is_ok());
    let mut other = same.clone();
    other.of.class = 1;
    assert!(check_same(&[one.clone(), other]).is_err());
    let mut other = same;
    other.of.values[0] = Some(AttributeValue::YesNo(false));
    let error = check_same(&[one, other]).unwrap_err();
    assert!(error.to_string().contains("way -7"), "{error}");
}
