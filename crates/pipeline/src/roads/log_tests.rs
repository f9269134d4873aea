use super::*;
use crate::MemoryStorage;

fn road(way_id: i64) -> Road {
    let points =
        vec![LatticePoint::new(-5, 1 << 40), LatticePoint::new(7, 0), LatticePoint::new(8, -1)];
    Road {
        way_id,
        class: FunctionalRoadClass::new(4).unwrap(),
        attributes: RoadAttributes {
            form: Form::Roundabout,
            structure: Structure::Tunnel,
            layer: -2,
            oneway: Oneway::Backward,
            name: "Rätikonstraße".into(),
            reference: String::new(),
            surface: "asphalt".into(),
        },
        line: Polyline::new(points).unwrap(),
        fixed: vec![0, 2],
    }
}

#[test]
fn roads_come_back_as_they_were() {
    let storage = MemoryStorage::default();
    let mut log = RoadLog::new(&storage);
    for way_id in [-3, 5, i64::MAX] {
        log.push(&road(way_id)).unwrap();
    }
    assert_eq!(log.load(1).unwrap(), road(5));
    assert!(log.load(3).is_err());
    let bytes = to_bytes(&road(1));
    assert!((0..bytes.len()).all(|cut| from_bytes(&bytes[..cut]).is_none()));
}

#[test]
fn every_attribute_comes_back() {
    for &form in Form::ALL {
        for &structure in Structure::ALL {
            for &oneway in Oneway::ALL {
                let mut road = road(1);
                road.attributes = RoadAttributes { form, structure, oneway, ..road.attributes };
                assert_eq!(from_bytes(&to_bytes(&road)), Some(road));
            }
        }
    }
}
