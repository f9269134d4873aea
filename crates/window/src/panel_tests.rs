//! No text of the window is cut off or hidden, however small the window is.

use corniche_live::{
    Compare, DrawingContent, FrameTimes, GroundPoint, Notice, Shot, controls::Mode,
};
use corniche_roads::FunctionalRoadClass;
use corniche_styles::{AreaStyle, LayerLook, LineStyle, PointStyle};
use corniche_viewer::{
    LayerLegend, LayerRow, RoadMethod, RoadOptions,
    camera::Orientation,
    flight::{Pose, WorkingCrs},
    gpu::PassTimes,
};
use egui::{Event, PointerButton, RawInput, Shape, TextureId, vec2};

use super::*;
#[path = "panel/golden_tests.rs"]
mod golden;

fn usual() -> MapSettings {
    MapSettings::usual(RoadOptions::for_method(RoadMethod::ShadowVolumes))
}

/// All possible content, with long texts.
struct Told {
    times: FrameTimes,
    attribution: Vec<String>,
    styles: Vec<String>,
    notices: Vec<Notice>,
    passes: Vec<(RoadMethod, PassTimes)>,
    class_labels: [String; FunctionalRoadClass::COUNT],
    layers: Vec<LayerLegend>,
}

impl Told {
    fn new() -> Self {
        let mut times = FrameTimes::default();
        (0..100).for_each(|k| times.push(10.0 + f64::from(k % 7)));
        let pass = PassTimes {
            terrain_ms: 1111.25,
            roads_ms: 3370.5,
            composite_ms: 99.75,
            ..PassTimes::default()
        };
        Self {
            times,
            attribution: vec![
                "© OpenStreetMap contributors, ODbL 1.0".into(),
                "© swisstopo".into(),
            ],
            styles: vec!["road-atlas".into(), "dark".into()],
            notices: vec![
                Notice { words: "saved somewhere/corniche-001.png".into(), until_s: Some(1.0) },
                Notice { words: "a long notice ".repeat(12), until_s: None },
            ],
            passes: vec![(RoadMethod::Geometry, pass), (RoadMethod::ShadowVolumes, pass)],
            layers: Vec::new(),
            class_labels: std::array::from_fn(|class| {
                format!("unclassified, living street {class}")
            }),
        }
    }

    fn content(&self) -> WindowContent<'_> {
        let orientation = Orientation { heading_deg: 123.0, pitch_deg: 55.0 };
        WindowContent {
            adapter: "llvmpipe (LLVM 15.0.6, 256 bits) (vulkan)",
            is_software: true,
            attribution: &self.attribution,
            crs: WorkingCrs { crs: "EPSG:32632", metres_per_unit: [1.0, 1.0] },
            cursor: Some(GroundPoint {
                lon_lat_deg: [9.521_23, 47.140_12],
                at_m: [539_512.25, 5_221_456.75, 1455.5],
            }),
            pose: Pose { eye_m: [539_000.0, 5_220_000.0, 2830.0], orientation },
            metres_per_point: Some(3.7),
            mode: Mode::Map,
            style_names: &self.styles,
            photo: None,
            overlays: &[],
            drawing: DrawingContent::default(),
            overlay_colors: Vec::new(),
            layers: self.layers.clone(),
            road_colors: &[[0.8, 0.2, 0.1]; 9],
            class_labels: &self.class_labels,
            tiles_drawn: 123,
            tiles_missing: 45,
            tiles_loading: 8,
            is_full: false,
            triangles: 1_234_567,
            segments: 234_567,
            gpu_bytes: [300 << 20, 512 << 20],
            passes: &self.passes,
            frame_times: &self.times,
            recording_s: Some(12.0),
            notices: &self.notices,
        }
    }
}

