use super::*;

#[test]
fn the_command_line_is_consistent() {
    use clap::CommandFactory as _;
    Arguments::command().debug_assert();
}

#[test]
fn options_of_later_issues_are_rejected() {
    for line in ["--resume", "--photo x.tif"] {
        let line = format!("corniche build --dem a.tif -o b {line}");
        assert!(Arguments::try_parse_from(line.split(' ')).is_err(), "{line}");
    }
}
