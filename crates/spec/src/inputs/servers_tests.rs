//! Names on servers are converted to names of GDAL.

use super::*;

#[test]
fn names_on_servers_become_those_of_gdal() {
    for (name, expected) in [
        ("s3://maps/alps/dem.tif", "/vsis3/maps/alps/dem.tif"),
        ("https://example.org/dem.tif", "/vsicurl/https://example.org/dem.tif"),
        ("/vsis3/maps/dem.tif", "/vsis3/maps/dem.tif"),
        ("/vsizip/a.zip/dem.hgt", "/vsizip/a.zip/dem.hgt"),
        ("dem.tif", "dem.tif"),
    ] {
        assert_eq!(input_name(name.into()).unwrap(), Path::new(expected), "{name}");
    }
    assert!(input_name("s3:///dem.tif".into()).is_err());
}

#[test]
fn gdal_is_told_the_endpoint_of_the_environment() {
    let of = |variables: &[(&str, &str)]| {
        let variables =
            variables.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned()));
        let settings = StorageSettings {
            variables: variables.collect(),
            retries: corniche_objects::Retries::default(),
        };
        options(&settings)
            .into_iter()
            .filter(|(name, _)| name.starts_with("AWS"))
            .collect::<Vec<_>>()
    };
    assert_eq!(of(&[("AWS_ENDPOINT_URL", "")]), []);
    let plain = of(&[("AWS_ENDPOINT_URL", "http://127.0.0.1:9000/")]);
    let expected = [
        ("AWS_S3_ENDPOINT", "127.0.0.1:9000"),
        ("AWS_HTTPS", "NO"),
        ("AWS_VIRTUAL_HOSTING", "FALSE"),
    ];
    assert_eq!(plain, expected.map(|(name, value)| (name, value.to_owned())));
    let both = [("AWS_ENDPOINT_URL", "http://a"), ("AWS_ENDPOINT_URL_S3", "https://b.example")];
    assert_eq!(
        of(&both)[..2],
        [("AWS_S3_ENDPOINT", "b.example".to_owned()), ("AWS_HTTPS", "YES".to_owned())]
    );
    assert_eq!(of(&[("AWS_SKIP_SIGNATURE", "true")]), [("AWS_NO_SIGN_REQUEST", "YES".to_owned())]);
}