/// Lays out a window of a size in points, with the events of each pass; the last pass counts.
fn lay_out(
    size: [f32; 2],
    settings: &mut MapSettings,
    content: &WindowContent<'_>,
    passes: &[&[Event]],
) -> (Vec<(String, Rect, Rect)>, PanelActions) {
    let ctx = egui::Context::default();
    set_up(&ctx);
    let mut texts = Vec::new();
    let mut answer = PanelActions::default();
    for events in passes {
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(egui::Pos2::ZERO, size.into())),
            events: events.to_vec(),
            ..RawInput::default()
        };
        let mut commands = Vec::new();
        let mut output = ctx.run_ui(input, |ui| {
            answer = show(ui, settings, content, &[TextureId::User(0)]);
            commands.append(&mut answer.commands);
        });
        answer.commands = commands;
        output.textures_delta.clear();
        texts.clear();
        for clipped in &output.shapes {
            gather(&clipped.shape, clipped.clip_rect, &mut texts);
        }
    }
    (texts, answer)
}

fn gather(shape: &Shape, clip: Rect, texts: &mut Vec<(String, Rect, Rect)>) {
    match shape {
        Shape::Vec(shapes) => shapes.iter().for_each(|shape| gather(shape, clip, texts)),
        Shape::Text(text) if !text.galley.text().trim().is_empty() => {
            // The rectangle of the letters themselves: a line that begins inside another one has
            // its space from the left edge on.
            let place = text.galley.mesh_bounds.translate(text.pos.to_vec2());
            texts.push((text.galley.text().to_owned(), place, clip));
        }
        _ => {}
    }
}

/// All states of the panel that look different.
fn states() -> Vec<(&'static str, MapSettings)> {
    let usual = usual();
    let mut none = usual.clone();
    none.roads.method = RoadMethod::None;
    vec![
        ("usual", usual.clone()),
        ("no roads", none),
        ("split", MapSettings { compare: Compare::Split, ..usual.clone() }),
        ("difference", MapSettings { compare: Compare::Difference, ..usual.clone() }),
        ("hidden", MapSettings { is_panel_open: false, ..usual.clone() }),
        ("help", MapSettings { is_panel_open: false, is_help_open: true, ..usual }),
    ]
}

#[test]
fn no_text_is_cut_off_or_lies_on_another() {
    let told = Told::new();
    for (name, mut settings) in states() {
        let (texts, _) = lay_out([1280.0, 1000.0], &mut settings, &told.content(), &[&[], &[]]);
        assert!(texts.len() > 10, "{name}: {texts:?}");
        for (place, (words, rect, clip)) in texts.iter().enumerate() {
            assert!(clip.expand(1.0).contains_rect(*rect), "{name}: {words:?} is cut off");
            for (other, beneath, _) in &texts[..place] {
                let overlap = rect.shrink(1.0).intersect(beneath.shrink(1.0));
                assert!(!overlap.is_positive(), "{name}: {words:?} lies on {other:?}");
            }
        }
    }
}

#[test]
fn the_panel_is_as_wide_as_it_says_with_everything_open() {
    let told = Told::new();
    let size = [1280.0, 1600.0];
    let (texts, _) = lay_out(size, &mut usual(), &told.content(), &[&[], &[]]);
    let (_, header, _) = texts.iter().find(|(text, ..)| text == "Advanced").unwrap();
    let [over, press, release] = click(header.center());
    let passes: [&[Event]; 6] = [&[], &over, &press, &release, &[], &[]];
    let (texts, answer) = lay_out(size, &mut usual(), &told.content(), &passes);
    let left = 1280.0 - WIDTH;
    assert!(texts.iter().any(|(text, ..)| text == "Wireframe"), "what few people need is shown");
    // Text is laid out to fractions of a point.
    let is_panel = |rect: &&Rect| rect.top() == 0.0 && (rect.left() - left).abs() < 1.0;
    assert!(answer.occupied.iter().any(|rect| is_panel(&rect)), "{:?}", answer.occupied);
    for (words, rect, clip) in &texts {
        assert!(clip.expand(1.0).contains_rect(*rect), "{words:?} is cut off");
        // The status line is as wide as the window.
        let is_below = rect.top() >= answer.occupied[0].top();
        let is_beside = rect.right() <= left || rect.left() >= left;
        assert!(is_below || is_beside, "{words:?} lies across the edge");
    }
}

