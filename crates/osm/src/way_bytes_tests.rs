//! Ways are read from their bytes as they were written.

use proptest::prelude::*;

use std::num::{NonZeroU8, NonZeroU32};

use super::*;
use corniche_roads::{Form, Oneway, Structure};

fn take_all(bytes: &mut &[u8]) -> Option<(Vec<i64>, WayKind)> {
    let mut ids = Vec::new();
    let count = take_node_ids(bytes, |id| {
        ids.push(id);
        Ok(())
    });
    let count = count.ok()?;
    assert_eq!(count, ids.len() as u64);
    Some((ids, take_way(bytes)?))
}

proptest! {
    #[test]
    fn a_road_comes_back_from_its_bytes(
        near: Vec<i8>,
        far: Vec<i64>,
        class in 0..FunctionalRoadClass::COUNT as u8,
        form in prop::sample::select(&Form::ALL),
        structure in prop::sample::select(&Structure::ALL),
        oneway in prop::sample::select(&Oneway::ALL),
        layer: i8,
        texts in prop::array::uniform7(".{0,20}"),
        lanes: u8,
        width_mm: u32,
    ) {
        let ids: Vec<i64> = near.into_iter().map(i64::from).chain(far).collect();
        let class = FunctionalRoadClass::new(class).unwrap();
        let [name, reference, surface, highway, max_speed, sac_scale, tracktype] = texts;
        let (lanes, width_mm) = (NonZeroU8::new(lanes), NonZeroU32::new(width_mm));
        let attributes = RoadAttributes {
            form, structure, layer, oneway, name, reference, surface, highway, lanes, width_mm, max_speed, sac_scale, tracktype,
        };
        let bytes = way_bytes(&ids, class, &attributes);
        let mut rest = &*bytes;
        prop_assert_eq!(take_all(&mut rest), Some((ids, WayKind::Road(class, attributes))));
        prop_assert_eq!(rest, b"");
        for len in 0..bytes.len() {
            prop_assert_eq!(take_all(&mut &bytes[..len]), None);
        }
    }

    #[test]
    fn a_railway_comes_back_from_its_bytes(
        ids: Vec<i64>, kind in prop::sample::select(&Railway::ALL[..]),
        structure in prop::sample::select(&Structure::ALL), layer: i8,
    ) {
        let track = Track { kind, structure, layer };
        let bytes = railway_bytes(&ids, track);
        let mut after_nodes = &*bytes;
        take_node_ids(&mut after_nodes, |_| Ok(())).unwrap();
        prop_assert!(is_railway(after_nodes) && is_carrier(after_nodes));
        prop_assert!(!is_left_out(after_nodes));
        prop_assert_eq!(take_all(&mut &*bytes), Some((ids, WayKind::Railway(track))));
        for len in 0..bytes.len() {
            prop_assert_eq!(take_all(&mut &bytes[..len]), None);
        }
    }

    #[test]
    fn a_way_that_is_left_out_comes_back_from_its_bytes(
        ids: Vec<i64>, reason in prop::sample::select(&LeftOutReason::ALL[..]), highway in ".*",
        carrier in prop::option::of((prop::sample::select(&Structure::ALL), any::<i8>())),
        railway in prop::option::of(prop::sample::select(&Railway::ALL[..])),
    ) {
        let bytes = left_out_bytes(&ids, LeftOutWay { reason, highway: &highway, carrier, railway });
        let mut after_nodes = &*bytes;
        take_node_ids(&mut after_nodes, |_| Ok(())).unwrap();
        prop_assert!(is_left_out(after_nodes));
        prop_assert_eq!(is_carrier(after_nodes), carrier.is_some());
        let mut rest = &*bytes;
        prop_assert_eq!(take_all(&mut rest), Some((ids, WayKind::LeftOut(LeftOutWay { reason, highway, carrier, railway }))));
        prop_assert_eq!(rest, b"");
        for len in 0..bytes.len() {
            prop_assert_eq!(take_all(&mut &bytes[..len]), None);
        }
    }
}
