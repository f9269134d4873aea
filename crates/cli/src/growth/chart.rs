//! Charts of the growth of vertices over the levels: a curve per class, or per package if there
//! are several.

use corniche_tileset::Manifest;
use plotters::prelude::RGBColor;

use super::{compare::Compared, factors::of_level};
use crate::{
    chart::{Axes, ChartAxis, Curve, MOST_SHAPES, Marks, Ticks, draw, ends},
    escaped::{in_line, shortened},
    failure::Result,
};

/// One colour per class, as on a road atlas: from red for motorways to grey for tracks.
const CLASS_COLORS: [RGBColor; 9] = [
    RGBColor(200, 30, 40),
    RGBColor(230, 100, 30),
    RGBColor(235, 160, 30),
    RGBColor(190, 170, 20),
    RGBColor(110, 150, 50),
    RGBColor(40, 140, 140),
    RGBColor(50, 90, 170),
    RGBColor(110, 110, 120),
    RGBColor(160, 120, 160),
];

/// The largest distance between marks and their level, in levels.
const MOST_ASIDE: f64 = 0.3;

/// The distance between a class's marks and their level, so that they do not hide those of other
/// classes.
fn aside(class: u8) -> f64 {
    let last = (CLASS_COLORS.len() - 1) as f64;
    MOST_ASIDE * (2.0 * f64::from(class) / last - 1.0)
}

/// The axes of a chart whose largest growth is `highest`.
fn axes(x: ChartAxis, highest: f64) -> Axes {
    Axes {
        size_px: (900, 520),
        caption: "Vertices of clipped roads, relative to the level's simplified lines".to_owned(),
        x,
        y: ChartAxis {
            description: "growth factor of vertices",
            range: 0.0..highest * 1.08,
            ticks: Ticks::Round,
        },
    }
}

/// The growth of clipped vertices over the level's own simplified lines, one curve per class over
/// the levels.
pub(crate) fn growth(manifest: &Manifest) -> anyhow::Result<String> {
    let factor = |geo: u64, simplified: u64| geo as f64 / simplified as f64;
    let rows: Vec<_> = manifest.growth.iter().filter(|row| row.simplified_vertices > 0).collect();
    let highest = rows
        .iter()
        .map(|row| factor(row.geo_vertices, row.simplified_vertices))
        .fold(1.0_f64, f64::max);
    let levels = || rows.iter().map(|row| row.level);
    let [first, last] = [levels().min(), levels().max()].map(Option::unwrap_or_default);
    let x = ChartAxis {
        description: "level (0 = root)",
        range: f64::from(first) - MOST_ASIDE - 0.1..f64::from(last) + MOST_ASIDE + 0.1,
        ticks: Ticks::Whole(usize::from(last - first) + 1),
    };
    let curve = |(class, color): (u8, RGBColor)| {
        let of_class = rows.iter().filter(|row| row.class == class);
        let point = |row: &&corniche_tileset::GrowthRow| {
            let level = f64::from(row.level) + aside(class);
            (level, factor(row.geo_vertices, row.simplified_vertices))
        };
        let points: Vec<(f64, f64)> = of_class.map(point).collect();
        let name = format!("FRC {class}");
        (!points.is_empty()).then_some(Curve {
            name,
            color,
            points,
            marks: Marks::Shape(usize::from(class)),
        })
    };
    let curves: Vec<Curve> = (0_u8..).zip(CLASS_COLORS).filter_map(curve).collect();
    draw(&axes(x, highest), &curves)
}

/// The largest distance between marks of packages and their level, in levels.
const PACKAGES_ASIDE: f64 = 0.15;
/// Longer names of packages are shortened.
const LONGEST_NAME: usize = 24;

/// Rejects more packages than a chart can distinguish.
pub(crate) fn refuse_too_many(packages: usize) -> Result<()> {
    if packages <= MOST_SHAPES {
        return Ok(());
    }
    Err(unusable!(
        "a chart can distinguish at most {MOST_SHAPES} packages, not {packages}; name fewer, or omit --svg"
    ))
}

/// The growth of clipped vertices over the level's own simplified lines, all classes, one curve per
/// package over the levels' cells. If there are more packages than [`refuse_too_many`] accepts,
/// some curves look alike.
pub(crate) fn comparison(packages: &[Compared<'_>]) -> anyhow::Result<String> {
    // The axis has numbers at the levels of the first package.
    let unit_m = packages.first().map_or(1.0, |first| first.manifest.frame.cell().shorter_m());
    let points = |package: &Compared<'_>| -> Vec<(f64, f64)> {
        let levels = package.manifest.levels.iter();
        let point = |level: &corniche_tileset::LevelRecord| {
            let growth = of_level(package.manifest, level.level).1.growth_over_simplified?;
            Some(((level.cell_m.shorter_m() / unit_m).log2(), growth))
        };
        levels.filter_map(point).collect()
    };
    let last = packages.len().saturating_sub(1).max(1) as f64;
    let curve = |(index, package): (usize, &Compared<'_>)| {
        let aside = PACKAGES_ASIDE * (2.0 * index as f64 / last - 1.0);
        Curve {
            name: format!("{} {}", package.label, short_name(&package.name)),
            color: CLASS_COLORS[index % CLASS_COLORS.len()],
            points: points(package).iter().map(|&(x, y)| (x + aside, y)).collect(),
            marks: Marks::Shape(index),
        }
    };
    let curves: Vec<Curve> = packages.iter().enumerate().map(curve).collect();
    let all = || packages.iter().flat_map(points);
    let highest = all().map(|(_, growth)| growth).fold(1.0_f64, f64::max);
    let [least, most] = ends(all().map(|(x, _)| x));
    let (least, most) = if least <= most { (least, most) } else { (0.0, 0.0) };
    let x = ChartAxis {
        description: "cell of the level, m",
        range: least - PACKAGES_ASIDE - 0.1..most + PACKAGES_ASIDE + 0.1,
        ticks: Ticks::Doubled {
            count: (most.floor() - least.ceil()).max(0.0) as usize + 1,
            unit: unit_m,
        },
    };
    draw(&axes(x, highest), &curves)
}

/// The file's name without folders and extension, shortened if it is long.
fn short_name(path: &str) -> String {
    let stem = std::path::Path::new(path).file_stem().unwrap_or_default().to_string_lossy();
    shortened(&in_line(&stem), LONGEST_NAME).into_owned()
}

#[cfg(test)]
#[path = "chart_tests.rs"]
mod tests;
