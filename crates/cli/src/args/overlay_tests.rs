//! Entries of `--overlay` are accepted in any order, and mistakes are reported.

use std::path::Path;

use super::*;

fn usual() -> LineStyle {
    LineStyle::solid([0.0; 3], 3.0)
}

#[test]
fn a_file_alone_is_drawn_as_usual() {
    let found = parse("tracks/a,b=c.gpx").unwrap();
    assert_eq!(found.path, Path::new("tracks/a,b=c.gpx"), "that is no entry of a style");
    assert_eq!(found.style(usual()), usual());
}

#[test]
fn entries_may_come_in_any_order() {
    let found = parse("a, b.geojson,width=4.5,color=#FF0000,dash=8/4,opacity=0.5").unwrap();
    assert_eq!(found.path, Path::new("a, b.geojson"));
    let style = found.style(usual());
    assert_eq!((style.width_px, style.opacity, style.color), (4.5, 0.5, [1.0, 0.0, 0.0]));
    let named = parse("a.geojson,color=Red").unwrap();
    assert!(
        named
            .style(usual())
            .color
            .iter()
            .zip([1.0, 0.0, 0.0])
            .all(|(own, of_red)| (own - of_red).abs() < 1e-6)
    );
    assert_eq!(style.dash, Dash::new(&[8.0, 4.0]).unwrap());
}

#[test]
fn colours_may_have_commas() {
    let found = parse("a (1,2).gpx,color=rgb(255, 0, 0),width=2").unwrap();
    assert_eq!(found.path, Path::new("a (1,2).gpx"));
    let style = found.style(usual());
    assert_eq!((style.width_px, style.color), (2.0, [1.0, 0.0, 0.0]));
}

#[test]
fn what_is_wrong_is_told() {
    for (text, part) in [
        ("a.gpx,color=redd", "is not a colour"),
        ("a.gpx,width=0", "width must be 0.5 to 50"),
        ("a.gpx,dash=8-4", "is not a dash pattern"),
        ("a.gpx,pattern=dots", "is not a pattern"),
        ("a.gpx,pattern=stars/9", "is not a pattern"),
        ("a.gpx,pattern=dots/9000", "out of range"),
        ("a.gpx,pattern=dots/12,dash=8/4", "either dash or pattern"),
        ("a.gpx,dash=8/4,dash=8/4", "dash is given twice"),
        ("a.gpx,width=3,color=#FF0000,width=4", "width is given twice"),
        ("a.gpx,dash=8/4/2", "two or four lengths"),
        ("a.gpx,opacity=nan", "opacity must be"),
        (",width=3", "name a file"),
        ("", "name a file"),
    ] {
        let error = parse(text).unwrap_err();
        assert!(error.contains(part), "{text}: {error}");
    }
}

#[test]
fn patterns_have_names() {
    let found = parse("a.gpx,pattern=arrows/20,width=6").unwrap();
    let usual = LineStyle::solid([0.0; 3], 3.0);
    assert_eq!(found.style(usual).dash, Dash::arrows(20.0).unwrap());
}
