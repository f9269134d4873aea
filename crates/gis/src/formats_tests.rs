//! The GDAL of the tests has all formats that the manual promises, and no ending belongs to two
//! formats.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use super::*;

#[test]
fn nothing_that_the_manual_promises_is_missing() {
    assert_eq!(missing_formats(), Vec::<String>::new());
    assert_eq!(lacks_format_of(Path::new("a.TIF")), None);
    assert_eq!(lacks_format_of(Path::new("a.unknown")), None);
}

#[test]
fn an_ending_is_of_one_format() {
    let formats = FORMATS.iter().chain(&OTHERS);
    let mut endings: Vec<&str> = formats.flat_map(|format| format.2).copied().collect();
    let count = endings.len();
    endings.sort_unstable();
    endings.dedup();
    assert_eq!(endings.len(), count);
}

#[test]
fn a_compression_that_the_driver_does_not_name_is_missing() {
    let list = |values: &str| {
        format!(
            "<List><Option name='COMPRESS' type='string-select'>{values}</Option><Option name='X'><Value>WEBP</Value></Option></List>"
        )
    };
    let all = COMPRESSIONS.map(|name| format!("  <Value>{name}</Value>\n")).concat();
    assert_eq!(missing_compressions(&list(&all)), Vec::<&str>::new());
    assert_eq!(missing_compressions(&list(&all).replace('\'', "\"")), Vec::<&str>::new());
    let fewer = list(&all.replace(">WEBP<", ">NONE<").replace(">ZSTD<", ">NONE<"));
    assert_eq!(missing_compressions(&fewer), ["ZSTD", "WEBP"]);
    assert_eq!(missing_compressions(""), COMPRESSIONS);
}

#[test]
fn a_format_that_is_missing_is_named_with_what_to_do() {
    let said = advice(&("GML", "GML", &["gml"]));
    for words in ["does not read GML", "ogr2ogr", "has the driver GML"] {
        assert!(said.contains(words), "{said}");
    }
    for ending in ["gml", "dxf", "tab", "gdb"] {
        let path = format!("a.{ending}");
        let format = OTHERS.iter().find(|format| format.2.contains(&ending)).unwrap();
        assert_eq!(lacks_format_of(Path::new(&path)).is_some(), is_missing(format), "{path}");
    }
}
