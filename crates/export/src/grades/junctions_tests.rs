//! Heights of junctions of small stars, whose legs are known.

use corniche_work::Silent;

use super::*;

/// Legs that leave one node, each with heights every ten metres and a direction; other ends are
/// dead ends.
struct Star {
    legs: Vec<(Vec<f32>, [f64; 2])>,
}

impl Legs for Star {
    fn by_node(&self) -> IndexLists {
        let node =
            |end: usize| Some(if end.is_multiple_of(2) { 0 } else { 1 + end / 2 }).into_iter();
        IndexLists::new(1 + self.legs.len(), 2 * self.legs.len(), node)
    }

    fn is_alone(&self, node: usize) -> bool {
        node > 0
    }

    fn smoothing(&self) -> Smoothing {
        Smoothing { length_m: 200.0 }
    }

    fn leg(&self, Leg { chain, is_last }: Leg) -> (f64, Box<dyn Iterator<Item = f32> + '_>) {
        let heights_m = &self.legs[chain].0;
        if is_last {
            (10.0, Box::new(heights_m.iter().rev().copied()))
        } else {
            (10.0, Box::new(heights_m.iter().copied()))
        }
    }

    fn direction(&self, Leg { chain, is_last }: Leg) -> [f64; 2] {
        let direction = self.legs[chain].1;
        if is_last { direction.map(|part| -part) } else { direction }
    }
}

fn rising(from: f32, by: f32) -> Vec<f32> {
    (0..30).map(|k| from + by * k as f32).collect()
}

fn junction(legs: Vec<(Vec<f32>, [f64; 2])>) -> f64 {
    let heights = node_heights(&Star { legs }, &Silent).unwrap();
    assert!(heights[1..].iter().all(|height_m| height_m.is_nan()), "{heights:?}");
    heights[0]
}

/// Where all legs are straight and meet, the junction has the height at which they meet.
#[test]
fn straight_legs_meet_where_they_meet() {
    let legs = vec![
        (rising(700.0, 0.8), [1.0, 0.0]),
        (rising(700.0, -0.8), [-1.0, 0.0]),
        (rising(700.0, 2.0), [0.0, 1.0]),
    ];
    assert!((junction(legs) - 700.0).abs() < 1e-6);
}

/// One wrong height at the junction moves it only a little: less where a line passes through than
/// where it ends.
#[test]
fn noise_at_the_junction_is_smoothed_over_its_legs() {
    let noisy = |by: f32| {
        let mut leg = rising(700.0, by);
        leg[0] += 8.0;
        leg
    };
    let through = junction(vec![(noisy(0.8), [1.0, 0.0]), (noisy(-0.8), [-1.0, 0.0])]) - 700.0;
    let ends = junction(vec![(noisy(0.8), [1.0, 0.0]), (noisy(-0.8), [0.0, 1.0])]) - 700.0;
    assert!(through > 0.0 && through < 1.0, "{through}");
    assert!(ends > 1.5 * through && ends < 4.0, "{ends} {through}");
}

#[test]
fn a_junction_without_ground_has_no_height() {
    let legs = vec![(vec![f32::NAN, 5.0], [1.0, 0.0]), (vec![f32::NAN; 3], [0.0, 1.0])];
    assert!(junction(legs).is_nan());
}
