//! The style in which QGIS draws the layer of a GeoPackage when it opens it: the colours and widths
//! of the classes, as QML.
//!
//! Source: the QML that QGIS 3.22 reads, `QgsCategorizedSymbolRenderer` and
//! `QgsSymbolLayerUtils::parseProperties`.

use std::fmt::Write as _;

use corniche_layers::{ClassForm, LayerForm, LayerGeometry};
use corniche_styles::{AreaStyle, Dash, LayerLook, LineStyle, PointStyle, Rgb, RoadStyle, Style};

/// Millimetres per pixel: QGIS assumes screens with 96 pixels per inch.
const MM_PER_PX: f32 = 25.4 / 96.0;

/// The classes in the field `class` of features.
pub(crate) enum StyledClasses {
    /// The functional road classes.
    Roads,
    /// The classes of the layer with this table.
    Layer(Box<LayerForm>),
}

/// One class: its value in the field `class`, its name in the legend, and its symbol parts, the
/// lowest first.
struct Category {
    value: String,
    label: String,
    opacity: f32,
    parts: Vec<SymbolPart>,
}

/// A part of the symbol of a class. All parts with a lower `pass` are drawn below, whatever their
/// class.
struct SymbolPart {
    pass: usize,
    kind: &'static str,
    properties: Vec<(&'static str, String)>,
}

/// Returns the QML of these classes in this style.
pub(crate) fn qml(classes: &StyledClasses, style: &Style) -> String {
    let (categories, geometry) = match classes {
        StyledClasses::Roads => (roads(style), LayerGeometry::Line),
        StyledClasses::Layer(table) => (layer(table, style), table.geometry),
    };
    let (geometry_type, symbol_type) = match geometry {
        LayerGeometry::Point => (0, "marker"),
        LayerGeometry::Line => (1, "line"),
        LayerGeometry::Area => (2, "fill"),
    };
    let (mut values, mut symbols) = (String::new(), String::new());
    for (number, category) in categories.iter().enumerate() {
        let Category { value, label, .. } = category;
        let label = label.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
        // Writing to a text cannot fail.
        let _ = writeln!(
            values,
            r#"<category value="{value}" symbol="{number}" label="{label}" render="true"/>"#
        );
        let _ = writeln!(
            symbols,
            r#"<symbol type="{symbol_type}" name="{number}" alpha="{}" clip_to_extent="1" force_rhr="0">"#,
            category.opacity
        );
        category.parts.iter().for_each(|part| part.write(&mut symbols));
        symbols.push_str("</symbol>\n");
    }
    format!(
        r#"<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.22.0" styleCategories="Symbology">
<renderer-v2 type="categorizedSymbol" attr="class" symbollevels="1" forceraster="0" enableorderby="0">
<categories>
{values}</categories>
<symbols>
{symbols}</symbols>
</renderer-v2>
<blendMode>0</blendMode>
<featureBlendMode>0</featureBlendMode>
<layerOpacity>1</layerOpacity>
<layerGeometryType>{geometry_type}</layerGeometryType>
</qgis>
"#
    )
}

/// Edges are below all roads, and important roads above others.
fn roads(style: &Style) -> Vec<Category> {
    let above = |class: usize| style.roads.len() - class;
    let category = |(class, road): (usize, &RoadStyle)| {
        let width_px = road.flat_width_px();
        let line = |pass, color, width_px| line(pass, color, width_px, &road.dash);
        let edge = line(0, road.outline, width_px + 2.0 * style.outline_px as f32);
        let bands = road.bands.all().iter();
        let bands = bands.map(|band| line(above(class), band.color, width_px * band.width_share));
        Category {
            value: class.to_string(),
            label: format!("class {class}"),
            opacity: road.opacity,
            parts: std::iter::once(edge).chain(bands).collect(),
        }
    };
    style.roads.iter().enumerate().map(category).collect()
}

/// The first class of a layer is above the others.
fn layer(table: &LayerForm, style: &Style) -> Vec<Category> {
    let category = |(number, class): (usize, &ClassForm)| {
        let pass = table.classes.len() - number;
        let (opacity, parts) = match style.layer_look(table, number) {
            LayerLook::Area(AreaStyle { color, opacity, .. }) => {
                let properties = vec![
                    ("color", rgba(color)),
                    ("style", "solid".into()),
                    ("outline_style", "no".into()),
                ];
                (opacity, vec![SymbolPart { pass, kind: "SimpleFill", properties }])
            }
            LayerLook::Line(LineStyle { color, width_px, casing, opacity, dash, .. }) => {
                let casing = casing.map(|casing| line(0, casing, width_px + 2.0, &dash));
                let own = line(pass, color, width_px, &dash);
                (opacity, casing.into_iter().chain([own]).collect())
            }
            LayerLook::Point(look) => (look.opacity, vec![marker(pass, &look)]),
        };
        let label = class.title.title(&["en"]).unwrap_or(&class.id).to_owned();
        Category { value: class.id.clone(), label, opacity, parts }
    };
    table.classes.iter().enumerate().map(category).collect()
}

impl SymbolPart {
    fn write(&self, out: &mut String) {
        let Self { pass, kind, properties } = self;
        let _ = writeln!(out, r#"<layer class="{kind}" pass="{pass}" enabled="1" locked="0">"#);
        for (key, value) in properties {
            let _ = writeln!(out, r#"<prop k="{key}" v="{value}"/>"#);
        }
        out.push_str("</layer>\n");
    }
}

fn line(pass: usize, color: Rgb, width_px: f32, dash: &Dash) -> SymbolPart {
    let is_dashed = dash.least_px > 0.0 && dash.widths.is_none();
    let cap = if is_dashed { "flat" } else { "round" };
    let mut properties = vec![
        ("line_color", rgba(color)),
        ("line_style", "solid".into()),
        ("line_width", millimetres(width_px)),
        ("line_width_unit", "MM".into()),
        ("capstyle", cap.into()),
        ("joinstyle", "round".into()),
    ];
    if is_dashed {
        let [first, gap, second] = dash.ends;
        let lengths = [first, gap - first, second - gap, 1.0 - second];
        let lengths = lengths.map(|share| millimetres(share * dash.least_px));
        properties.extend([
            ("use_custom_dash", "1".into()),
            ("customdash", lengths.join(";")),
            ("customdash_unit", "MM".into()),
        ]);
    }
    SymbolPart { pass, kind: "SimpleLine", properties }
}

/// QGIS centres the edge on the border of the disc.
fn marker(pass: usize, PointStyle { color, size_px, outline, .. }: &PointStyle) -> SymbolPart {
    let edge_px = if outline.is_some() { 1.0 } else { 0.0 };
    let properties = vec![
        ("name", "circle".into()),
        ("color", rgba(*color)),
        ("size", millimetres(size_px + edge_px)),
        ("size_unit", "MM".into()),
        ("outline_style", if outline.is_some() { "solid" } else { "no" }.into()),
        ("outline_color", rgba(outline.unwrap_or(*color))),
        ("outline_width", millimetres(edge_px)),
        ("outline_width_unit", "MM".into()),
    ];
    SymbolPart { pass, kind: "SimpleMarker", properties }
}

fn rgba(color: Rgb) -> String {
    let [red, green, blue] = corniche_styles::to_bytes(color);
    format!("{red},{green},{blue},255")
}

fn millimetres(px: f32) -> String {
    format!("{:.3}", px * MM_PER_PX)
}

#[cfg(test)]
#[path = "map_style_tests.rs"]
mod tests;
