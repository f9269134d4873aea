//! The tables of `docs/options.md` are those of the command line. `CORNICHE_BLESS=1` writes them.
//!
//! A table is between `<!-- options of COMMAND: begin -->`, or `<!-- options of COMMAND, without
//! those of OTHER: begin -->`, and `<!-- end -->`. A cell has the first sentence of an option's
//! help; further explanations follow below the table, written by hand.

use std::{collections::BTreeSet, fmt::Write as _, fs, path::PathBuf};

use clap::{Arg, ArgAction, Command, CommandFactory as _};

use super::Arguments;

/// The largest number of words in a cell.
const MOST_WORDS: usize = 25;

const BEGIN: &str = "<!-- options of ";
const END: &str = "<!-- end -->";

#[test]
fn the_tables_of_options_in_the_docs_are_those_of_the_program() {
    let page: PathBuf =
        [env!("CARGO_MANIFEST_DIR"), "..", "..", "docs", "options.md"].iter().collect();
    let stored = fs::read_to_string(&page).unwrap();
    let program = Arguments::command();
    let mut told = BTreeSet::new();
    let mut text = String::new();
    let mut rest = stored.as_str();
    while let Some((before, after)) = rest.split_once(BEGIN) {
        let (title, after) = after.split_once(": begin -->\n").expect("a table begins");
        let (_, after) = after.split_once(END).expect("a table ends");
        let (name, known) = title.split_once(", without those of ").unwrap_or((title, ""));
        let known = if known.is_empty() { Vec::new() } else { rows(find(&program, known)) };
        let mut shown = rows(find(&program, name));
        shown.retain(|row| !known.iter().any(|known| known.cells == row.cells));
        let _ = write!(text, "{before}{BEGIN}{title}: begin -->\n\n{}\n{END}", table(&shown));
        told.insert(name.to_owned());
        rest = after;
    }
    text.push_str(rest);
    let mut all = Vec::new();
    with_options("", &program, &mut all);
    for name in all {
        assert!(told.contains(&name), "docs/options.md has no table with the options of {name}");
    }
    if std::env::var_os("CORNICHE_BLESS").is_some() {
        fs::write(&page, &text).unwrap();
    }
    let stored = fs::read_to_string(&page).unwrap();
    assert!(stored == text, "docs/options.md is not up to date; write it with CORNICHE_BLESS=1");
}

#[test]
fn a_cell_has_what_comes_first() {
    let split = |help: &str| cells("--x", help);
    assert_eq!(split("Print it [default: no]; always"), ("Print it; always".into(), "no".into()));
    assert_eq!(split("One. Two [default: a|b]"), ("One".into(), "a\\|b".into()));
    let long = ["word"; 20].join(" ");
    let (told, _) = split(&format!("First part; {long}; and one more, which are too many words"));
    assert_eq!(told, format!("First part; {long}"));
    assert_eq!(marked("with --dem, or -O (--a.b)"), "with `--dem`, or `-O` (`--a`.b)");
}

/// Finds a command by its words; `corniche` is the program itself, whose options all commands have.
fn find<'a>(program: &'a Command, words: &str) -> &'a Command {
    words.split(' ').filter(|word| *word != "corniche").fold(program, |command, word| {
        command.find_subcommand(word).unwrap_or_else(|| panic!("there is no command {words}"))
    })
}

/// Collects the commands with options of their own.
fn with_options(words: &str, command: &Command, found: &mut Vec<String>) {
    if !rows(command).is_empty() {
        found.push(if words.is_empty() { "corniche".to_owned() } else { words.to_owned() });
    }
    for below in command.get_subcommands() {
        with_options(format!("{words} {}", below.get_name()).trim(), below, found);
    }
}

/// A line of a table.
struct Row {
    heading: String,
    cells: [String; 3],
}

/// The options of a command in the order of its help.
fn rows(command: &Command) -> Vec<Row> {
    let is_shown = |arg: &&Arg| !arg.is_positional() && !arg.is_hide_set();
    let mut options: Vec<&Arg> = command.get_arguments().filter(is_shown).collect();
    options.sort_by_key(|option| option.get_display_order());
    options.into_iter().map(row).collect()
}

