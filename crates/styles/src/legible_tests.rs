//! Road classes in the built-in styles: distinguishable for all kinds of colour vision, with more
//! contrast for more important classes.

use corniche_roads::FunctionalRoadClass;

use crate::{
    LayerLook, Rgb, RoadStyle, Style, layer_looks::built_in_layer, parse_style, style_preset,
    style_preset_names,
};

/// Kinds of colour vision: normal, without cones for long waves (protanopia), and without cones for
/// middle waves (deuteranopia).
///
/// Source of the matrices, for linear RGB: Machado, Oliveira & Fernandes 2009, A
/// Physiologically-based Model for Simulation of Color Vision Deficiency, IEEE Transactions on
/// Visualization and Computer Graphics 15 (6), severity 1.0.
const EYES: [(&str, [[f64; 3]; 3], f64); 3] = [
    ("three cones", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], 20.0),
    (
        "protanopia",
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ],
        12.0,
    ),
    (
        "deuteranopia",
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ],
        12.0,
    ),
];

fn linear(color: Rgb) -> [f64; 3] {
    color
        .map(f64::from)
        .map(|part| if part <= 0.04045 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) })
}

/// Converts linear sRGB under D65 to CIELAB.
fn lab([red, green, blue]: [f64; 3]) -> [f64; 3] {
    let xyz = [
        (0.4124564 * red + 0.3575761 * green + 0.1804375 * blue) / 0.95047,
        0.2126729 * red + 0.7151522 * green + 0.0721750 * blue,
        (0.0193339 * red + 0.1191920 * green + 0.9503041 * blue) / 1.08883,
    ];
    let [x, y, z] = xyz.map(|part| {
        if part > 216.0 / 24389.0 { part.cbrt() } else { (24389.0 / 27.0 * part + 16.0) / 116.0 }
    });
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Returns a colour as an eye of this kind perceives it.
fn seen(color: Rgb, eye: [[f64; 3]; 3]) -> [f64; 3] {
    let color = linear(color);
    lab(eye.map(|row| row.iter().zip(color).map(|(a, b)| a * b).sum::<f64>().clamp(0.0, 1.0)))
}

/// The difference ΔE₀₀ of two colours in CIELAB.
///
/// Source: Sharma, Wu & Dalal 2005, The CIEDE2000 Color-Difference Formula: Implementation Notes,
/// Supplementary Test Data, and Mathematical Observations, Color Research and Application 30 (1).
fn difference(one: [f64; 3], other: [f64; 3]) -> f64 {
    let power = |of: f64| (of.powi(7) / (of.powi(7) + 25_f64.powi(7))).sqrt();
    let mean_chroma = f64::midpoint(one[1].hypot(one[2]), other[1].hypot(other[2]));
    let redder = 1.5 - 0.5 * power(mean_chroma);
    let polar = |[light, a, b]: [f64; 3]| {
        let a = a * redder;
        let hue =
            if a == 0.0 && b == 0.0 { 0.0 } else { b.atan2(a).to_degrees().rem_euclid(360.0) };
        [light, a.hypot(b), hue]
    };
    let ([light, chroma, hue], [to_light, to_chroma, to_hue]) = (polar(one), polar(other));
    let is_grey = chroma * to_chroma == 0.0;
    let turn = match to_hue - hue {
        _ if is_grey => 0.0,
        turn if turn > 180.0 => turn - 360.0,
        turn if turn < -180.0 => turn + 360.0,
        turn => turn,
    };
    let mean_hue = match hue + to_hue {
        sum if is_grey => sum,
        sum if (hue - to_hue).abs() <= 180.0 => sum / 2.0,
        sum if sum < 360.0 => f64::midpoint(sum, 360.0),
        sum => f64::midpoint(sum, -360.0),
    };
    let (mean_light, mean_chroma) =
        (f64::midpoint(light, to_light), f64::midpoint(chroma, to_chroma));
    let cosine = |factor: f64, plus: f64| (factor * mean_hue + plus).to_radians().cos();
    let t = 1.0 - 0.17 * cosine(1.0, -30.0) + 0.24 * cosine(2.0, 0.0) + 0.32 * cosine(3.0, 6.0)
        - 0.20 * cosine(4.0, -63.0);
    let from_50 = (mean_light - 50.0).powi(2);
    let by_light = (to_light - light) / (1.0 + 0.015 * from_50 / (20.0 + from_50).sqrt());
    let by_chroma = (to_chroma - chroma) / (1.0 + 0.045 * mean_chroma);
    let by_hue = 2.0 * (chroma * to_chroma).sqrt() * (turn / 2.0).to_radians().sin()
        / (1.0 + 0.015 * mean_chroma * t);
    let rotation = 60.0 * (-((mean_hue - 275.0) / 25.0).powi(2)).exp();
    let both = -rotation.to_radians().sin() * 2.0 * power(mean_chroma) * by_chroma * by_hue;
    (by_light.powi(2) + by_chroma.powi(2) + by_hue.powi(2) + both).sqrt()
}

/// Pairs of colours that were published with the formula.
#[test]
fn differences_are_those_of_the_published_pairs() {
    for (one, other, expected) in [
        ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
        ([50.0, 0.0, 0.0], [50.0, -1.0, 2.0], 2.3669),
        ([50.0, 2.5, 0.0], [73.0, 25.0, -18.0], 27.1492),
        ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
        ([2.0776, 0.0795, -1.135], [0.9033, -0.0636, -0.5514], 0.9082),
    ] {
        assert!((difference(one, other) - expected).abs() < 1e-4, "{one:?} {other:?}");
    }
}

/// Returns the contrast of two colours: the ratio of their luminances, as the Web Content
/// Accessibility Guidelines (W3C 2018) define it.
fn contrast(one: Rgb, other: Rgb) -> f64 {
    let luminance = |color| {
        let [red, green, blue] = linear(color);
        0.2126 * red + 0.7152 * green + 0.0722 * blue + 0.05
    };
    let (one, other) = (luminance(one), luminance(other));
    one.max(other) / one.min(other)
}

/// Returns all colours of level ground in a style: tints of heights, and areas over them. Water is
/// not included, because no roads are on it.
fn grounds(style: &Style) -> Vec<Rgb> {
    let tints = || style.tint.stops.iter().map(|(_, color)| *color);
    let layer = built_in_layer("areas");
    let classes = layer.classes.iter().enumerate();
    let dry = classes.filter(|(_, class)| !["sea", "water"].contains(&class.id.as_str()));
    let over = dry.flat_map(|(class, _)| {
        let LayerLook::Area(area) = style.layer_look(&layer, class) else { panic!("areas") };
        tints()
            .map(move |tint| [0, 1, 2].map(|k| tint[k] + area.opacity * (area.color[k] - tint[k])))
    });
    tints().chain(over).collect()
}

fn presets() -> impl Iterator<Item = (&'static str, Style)> {
    style_preset_names().map(|name| (name, parse_style(style_preset(name).unwrap()).unwrap()))
}

fn classes(style: &Style) -> impl Iterator<Item = (u8, &RoadStyle)> {
    FunctionalRoadClass::all().map(|class| (class.number(), style.road(class)))
}

/// Neighbouring classes are distinguishable on wide roads: by their fill, or, where fills are
/// alike, by their edge.
#[test]
fn neighbouring_classes_are_told_apart_by_all_eyes() {
    for (name, style) in presets() {
        let roads: Vec<_> = classes(&style).collect();
        for pair in roads.windows(2) {
            let [(class, one), (_, other)] = pair else { continue };
            for (eye, matrix, least) in EYES {
                let between = |of: fn(&RoadStyle) -> Rgb| {
                    difference(seen(of(one), matrix), seen(of(other), matrix))
                };
                let found =
                    between(|road| road.bands.main_color()).max(between(|road| road.outline));
                println!("{name}: class {class} and the next, {eye}: {found:.1}");
                assert!(found >= least, "{name}: class {class} and the next, {eye}: {found:.1}");
            }
        }
    }
}

/// The contrasts of a road with a ground: as a wide road, whose fill and edge are visible, and as a
/// thin one.
fn contrasts(road: &RoadStyle, ground: Rgb) -> [f64; 2] {
    let fills = road.bands.all().iter().map(|band| band.color);
    let wide = fills.chain([road.outline]).map(|color| contrast(color, ground)).fold(1.0, f64::max);
    [wide, contrast(road.thin.unwrap_or(road.bands.main_color()), ground)]
}

/// The minimum contrasts of each class, for wide roads and for thin ones.
const LEAST: [[f64; 2]; FunctionalRoadClass::COUNT] = [
    [4.3, 2.6],
    [4.2, 2.3],
    [3.7, 2.1],
    [3.2, 1.85],
    [2.7, 1.65],
    [2.7, 1.5],
    [1.65, 1.4],
    [1.35, 1.3],
    [1.2, 1.2],
];

/// On every ground a class has at most the contrast of the class above it. The ground under a photo
/// is unknown, so the style `photo` is not checked.
#[test]
fn contrast_falls_with_the_class_on_every_ground() {
    for (name, style) in presets().filter(|(name, _)| *name != "photo") {
        for ground in grounds(&style) {
            let mut above = [f64::INFINITY; 2];
            for ((class, road), least) in classes(&style).zip(LEAST) {
                let found = contrasts(road, ground);
                for k in 0..2 {
                    let which = ["wide", "thin"][k];
                    assert!(
                        found[k] <= 1.005 * above[k] && found[k] >= least[k],
                        "{name}: {which} roads of class {class} on {ground:?}: {found:?}, above {above:?}"
                    );
                }
                above = found;
            }
        }
    }
}

/// Water is distinguishable from every ground and from voids.
#[test]
fn water_is_told_from_ground() {
    for (name, style) in presets() {
        for ground in grounds(&style).into_iter().chain([style.void]) {
            let [water, ground] = [style.water, ground].map(|color| seen(color, EYES[0].1));
            let found = difference(water, ground);
            assert!(found >= 10.0, "{name}: {found:.1}");
        }
    }
}
