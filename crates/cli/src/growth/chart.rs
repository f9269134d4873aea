//! Charts of how vertices grow over the levels: a curve for each class, or one for each of several packages.

use corniche_tileset::Manifest;
use plotters::prelude::RGBColor;

use super::{compare::Compared, factors::of_level};
use crate::{
    chart::{Axes, Axis, Curve, MOST_SHAPES, Marks, Ticks, draw, ends},
    escaped::{in_line, shortened},
    failure::Failure,
};

/// One colour a class, as on a road atlas: red for motorways down to grey for tracks.
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

/// How far marks stand beside their level at most, levels.
const MOST_ASIDE: f64 = 0.3;

/// How far a class's marks stand beside their level, so that those of other classes do not hide them.
fn aside(class: u8) -> f64 {
    let last = (CLASS_COLORS.len() - 1) as f64;
    MOST_ASIDE * (2.0 * f64::from(class) / last - 1.0)
}

/// The axes of a chart with growth up to the highest one.
fn axes(x: Axis, highest: f64) -> Axes {
    Axes {
        size_px: (900, 520),
        caption: "Vertices of clipped roads over the level's simplified lines".to_owned(),
        x,
        y: Axis {
            description: "times the vertices",
            range: 0.0..highest * 1.08,
            ticks: Ticks::Round,
        },
    }
}

/// Growth of clipped vertices over the level's own simplified line, one curve a class over the levels.
pub(crate) fn growth(manifest: &Manifest) -> anyhow::Result<String> {
    let factor = |geo: u64, simplified: u64| geo as f64 / simplified as f64;
    let rows: Vec<_> = manifest.growth.iter().filter(|row| row.simplified_vertices > 0).collect();
    let highest = rows
        .iter()
        .map(|row| factor(row.geo_vertices, row.simplified_vertices))
        .fold(1.0_f64, f64::max);
    let levels = || rows.iter().map(|row| row.level);
    let [first, last] = [levels().min(), levels().max()].map(Option::unwrap_or_default);
    let x = Axis {
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

/// How far the marks of packages stand beside their level at most, levels.
const PACKAGES_ASIDE: f64 = 0.15;
/// Longer names of packages are cut.
const LONGEST_NAME: usize = 24;

/// Refuses more packages than a chart tells apart.
pub(crate) fn refuse_too_many(packages: usize) -> Result<(), Failure> {
    if packages <= MOST_SHAPES {
        return Ok(());
    }
    Err(Failure::unusable(format!(
        "a chart tells at most {MOST_SHAPES} packages apart, and these are {packages}; name fewer, or leave out --svg"
    )))
}

/// Growth of clipped vertices over the level's own simplified line, all classes, one curve a package over the levels' cells. Of more
/// packages than [`refuse_too_many`] lets pass, some look alike.
pub(crate) fn comparison(packages: &[Compared<'_>]) -> anyhow::Result<String> {
    // Numbers stand at the levels of the first package.
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
    let x = Axis {
        description: "cell of the level, m",
        range: least - PACKAGES_ASIDE - 0.1..most + PACKAGES_ASIDE + 0.1,
        ticks: Ticks::Doubled {
            count: (most.floor() - least.ceil()).max(0.0) as usize + 1,
            unit: unit_m,
        },
    };
    draw(&axes(x, highest), &curves)
}

/// The file's name without folders and ending, cut if it is long.
fn short_name(path: &str) -> String {
    let stem = std::path::Path::new(path).file_stem().unwrap_or_default().to_string_lossy();
    shortened(&in_line(&stem), LONGEST_NAME).into_owned()
}

#[cfg(test)]
#[path = "chart_tests.rs"]
mod tests;
