//! The map of offsets as SVG.

use std::fmt::Write as _;

use corniche_geom::Bounds;
use corniche_matching::{MatchReport, MatchedRoad};
use corniche_tileset::Manifest;

use super::report::{is_sure, sure_across};
use crate::chart::in_xml;

/// Longer side of the map, pixels; the legend is next to it.
const SIDE_PX: f64 = 900.0;
const LEGEND_PX: f64 = 190.0;
const MARGIN_PX: f64 = 20.0;
/// Space next to the map for the labels of arrows.
const NAME_PX: f64 = 50.0;
/// Upper limits of offsets across a road, in metres, and their colours, which also differ in
/// brightness.
const COLOURS: [(f64, &str); 5] = [
    (1.0, "#1a9850"),
    (2.5, "#a6d96a"),
    (5.0, "#fdae61"),
    (10.0, "#f46d43"),
    (f64::INFINITY, "#a50026"),
];
const UNKNOWN: &str = "#b8b8b8";
/// Length of arrows.
const ARROW_PX_PER_M: f64 = 3.0;

pub(crate) fn to_svg(report: &MatchReport, manifest: &Manifest) -> String {
    let mut bounds = Bounds::EMPTY;
    // The area of the image, or of all roads if the image covers none.
    let is_covered = |road: &&MatchedRoad| road.samples > 0 || report.samples == 0;
    for point in report.roads.iter().filter(is_covered).flat_map(|road| &road.lines).flatten() {
        bounds.include(*point);
    }
    let scale = SIDE_PX / bounds.width().max(bounds.height()).max(1.0);
    let place = |[x, y]: [f64; 2]| {
        [MARGIN_PX + (x - bounds.min_x) * scale, MARGIN_PX + (bounds.max_y - y) * scale]
    };
    let width = bounds.width() * scale + 2.0 * MARGIN_PX + NAME_PX + LEGEND_PX;
    let height = (bounds.height() * scale + 2.0 * MARGIN_PX + 20.0).max(260.0);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    let _ = writeln!(
        svg,
        "<svg x=\"0\" y=\"0\" width=\"{:.0}\" height=\"{:.0}\" overflow=\"hidden\">",
        width - LEGEND_PX,
        height - 20.0
    );
    // Measured roads are drawn above the others.
    for sure in [false, true] {
        let roads = report.roads.iter().filter(|road| sure_across(road).is_some() == sure);
        for road in roads {
            let colour = sure_across(road).map_or(UNKNOWN, colour_of);
            for line in &road.lines {
                let points: Vec<String> = line
                    .iter()
                    .map(|&point| place(point).map(|at| format!("{at:.1}")).join(","))
                    .collect();
                let thick = if sure { 2.0 } else { 1.0 };
                // Writing to a String cannot fail.
                let _ = writeln!(
                    svg,
                    "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{thick}\"/>",
                    points.join(" ")
                );
            }
        }
    }
    for region in &report.regions {
        let Some(offset) = region.offset.as_ref().filter(|offset| is_sure(offset, region.samples))
        else {
            continue;
        };
        let [x, y] = place(region.center_m);
        let [dx, dy] = [offset.east_m, -offset.north_m].map(|metres| metres * ARROW_PX_PER_M);
        let _ = writeln!(
            svg,
            "<g stroke=\"black\" fill=\"black\"><line x1=\"{x:.1}\" y1=\"{y:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke-width=\"2\"/>\
             <circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\"/></g>\
             <text x=\"{:.1}\" y=\"{:.1}\" stroke=\"white\" stroke-width=\"3\" paint-order=\"stroke\">{:.1} m</text>",
            x + dx,
            y + dy,
            x + 6.0,
            y - 6.0,
            offset.east_m.hypot(offset.north_m)
        );
    }
    svg.push_str("</svg>\n");
    legend(&mut svg, width - LEGEND_PX + MARGIN_PX / 2.0, manifest, height);
    svg.push_str("</svg>\n");
    in_xml(&svg)
}

fn colour_of(across_m: f64) -> &'static str {
    let own = COLOURS.iter().find(|(most, _)| across_m.abs() <= *most);
    own.map_or(UNKNOWN, |(_, colour)| colour)
}

fn legend(svg: &mut String, x: f64, manifest: &Manifest, height: f64) {
    let mut y = 40.0;
    let mut line = |svg: &mut String, colour: Option<&str>, text: &str| {
        if let Some(colour) = colour {
            let _ = write!(
                svg,
                "<line x1=\"{x:.0}\" y1=\"{y:.0}\" x2=\"{:.0}\" y2=\"{y:.0}\" stroke=\"{colour}\" stroke-width=\"4\"/>",
                x + 24.0
            );
        }
        let _ = writeln!(
            svg,
            "<text x=\"{:.0}\" y=\"{:.0}\">{text}</text>",
            x + if colour.is_some() { 32.0 } else { 0.0 },
            y + 4.0
        );
        y += 20.0;
    };
    line(svg, None, "Offset across the road");
    let mut least = 0.0;
    for (most, colour) in COLOURS {
        let text = if most.is_finite() {
            format!("{least} to {most} m")
        } else {
            format!("more than {least} m")
        };
        line(svg, Some(colour), &text);
        least = most;
    }
    line(svg, Some(UNKNOWN), "not measurable alone");
    line(svg, None, "");
    line(svg, None, "Arrows: offsets per region,");
    line(svg, None, &format!("{ARROW_PX_PER_M} pixels per metre"));
    let credits = manifest.attribution.join(", ");
    let _ = writeln!(
        svg,
        "<text x=\"{MARGIN_PX}\" y=\"{:.0}\" font-size=\"10\">{}</text>",
        height - 8.0,
        escaped(&credits)
    );
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