#[test]
fn credits_are_in_every_window_however_small() {
    let told = Told::new();
    for (name, mut settings) in states() {
        for size in [[1280.0, 800.0], [640.0, 480.0], [400.0, 300.0]] {
            let (texts, _) = lay_out(size, &mut settings, &told.content(), &[&[], &[]]);
            let credits = texts.iter().find(|(words, ..)| words.contains("© OpenStreetMap"));
            let (_, rect, clip) = credits.unwrap_or_else(|| panic!("{name} {size:?}: {texts:?}"));
            let window = Rect::from_min_size(egui::Pos2::ZERO, size.into());
            assert!(clip.intersect(window).contains_rect(*rect), "{name} {size:?}: {rect:?}");
            let free = size[0] - if settings.is_panel_open { width(size[0]) } else { 0.0 };
            assert!(rect.right() <= free, "{name} {size:?}: the panel hides {rect:?}");
        }
    }
}

#[test]
fn in_small_windows_nothing_on_the_map_lies_on_anything_else() {
    let mut told = Told::new();
    told.attribution.pop();
    for (name, mut settings) in states() {
        for size in [
            [640.0, 480.0],
            [480.0, 640.0],
            [500.0, 400.0],
            [450.0, 300.0],
            [300.0, 200.0],
            [230.0, 160.0],
        ] {
            let (texts, answer) = lay_out(size, &mut settings, &told.content(), &[&[], &[]]);
            let seen: Vec<(&str, Rect)> = texts
                .iter()
                .map(|(words, rect, clip)| (&words[..], rect.intersect(*clip)))
                .filter(|(_, rect)| rect.is_positive())
                .collect();
            for (place, (words, rect)) in seen.iter().enumerate() {
                for (other, beneath) in &seen[..place] {
                    let overlap = rect.shrink(1.0).intersect(beneath.shrink(1.0));
                    assert!(!overlap.is_positive(), "{name} {size:?}: {words:?} on {other:?}");
                }
            }
            let status = answer.occupied[0];
            let free = size[0] - if settings.is_panel_open { width(size[0]) } else { 0.0 };
            for (words, rect, clip) in &texts {
                if words.starts_with("© OpenStreetMap") || words.ends_with(" in the middle") {
                    assert!(clip.contains_rect(*rect), "{name} {size:?}: {words:?} is cut off");
                    assert!(rect.bottom() <= status.top() && rect.right() <= free, "{words:?}");
                }
            }
        }
    }
}

#[test]
fn a_window_too_narrow_for_the_panel_says_so() {
    let told = Told::new();
    let has = |size, words: &str| {
        let (texts, _) = lay_out(size, &mut usual(), &told.content(), &[&[], &[]]);
        texts.iter().any(|(text, ..)| text == words)
    };
    let words = "a wider window shows the panel";
    assert!(has([400.0, 300.0], words) && !has([400.0, 300.0], "Corniche"));
    assert!(!has([460.0, 300.0], words) && has([460.0, 300.0], "Corniche"));
}

#[test]
fn the_panel_pushes_the_divider_aside() {
    let told = Told::new();
    let mut settings = MapSettings { compare: Compare::Split, divider_share: 0.9, ..usual() };
    lay_out([1000.0, 700.0], &mut settings, &told.content(), &[&[]]);
    assert!((settings.divider_share - (700.0 - 24.0) / 1000.0).abs() < 1e-3);
    settings = MapSettings { divider_share: 0.9, is_panel_open: false, ..settings };
    lay_out([1000.0, 700.0], &mut settings, &told.content(), &[&[]]);
    assert!((settings.divider_share - 0.9).abs() < 1e-3);
}

#[test]
fn a_notice_of_several_lines_keeps_its_columns() {
    let mut told = Told::new();
    told.notices = vec![Notice { words: "1 | wide = x\n  |        ^".into(), until_s: None }];
    let (texts, _) = lay_out([1000.0, 700.0], &mut usual(), &told.content(), &[&[]]);
    assert!(texts.iter().any(|(words, ..)| words.starts_with("1 | wide")), "{texts:?}");
}

