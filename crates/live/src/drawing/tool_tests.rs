//! Clicks and drags of the drawing tool change the right lines.

#![expect(clippy::unnecessary_wraps, reason = "as the tool asks for them")]

use super::*;

/// The screen shows working metres without a change of scale.
fn seen_at(point: &DrawnPoint) -> Option<DVec2> {
    Some(DVec2::from_array(point.at_m))
}

fn under(at: DVec2) -> Option<DrawnPoint> {
    Some(DrawnPoint { lon_lat_deg: [at.x / 1e3, at.y / 1e3], at_m: at.to_array() })
}

struct Hand {
    tool: Tool,
    document: Document,
}

impl Hand {
    fn new() -> Self {
        Self { tool: Tool::default(), document: Document::default() }
    }

    fn click(&mut self, x: f64, y: f64, is_shift: bool) {
        let at = DVec2::new(x, y);
        self.tool.press(at, &self.document, seen_at);
        self.tool.release(is_shift, &mut self.document, under, seen_at);
    }

    fn drag(&mut self, from: [f64; 2], over: &[[f64; 2]]) -> bool {
        let is_taken = self.tool.press(DVec2::from_array(from), &self.document, seen_at);
        for at in over {
            let at = DVec2::from_array(*at);
            self.tool.move_to(at, &mut self.document, || under(at));
        }
        self.tool.release(false, &mut self.document, under, seen_at);
        is_taken
    }

    fn lines(&self) -> Vec<Vec<[f64; 2]>> {
        let lines = self.document.lines.iter();
        lines.map(|line| line.points.iter().map(|point| point.at_m).collect()).collect()
    }
}

#[test]
fn clicks_make_a_line_until_it_is_ended() {
    let mut hand = Hand::new();
    for x in [0.0, 100.0, 200.0] {
        hand.click(x, 50.0, false);
    }
    hand.tool.end_line();
    hand.click(300.0, 90.0, false);
    assert_eq!(
        hand.lines(),
        [vec![[0.0, 50.0], [100.0, 50.0], [200.0, 50.0]], vec![[300.0, 90.0]]]
    );
}

#[test]
fn a_point_is_dragged_and_the_map_is_not() {
    let mut hand = Hand::new();
    hand.click(0.0, 0.0, false);
    hand.click(100.0, 0.0, false);
    assert!(hand.drag([103.0, 2.0], &[[110.0, 20.0], [120.0, 40.0]]));
    assert_eq!(hand.lines(), [[[0.0, 0.0], [120.0, 40.0]]]);
    assert!(!hand.drag([50.0, 90.0], &[[60.0, 120.0]]), "the map is dragged");
    assert_eq!(hand.lines()[0].len(), 2, "and no point is added");
    hand.document.undo();
    assert_eq!(hand.lines(), [[[0.0, 0.0], [100.0, 0.0]]]);
}

#[test]
fn a_click_on_a_point_picks_it_and_the_line_goes_on_from_that_end() {
    let mut hand = Hand::new();
    hand.click(0.0, 0.0, false);
    hand.click(100.0, 0.0, false);
    hand.click(2.0, 3.0, false);
    assert_eq!(hand.tool.picked(&hand.document).map(|picked| picked.place), Some(0));
    hand.click(-80.0, 0.0, false);
    hand.click(-160.0, 0.0, false);
    let along: Vec<f64> = hand.lines()[0].iter().map(|at| at[0]).collect();
    assert_eq!(along, [-160.0, -80.0, 0.0, 100.0]);
}

#[test]
fn with_shift_a_point_comes_into_the_nearest_segment() {
    let mut hand = Hand::new();
    for x in [0.0, 100.0, 200.0] {
        hand.click(x, 0.0, false);
    }
    hand.click(40.0, 15.0, true);
    assert_eq!(hand.lines(), [[[0.0, 0.0], [40.0, 15.0], [100.0, 0.0], [200.0, 0.0]]]);
}

#[test]
fn the_picked_point_and_line_are_removed() {
    let mut hand = Hand::new();
    hand.click(0.0, 0.0, false);
    hand.click(100.0, 0.0, false);
    hand.click(200.0, 0.0, false);
    assert!(hand.tool.remove_point(&mut hand.document));
    assert!(hand.tool.remove_point(&mut hand.document));
    assert_eq!(hand.lines(), [[[0.0, 0.0]]]);
    assert!(hand.tool.remove_line(&mut hand.document));
    assert!(!hand.tool.remove_point(&mut hand.document), "nothing is picked any more");
    assert!(hand.lines().is_empty());
}

/// Over the sky there is nothing to move to; the drag begins when the cursor reaches ground again.
#[test]
fn a_drag_that_begins_over_the_sky_is_a_change_of_its_own() {
    let mut hand = Hand::new();
    hand.click(0.0, 0.0, false);
    hand.click(100.0, 0.0, false);
    hand.tool.press(DVec2::new(100.0, 0.0), &hand.document, seen_at);
    let sky = DVec2::new(100.0, -90.0);
    assert!(!hand.tool.move_to(sky, &mut hand.document, || None));
    let ground = DVec2::new(120.0, 40.0);
    assert!(hand.tool.move_to(ground, &mut hand.document, || under(ground)));
    hand.document.undo();
    assert_eq!(hand.lines(), [[[0.0, 0.0], [100.0, 0.0]]]);
}
