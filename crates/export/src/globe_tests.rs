//! Earth-centred positions agree with the published example.

use super::{RootFrame, cross, dot, geocentric_m};

/// IOGP 2019, *Guidance Note 7-2*, section 4.1.1: the example, a point of the North Sea.
#[test]
fn positions_are_those_of_the_guidance_note() {
    let [lon, lat] = [2.0 + 7.0 / 60.0 + 46.380 / 3600.0, 53.0 + 48.0 / 60.0 + 33.820 / 3600.0];
    let at = geocentric_m([lon, lat, 73.0]);
    for (own, expected) in at.into_iter().zip([3_771_793.968, 140_253.342, 5_124_304.349]) {
        assert!((own - expected).abs() < 0.001, "{at:?}");
    }
}

#[test]
fn the_frame_leads_back_to_the_earth() {
    let frame = RootFrame::at([9.5, 47.1]);
    let place = [9.6, 47.0, 1234.5];
    let own = frame.position_in_root(place);
    let m = frame.to_earth();
    let back = [0, 1, 2]
        .map(|row| m[row] * own[0] + m[4 + row] * own[1] + m[8 + row] * own[2] + m[12 + row]);
    for (back, expected) in back.into_iter().zip(geocentric_m(place)) {
        assert!((back - expected).abs() < 1e-8);
    }
    // To the south-east, and below the plane by the square of the distance.
    assert!(own[0] > 7000.0 && own[1] < -11_000.0);
    let sag = own[0].hypot(own[1]).powi(2) / (2.0 * 6_371_000.0);
    assert!((own[2] - (1234.5 - sag)).abs() < 2.0, "{own:?}");
    let up = frame.up_at([9.5, 47.1]);
    assert!((up[2] - 1.0).abs() < 1e-12 && dot(up, cross([1.0, 0.0, 0.0], up)).abs() < 1e-12);
}