#[test]
fn a_tilted_scale_says_where_it_holds() {
    let told = Told::new();
    let has = |content: &WindowContent<'_>, words: &str| {
        let (texts, _) = lay_out([1000.0, 700.0], &mut usual(), content, &[&[]]);
        texts.iter().any(|(text, ..)| text == words)
    };
    let mut content = told.content();
    assert!(has(&content, "500 m in the middle"));
    content.pose.orientation.pitch_deg = 0.0;
    assert!(has(&content, "500 m"));
    content.metres_per_point = None;
    assert!(!has(&content, "500 m"));
}

fn click(at: egui::Pos2) -> [Vec<Event>; 3] {
    let button = |pressed| Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed,
        modifiers: egui::Modifiers::NONE,
    };
    [vec![Event::PointerMoved(at)], vec![button(true)], vec![button(false)]]
}

#[test]
fn a_click_on_the_compass_turns_north_up() {
    let told = Told::new();
    let mut settings = MapSettings { is_panel_open: false, ..usual() };
    let [over, press, release] = click(pos2(1000.0 - 34.0, 34.0));
    let (_, answer) =
        lay_out([1000.0, 700.0], &mut settings, &told.content(), &[&over, &press, &release]);
    assert_eq!(answer.commands, [MapCommand::NorthUp]);
}

#[test]
fn buttons_ask_for_what_they_say() {
    let told = Told::new();
    let size = [1280.0, 1000.0];
    for (words, command) in [
        ("Map (P)", MapCommand::Take(Shot::Map)),
        ("Stop and save", MapCommand::StopRecording),
        ("Fly (F)", MapCommand::ToggleFly),
        ("Go to", MapCommand::GoTo),
        ("Copy this view (V)", MapCommand::CopyView),
        ("Help (?)", MapCommand::ToggleHelp),
        ("Hide (Tab)", MapCommand::TogglePanel),
    ] {
        let (texts, _) = lay_out(size, &mut usual(), &told.content(), &[&[], &[]]);
        let (_, rect, _) = texts.iter().find(|(text, ..)| text == words).unwrap();
        let [over, press, release] = click(rect.center());
        let (_, answer) =
            lay_out(size, &mut usual(), &told.content(), &[&[], &over, &press, &release]);
        assert_eq!(answer.commands, [command], "{words}");
    }
}

#[test]
fn the_mouse_is_the_maps_beside_the_panel_and_only_there() {
    let told = Told::new();
    let (_, answer) = lay_out([1280.0, 800.0], &mut usual(), &told.content(), &[&[], &[]]);
    let is_free = |x, y| !answer.occupied.iter().any(|rect| rect.contains(pos2(x, y)));
    assert!(is_free(500.0, 400.0));
    assert!(!is_free(1200.0, 400.0), "panel");
    assert!(!is_free(500.0, 795.0), "line of positions");
    assert!(!is_free(1280.0 - WIDTH - 34.0, 34.0), "compass");
}

#[test]
fn the_divider_follows_the_mouse_and_stays_in_the_window() {
    let told = Told::new();
    let mut settings = MapSettings { compare: Compare::Split, is_panel_open: false, ..usual() };
    let at = pos2(500.0, 400.0);
    let [over, press, _] = click(at);
    let moved = [Event::PointerMoved(at + vec2(-250.0, 0.0))];
    lay_out([1000.0, 700.0], &mut settings, &told.content(), &[&[], &over, &press, &moved]);
    assert!((settings.divider_share - 0.25).abs() < 0.01, "{}", settings.divider_share);
    let out = [Event::PointerMoved(pos2(-50.0, 400.0))];
    let [over, press, _] = click(pos2(250.0, 400.0));
    lay_out([1000.0, 700.0], &mut settings, &told.content(), &[&[], &over, &press, &out]);
    assert!((settings.divider_share - 0.05).abs() < 0.01, "{}", settings.divider_share);
}

#[test]
fn what_nobody_moves_stays_as_it_was_given() {
    let told = Told::new();
    for (exaggeration, screen_space_error_px) in [(0.01, 0.1), (100.0, 20.0), (1.234_5, 0.75)] {
        let given = MapSettings {
            exaggeration,
            screen_space_error_px,
            width_factors: [0.123_4; FunctionalRoadClass::COUNT],
            ..usual()
        };
        let mut settings = given.clone();
        lay_out([1000.0, 1400.0], &mut settings, &told.content(), &[&[], &[]]);
        assert_eq!(settings, given);
    }
}

