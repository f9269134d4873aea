//! Tables are aligned, are folded if they are too wide, and omit empty columns.

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
fn a_table_is_folded_where_it_would_be_too_wide() {
    let headings = ["level", "a", "b", "c", "d"];
    let cell = |width: usize| "x".repeat(width);
    for widths in [[5, 20, 30, 30, 2], [5, 93, 1, 1, 1], [5, 40, 40, 40, 40], [60, 50, 50, 1, 1]] {
        let mut table = Table::new(headings);
        table.row(widths.map(cell));
        table.row(["2".into(), "1".into(), "2".into(), "3".into(), "4".into()]);
        let text = table.to_text();
        for line in text.lines() {
            let is_alone = line.split_whitespace().count() <= 2;
            assert!(line.chars().count() <= MAX_WIDTH || is_alone, "{widths:?}:\n{text}");
        }
        // All columns are there, and each block has the first column.
        for heading in headings {
            let times = text.split_whitespace().filter(|word| *word == heading).count();
            assert!(times == 1 || heading == "level", "{heading}: {times}\n{text}");
        }
        let blocks: Vec<&str> = text.split("\n\n").collect();
        assert!(
            blocks.iter().all(|block| block.starts_with("level") && block.lines().count() == 3)
        );
    }
    assert_eq!(folds(&[5, 20, 20, 20, 20, 20]), [1..4, 4..6], "about half on each side");
    let mut narrow = Table::new(headings);
    narrow.row([5, 40, 40, 2, 5].map(cell));
    assert_eq!(narrow.to_text().lines().count(), 2, "exactly as wide as allowed");
}

#[test]
fn thousands_are_separated_for_people_only() {
    assert_eq!(Digits::Apart.count(7), "7");
    assert_eq!(Digits::Apart.count(1_234_567), "1\u{202f}234\u{202f}567");
    assert_eq!(Digits::Plain.count(1_234_567), "1234567");
}

#[test]
fn texts_are_broken_at_spaces_and_go_on_below() {
    let words: Vec<String> = (1..40).map(|length| "x".repeat(length % 17 + 1)).collect();
    let text = words.join(" ");
    let folded = wrapped(&text, "- ", "    ");
    let lines: Vec<&str> = folded.lines().collect();
    assert!(lines.len() > 3 && lines[0].starts_with("- x"), "{folded}");
    for (line, next) in lines.iter().zip(&lines[1..]) {
        let first = next.trim_start().split(' ').next().unwrap();
        let width = line.chars().count();
        assert!(width <= MAX_WIDTH && width + 1 + first.len() > MAX_WIDTH, "{folded}");
        assert!(next.starts_with("    x"), "{folded}");
    }
    assert_eq!(folded.split_whitespace().skip(1).collect::<Vec<_>>(), words);
    // A text that fits is unchanged, including its spaces; a long word stays whole.
    assert_eq!(wrapped("a  b   c", "", "  "), "a  b   c");
    let long = "x".repeat(150);
    assert_eq!(wrapped(&format!("a {long} b"), "", "  "), format!("a\n  {long}\n  b"));
}
