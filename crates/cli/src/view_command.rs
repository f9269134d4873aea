//! Creates the `corniche render` command that reproduces the view in a window.

use std::path::Path;

use corniche_viewer::{
    CameraRequest, CapTest, Caps, Quads, RoadMethod, RoadOptions, RoadOutline, WidthGrowth,
};
use corniche_window::{CommandOf, ShownView};

use corniche_styles::Rgb;

use crate::args::{OUTLINES, OverlayArg, Roads, WIDTH_GROWTHS, word_of};

/// The output file in the command.
const PICTURE: &str = "view.png";

/// Prints the command that renders a view of this package, quoted for a POSIX shell.
pub(crate) fn command_of(
    package: &Path,
    overlays: &[OverlayArg],
    allow_ballpark: bool,
) -> CommandOf {
    let package = package.display().to_string();
    let overlays = overlays.to_vec();
    Box::new(move |shown| {
        let mut words = words(&package, &overlays, shown);
        if allow_ballpark && words.iter().any(|word| word == "--overlay") {
            words.push("--allow-ballpark".to_owned());
        }
        // Only the NUL character cannot be quoted, and arguments of programs cannot contain it.
        shlex::Quoter::new()
            .allow_nul(true)
            .join(words.iter().map(String::as_str))
            .unwrap_or_else(|_| words.join(" "))
    })
}

fn words(package: &str, overlays: &[OverlayArg], shown: &ShownView) -> Vec<String> {
    let mut words = vec!["corniche".to_owned(), "render".to_owned(), package.to_owned()];
    let settings = &shown.settings;
    let mut option = |name: &str, value: String| words.extend([name.to_owned(), value]);
    option("-o", PICTURE.to_owned());
    option("--roads", method(settings.roads.method).word().to_owned());
    option("--style", shown.style.clone());
    let [width, height] = shown.size_px;
    option("--size", format!("{width}x{height}"));
    match shown.camera {
        CameraRequest::LookAt { lon_deg, lat_deg, height_m, distance_m, orientation } => {
            // The precision is a centimetre on the ground, and a hundredth of a pixel in direction.
            option("--look-at", format!("{lon_deg:.7},{lat_deg:.7}"));
            if let Some(height_m) = height_m {
                option("--height", format!("{height_m:.2}"));
            }
            option("--distance", format!("{distance_m:.2}"));
            option("--heading", format!("{:.4}", orientation.heading_deg));
            option("--pitch", format!("{:.4}", orientation.pitch_deg));
        }
        CameraRequest::FromAbove { lon_deg, lat_deg, pixel_m, heading_deg } => {
            option("--look-at", format!("{lon_deg:.7},{lat_deg:.7}"));
            // The precision is a micrometre.
            option("--pixel", format!("{pixel_m:.6}"));
            option("--heading", format!("{heading_deg:.4}"));
            words.push("--ortho".to_owned());
        }
        CameraRequest::Overview | CameraRequest::OverviewFromAbove { .. } => {}
    }
    let mut option = |name: &str, value: String| words.extend([name.to_owned(), value]);
    option("--exaggeration", settings.exaggeration.to_string());
    option("--screen-space-error", settings.screen_space_error_px.to_string());
    option("--cell-px", settings.cell_px.to_string());
    option("--supersampling", settings.samples_per_side.to_string());
    if let Some(photo) = settings.photo {
        option("--photo", photo.to_string());
    }
    if let Some(list) = settings.layers.to_list() {
        option("--layers", list);
    }
    for (number, overlay) in overlays.iter().enumerate() {
        if settings.hidden_overlays.contains(&number) {
            continue;
        }
        // Without the overlays before it, the file would be drawn in their colour.
        let color = shown.overlay_colors.get(number).filter(|_| overlay.color.is_none());
        let color = color.map(|color| format!(",color={}", hex(*color))).unwrap_or_default();
        option("--overlay", format!("{}{color}", overlay.text));
    }
    for (name, value) in look(settings.roads) {
        option(name, value.to_owned());
    }
    if settings.is_wireframe {
        words.push("--wireframe".to_owned());
    }
    words
}

fn hex(color: Rgb) -> String {
    let [red, green, blue] = color.map(|channel| (channel * 255.0).round() as u8);
    format!("#{red:02X}{green:02X}{blue:02X}")
}

fn method(method: RoadMethod) -> Roads {
    match method {
        RoadMethod::Geometry => Roads::Geo,
        RoadMethod::ShadowVolumes => Roads::Sv,
        RoadMethod::None => Roads::None,
    }
}

/// Options of roads that differ from the defaults of `render`.
fn look(roads: RoadOptions) -> Vec<(&'static str, &'static str)> {
    let mut given = Vec::new();
    if roads.caps == Caps::None && roads.method != RoadMethod::None {
        given.push(("--caps", "none"));
    }
    if roads.width_growth != WidthGrowth::ByDistance {
        given.push(("--width-growth", word_of(&WIDTH_GROWTHS, &roads.width_growth)));
    }
    if roads.outline != RoadOutline::OfStyle {
        given.push(("--outline", word_of(&OUTLINES, &roads.outline)));
    }
    // The option is rejected if no shadow volume has caps.
    let has_caps = roads.method == RoadMethod::ShadowVolumes && roads.caps == Caps::Round;
    if roads.cap_test == CapTest::PaperQuadratic && has_caps {
        given.push(("--cap-test", "paper"));
    }
    if roads.quads == Quads::Level && roads.method == RoadMethod::Geometry {
        given.push(("--geo-quads", "level"));
    }
    given
}

#[cfg(test)]
#[path = "view_command_tests.rs"]
mod tests;
