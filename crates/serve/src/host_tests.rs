//! A server on the loopback accepts only host names that nobody else can point to it.

use super::Hosts;

#[test]
fn on_the_loopback_only_names_are_answered_that_cannot_be_made_to_lead_here() {
    let hosts = Hosts::from_names("Map.Example", "127.0.0.1:8080".parse().unwrap());
    for host in [
        "127.0.0.1:8080",
        "127.0.0.1",
        "localhost:8080",
        "LOCALHOST",
        "[::1]:8080",
        "10.0.0.7:80",
        "map.example:8080",
    ] {
        assert!(hosts.allow(host), "{host}");
    }
    for host in [
        "evil.example:8080",
        "localhost.evil.example",
        "127.0.0.1.evil.example",
        "evil.example@evil.example",
        "localhost:80:80",
        "[::1",
        "",
        " ",
        "a/b",
    ] {
        assert!(!hosts.allow(host), "{host}");
    }
}

#[test]
fn a_server_of_the_network_is_asked_by_any_name() {
    let hosts = Hosts::from_names("0.0.0.0", "0.0.0.0:8080".parse().unwrap());
    assert!(hosts.allow("maps.example.org"));
}
