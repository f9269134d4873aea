use super::*;

fn usual() -> LineStyle {
    LineStyle::solid([0.0; 3], 3.0)
}

#[test]
fn a_file_alone_is_drawn_as_usual() {
    let found = parse("tracks/a,b=c.gpx").unwrap();
    assert_eq!(found.path(), Path::new("tracks/a,b=c.gpx"), "that is no entry of a style");
    assert_eq!(found.style(usual()), usual());
}

#[test]
fn entries_may_come_in_any_order() {
    let found = parse("a, b.geojson,width=4.5,color=#FF0000,dash=8/4,opacity=0.5").unwrap();
    assert_eq!(found.path(), Path::new("a, b.geojson"));
    let style = found.style(usual());
    assert_eq!((style.width_px, style.opacity, style.color), (4.5, 0.5, [1.0, 0.0, 0.0]));
    assert_eq!(style.dash, Dash::new(&[8.0, 4.0]).unwrap());
}

#[test]
fn what_is_wrong_is_told() {
    for (text, part) in [
        ("a.gpx,color=red", "is no colour"),
        ("a.gpx,width=0", "width must be 0.5 to 50"),
        ("a.gpx,dash=8-4", "is no pattern"),
        ("a.gpx,dash=8/4/2", "two or four lengths"),
        ("a.gpx,opacity=nan", "opacity must be"),
        (",width=3", "name a file"),
        ("", "name a file"),
    ] {
        let error = parse(text).unwrap_err();
        assert!(error.contains(part), "{text}: {error}");
    }
}
