use super::*;

#[test]
fn flights_that_show_less_than_they_seem_to_say_so() {
    let run = |frames| Run { lod: Lod::Adaptive, roads: Roads::Geo, frames };
    let whole = FrameRecord { triangles: 10, tiles_missing: 0, ..frame(1.0) };
    let coarse = FrameRecord { tiles_missing: 3, ..whole };
    let empty = FrameRecord { triangles: 0, ..whole };
    assert_eq!(run(vec![whole, empty]).doubt(), None);
    assert!(run(vec![empty, empty]).doubt().unwrap().contains("no frame shows any ground"));
    assert!(run(vec![whole, coarse]).doubt().unwrap().contains("1 of 2 frames"));
}

#[test]
fn what_is_given_twice_is_flown_once() {
    assert_eq!(once_each(&[Roads::Sv, Roads::Geo, Roads::Sv]), [Roads::Sv, Roads::Geo]);
    assert!(once_each::<Roads>(&[]).is_empty());
}
