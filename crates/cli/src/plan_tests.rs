//! Times in a plan have suitable units, and inputs are listed by name.

use super::*;

#[test]
fn times_are_told_in_units_that_fit() {
    let told = [0.4, 119.0, 121.0, 7200.0, 100_000.0].map(duration);
    assert_eq!(told, ["0 s", "119 s", "2 min", "2.0 h", "27.8 h"]);
}

#[test]
fn only_addresses_of_inputs_are_told_without_secrets() {
    for (path, told) in [
        ("me:a@h.org/dem.tif", "me:a@h.org/dem.tif"),
        ("http/me:a@h/dem.tif", "http/me:a@h/dem.tif"),
        ("http://me:tell-nobody@h/dem.tif", "http://…@h/dem.tif"),
        ("/vsizip//vsicurl/http://h/a.zip?tell-nobody", "/vsizip//vsicurl/http://h/a.zip?…"),
    ] {
        assert_eq!(shown(path), told);
    }
}
