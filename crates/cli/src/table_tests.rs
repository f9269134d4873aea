use super::*;

#[test]
fn columns_line_up() {
    let mut table = Table::new(["level", "tiles"]);
    table.row(["0".into(), "1".into()]);
    table.row(["10".into(), "123456".into()]);
    assert_eq!(table.to_text(), "level   tiles\n0           1\n10     123456\n");
}

#[test]
fn columns_without_content_are_left_out() {
    let mut table = Table::new(["stage", "CPU", "wall", "memory"]);
    table.row(["a".into(), String::new(), "1 s".into(), String::new()]);
    table.row(["b".into(), String::new(), String::new(), String::new()]);
    assert_eq!(table.without_empty_columns().to_text(), "stage  wall\na       1 s\nb\n");
}

#[test]
fn thousands_are_separated() {
    assert_eq!(count(7), "7");
    assert_eq!(count(1_234_567), "1\u{202f}234\u{202f}567");
}
