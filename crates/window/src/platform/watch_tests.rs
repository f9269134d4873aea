//! Images keep their aspect ratio and touch two sides of the window.

use super::*;

#[test]
fn pictures_keep_their_shape_and_touch_two_sides() {
    let check = |picture: [usize; 2], room: [f32; 2], [x0, y0, x1, y1]: [f32; 4]| {
        let room = Rect::from_min_max(pos2(0.0, 0.0), pos2(room[0], room[1]));
        assert_eq!(fitted(picture, room), Rect::from_min_max(pos2(x0, y0), pos2(x1, y1)));
    };
    check([400, 300], [400.0, 300.0], [0.0, 0.0, 400.0, 300.0]);
    check([400, 300], [800.0, 300.0], [200.0, 0.0, 600.0, 300.0]);
    check([400, 300], [400.0, 600.0], [0.0, 150.0, 400.0, 450.0]);
}
