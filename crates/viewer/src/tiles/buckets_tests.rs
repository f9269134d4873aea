use corniche_geom::barycentric;
use proptest::prelude::*;

use super::*;

/// A fan around a point: slivers and large triangles alike.
fn fan(center: [f32; 2], rim: usize) -> (Vec<GroundVertex>, Vec<u32>) {
    let vertex = |x: f32, y: f32| GroundVertex {
        position_in_tile: [x, y, x + y],
        normal_skirt: [0, 0, 127, 0],
    };
    let mut vertices = vec![vertex(center[0], center[1])];
    // Around a square of 200 m.
    vertices.extend((0..rim).map(|k| {
        let along = k as f32 / rim as f32 * 4.0;
        let (side, share) = (along as u32, along.fract() * 200.0 - 100.0);
        match side {
            0 => vertex(share, -100.0),
            1 => vertex(100.0, share),
            2 => vertex(-share, 100.0),
            _ => vertex(-100.0, -share),
        }
    }));
    let last = rim as u32;
    let triangles = (1..=last).flat_map(|k| [0, k, if k == last { 1 } else { k + 1 }]).collect();
    (vertices, triangles)
}

fn holds(vertices: &[GroundVertex], corners: &[u32], at: [f64; 2]) -> bool {
    let corner = |k: usize| {
        let [x, y, _] = vertices[corners[k] as usize].position_in_tile.map(f64::from);
        [x, y]
    };
    barycentric(at, corner(0), corner(1), corner(2)).iter().all(|weight| *weight >= -1e-6)
}

proptest! {
    /// Every triangle that holds a place is in the place's bucket, in the order of the surface, on borders of buckets and of
    /// the surface too.
    #[test]
    fn every_triangle_that_holds_a_place_is_found_there(
        center in prop::array::uniform2(-99.0..99.0_f32),
        rim in 4..300_usize,
        place in prop::array::uniform2(-101.0..101.0_f64),
        on_border in 0..3_u8,
    ) {
        let (vertices, surface) = fan(center, rim);
        let buckets = Buckets::new(&vertices, &surface);
        let bucket_m = 200.0 / SIDE as f64;
        let at = match on_border {
            0 => place,
            1 => place.map(|side| (side / bucket_m).round() * bucket_m),
            _ => [place[0], place[1].signum() * 100.0],
        };
        let expected: Vec<u32> = (0..)
            .zip(surface.chunks_exact(3))
            .filter(|(_, corners)| holds(&vertices, corners, at))
            .map(|(triangle, _)| triangle)
            .collect();
        let near = buckets.at(at);
        prop_assert!(near.is_sorted());
        for triangle in &expected {
            prop_assert!(near.contains(triangle), "{triangle} at {at:?}");
        }
        // On a level line they are found wherever it passes.
        for (from, to) in [([-150.0, at[1]], [150.0, at[1]]), ([at[0], 150.0], [at[0], -150.0])] {
            let met: Vec<u32> = buckets.along(from, to).flat_map(|(_, near)| near).collect();
            for triangle in &expected {
                prop_assert!(met.contains(triangle), "{triangle} from {from:?}");
            }
        }
    }
}

#[test]
fn a_bucket_holds_a_part_of_many_triangles_and_nothing_has_none() {
    let (vertices, surface) = fan([0.0, 0.0], 4000);
    let buckets = Buckets::new(&vertices, &surface);
    // Slivers all of them, that is the worst: those between the middle and one side of the rim.
    assert!(buckets.at([90.0, 5.0]).len() < 1200, "{}", buckets.at([90.0, 5.0]).len());
    let shares: Vec<f64> =
        buckets.along([150.0, 3.0], [-150.0, 4.0]).map(|(share, _)| share).collect();
    assert_eq!(shares.len(), SIDE);
    assert!(shares.is_sorted(), "{shares:?}");
    let none = Buckets::new(&[], &[]);
    assert!(none.at([0.0, 0.0]).is_empty() && none.along([0.0; 2], [1.0; 2]).next().is_none());
    assert_eq!(none, Buckets::default());
}