fn row(option: &Arg) -> Row {
    let name = format!("--{}", option.get_long().expect("an option has a long name"));
    let short = option.get_short().map(|letter| format!("-{letter}, ")).unwrap_or_default();
    let takes_value = option.get_action().takes_values();
    let value = if takes_value { format!(" {}", value(option)) } else { String::new() };
    let help = option.get_help().map(ToString::to_string).unwrap_or_default();
    let (told, mut default) = cells(&name, &help);
    if takes_value && !option.get_default_values().is_empty() {
        let values = option.get_default_values().iter().map(|value| value.to_string_lossy());
        default = format!("`{}`", values.collect::<Vec<_>>().join(","));
    } else if option.is_required_set() {
        "must be given".clone_into(&mut default);
    }
    let cells = [format!("`{short}{name}{}`", value.replace('|', "\\|")), told, default];
    for cell in &cells {
        let words = cell.split_whitespace().count();
        assert!(words <= MOST_WORDS, "{name}: {words} words in a cell: {cell}");
    }
    Row { heading: option.get_help_heading().unwrap_or_default().to_owned(), cells }
}

/// The accepted values: the possible words, or the name of the value.
fn value(option: &Arg) -> String {
    let known: Vec<String> =
        option.get_possible_values().iter().map(|value| value.get_name().to_owned()).collect();
    let named = option.get_value_names().map(|names| names.join(" "));
    let one = if known.is_empty() {
        named.unwrap_or_else(|| option.get_id().as_str().to_uppercase())
    } else {
        known.join("|")
    };
    let is_list = option.get_num_args().is_some_and(|count| count.max_values() > 1);
    match (option.get_value_delimiter(), option.get_action()) {
        (Some(delimiter), _) if one != "LIST" => format!("{one}{delimiter}…"),
        (None, ArgAction::Append) if is_list => format!("{one}…"),
        _ => one,
    }
}

/// The beginning of a help text, in whole clauses with at most as many words as a cell may have,
/// and the default in it.
fn cells(name: &str, help: &str) -> (String, String) {
    let (text, default) = match help.split_once("[default: ") {
        Some((before, after)) => {
            let (default, after) = after.split_once(']').expect("a bracket ends");
            (format!("{}{after}", before.trim_end()), default)
        }
        None => (help.to_owned(), ""),
    };
    let sentence = text.split(". ").next().unwrap_or_default();
    let mut told = String::new();
    for clause in sentence.split("; ") {
        let longer = if told.is_empty() { clause.to_owned() } else { format!("{told}; {clause}") };
        if longer.split_whitespace().count() > MOST_WORDS {
            break;
        }
        told = longer;
    }
    assert!(
        !told.is_empty(),
        "{name}: more than {MOST_WORDS} words before the first pause: {sentence}"
    );
    (marked(&told), marked(default))
}

/// A text as Markdown, with names of options as code.
fn marked(text: &str) -> String {
    let text = text.replace('|', "\\|").replace('*', "\\*").replace('<', "&lt;");
    let word = |word: &str| {
        let begin = word.find(|letter: char| letter != '(').unwrap_or(0);
        let (open, rest) = word.split_at(begin);
        let is_option = rest.strip_prefix('-').is_some_and(|name| {
            name.trim_start_matches('-').starts_with(|letter: char| letter.is_ascii_alphabetic())
        });
        if !is_option {
            return word.to_owned();
        }
        let end = rest.find(|letter: char| letter != '-' && !letter.is_ascii_alphanumeric());
        let (option, close) = rest.split_at(end.unwrap_or(rest.len()));
        format!("{open}`{option}`{close}")
    };
    text.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

/// A table for each heading of the help.
fn table(rows: &[Row]) -> String {
    let mut headings: Vec<&str> = Vec::new();
    for row in rows {
        if !headings.contains(&row.heading.as_str()) {
            headings.push(&row.heading);
        }
    }
    let of_heading = |heading: &&str| {
        let mut text = String::new();
        if headings.len() > 1 && !heading.is_empty() {
            let _ = write!(text, "**{heading}**\n\n");
        }
        text.push_str("| option | what it does | default |\n|---|---|---|\n");
        for row in rows.iter().filter(|row| row.heading == **heading) {
            let [option, told, default] = &row.cells;
            let _ = writeln!(text, "| {option} | {told} | {default} |");
        }
        text
    };
    headings.iter().map(of_heading).collect::<Vec<_>>().join("\n")
}