#[test]
fn areas_have_a_time_where_some_are_drawn() {
    let mut told = Told::new();
    for areas_ms in [2.5, 0.0] {
        told.passes.iter_mut().for_each(|(_, times)| times.areas_ms = areas_ms);
        // The window is wide enough for everything in the status line.
        let (texts, _) = lay_out([4000.0, 1000.0], &mut usual(), &told.content(), &[&[], &[]]);
        let timed = texts.iter().any(|(words, ..)| words.contains(" areas 2.5,"));
        assert_eq!(timed, areas_ms > 0.0, "{texts:?}");
    }
}

#[test]
fn classes_have_their_names_and_the_colours_of_the_style() {
    let mut told = Told::new();
    told.class_labels = std::array::from_fn(|class| format!("name {class}"));
    let (texts, _) = lay_out([1280.0, 1000.0], &mut usual(), &told.content(), &[&[], &[]]);
    for class in 0..9 {
        let name = format!("name {class}");
        assert!(texts.iter().any(|(words, ..)| *words == name), "{name}: {texts:?}");
    }
    assert!(!texts.iter().any(|(words, ..)| words == "Wireframe"), "folded away");
}

/// Each layer has its title and the classes that are drawn, of any geometry.
#[test]
fn layers_are_listed_with_their_classes() {
    let long = "boundary, level 6, boundary, level 7, boundary, level 8";
    let color = [0.5, 0.2, 0.5];
    let looks = [
        (long, LayerLook::Line(LineStyle::solid(color, 2.0))),
        ("water", LayerLook::Area(AreaStyle { color, opacity: 1.0, steepest_deg: None })),
        (
            "trees",
            LayerLook::Point(PointStyle {
                color,
                size_px: 7.0,
                outline: None,
                opacity: 1.0,
                max_pixel_m: None,
            }),
        ),
    ];
    let layer = |(number, (label, look)): (usize, (&str, LayerLook))| LayerLegend {
        id: format!("layer-{number}"),
        title: format!("Layer {number}"),
        geometry: corniche_layers::LayerGeometry::Line,
        rows: vec![LayerRow { label: label.to_owned(), look }],
    };
    let layers: Vec<LayerLegend> = looks.into_iter().enumerate().map(layer).collect();
    let told = Told { layers, ..Told::new() };
    let (texts, _) = lay_out([1280.0, 1200.0], &mut usual(), &told.content(), &[&[], &[]]);
    for label in [long, "water", "trees", "Layer 0", "Layer 1", "Layer 2"] {
        let (_, place, clip) = texts.iter().find(|(words, ..)| words == label).expect(label);
        assert!(clip.contains_rect(*place), "{label}");
    }
}

/// A click on the title of a layer hides it, and another one shows it.
#[test]
fn layers_are_hidden_by_a_click() {
    let layer = |id: &str| LayerLegend {
        id: id.to_owned(),
        title: format!("the {id}"),
        geometry: corniche_layers::LayerGeometry::Line,
        rows: Vec::new(),
    };
    let told = Told { layers: vec![layer("walls"), layer("trees")], ..Told::new() };
    let mut settings = usual();
    let (texts, _) = lay_out([1280.0, 1200.0], &mut settings, &told.content(), &[&[], &[]]);
    let (_, place, _) = texts.iter().find(|(words, ..)| words == "the walls").unwrap();
    let [over, press, release] = click(place.center());
    for (walls, trees) in [(false, true), (true, true)] {
        lay_out([1280.0, 1200.0], &mut settings, &told.content(), &[&over, &press, &release]);
        let shown = ["walls", "trees"].map(|id| settings.layers.contains(id));
        assert_eq!(shown, [walls, trees]);
    }
}

/// The map keeps its place whatever the status line shows.
#[test]
fn the_status_line_is_as_high_in_every_window_whatever_it_tells() {
    let told = Told::new();
    let quiet = Told { passes: Vec::new(), ..Told::new() };
    for size in [[1280.0, 800.0], [820.0, 640.0], [480.0, 640.0], [300.0, 200.0]] {
        let mut idle = quiet.content();
        (idle.cursor, idle.recording_s, idle.tiles_missing) = (None, None, 0);
        let mut busy = told.content();
        busy.mode = Mode::Fly;
        for content in [idle, busy] {
            let (texts, answer) = lay_out(size, &mut usual(), &content, &[&[], &[]]);
            let status = answer.occupied[0];
            assert!((status.height() - status_line::HEIGHT).abs() < 0.01, "{size:?}: {status:?}");
            for (words, rect, _) in texts.iter().filter(|(_, rect, _)| rect.top() > status.top()) {
                assert!(status.contains_rect(*rect), "{size:?}: {words:?} at {rect:?}");
            }
        }
    }
}

#[test]
fn the_status_says_how_roads_are_drawn_and_by_what() {
    let told = Told::new();
    let mut content = told.content();
    let has = |content: &WindowContent<'_>, words: &str| {
        let (texts, _) = lay_out([1280.0, 800.0], &mut usual(), content, &[&[], &[]]);
        texts.iter().any(|(text, ..)| text == words)
    };
    assert!(has(&content, "roads SV, drawn by the processor"));
    content.is_software = false;
    assert!(has(&content, "roads SV"));
}

#[test]
fn where_the_middle_has_no_ground_the_map_says_how_to_come_back() {
    let told = Told::new();
    let words = "no data here; press R for the first view";
    let has = |content: &WindowContent<'_>| {
        let (texts, _) = lay_out([480.0, 640.0], &mut usual(), content, &[&[], &[]]);
        texts.iter().any(|(text, ..)| text == words)
    };
    let mut content = told.content();
    assert!(!has(&content));
    content.metres_per_point = None;
    assert!(has(&content));
    content.mode = Mode::Fly;
    assert!(!has(&content), "in flight one may look at the sky");
    (content.mode, content.tiles_drawn) = (Mode::Map, 0);
    assert!(!has(&content), "nothing is loaded yet");
}

#[test]
fn a_closed_panel_leaves_a_button_that_opens_it() {
    let told = Told::new();
    let size = [480.0, 640.0];
    let mut settings = MapSettings { is_panel_open: false, ..usual() };
    let (_, answer) = lay_out(size, &mut settings, &told.content(), &[&[], &[]]);
    let button = answer.occupied.iter().find(|rect| (rect.width() - 28.0).abs() < 0.1).unwrap();
    let [over, press, release] = click(button.center());
    let passes: [&[Event]; 4] = [&[], &over, &press, &release];
    let (_, answer) = lay_out(size, &mut settings, &told.content(), &passes);
    assert_eq!(answer.commands, [MapCommand::TogglePanel]);
}

#[test]
fn a_narrow_window_opens_without_the_panel() {
    assert!(first_width(480.0).abs() < 0.1 && (first_width(640.0) - WIDTH).abs() < 0.1);
    assert!((width(480.0) - WIDTH).abs() < 0.1, "it can be opened there");
}

#[test]
fn a_place_is_typed_and_entered() {
    let told = Told::new();
    let size = [1280.0, 1000.0];
    let mut settings = usual();
    let (texts, _) = lay_out(size, &mut settings, &told.content(), &[&[], &[]]);
    let (_, rect, _) = texts.iter().find(|(text, ..)| text == "lon, lat").unwrap();
    let [over, press, release] = click(rect.center());
    let typed = [Event::Text("9.52, 47.14".into())];
    let key = |pressed| Event::Key {
        key: egui::Key::Enter,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: egui::Modifiers::NONE,
    };
    let entered = [key(true)];
    let passes: [&[Event]; 6] = [&[], &over, &press, &release, &typed, &entered];
    let (_, answer) = lay_out(size, &mut settings, &told.content(), &passes);
    assert_eq!(settings.place, "9.52, 47.14");
    assert_eq!(answer.commands, [MapCommand::GoTo]);
}
