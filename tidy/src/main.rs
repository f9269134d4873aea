//! Prints for every crate its files by rank (users above the files that they use), its cycles, and
//! its size.
//!
//! `cargo run -p corniche-tidy [FOLDER OF A WORKSPACE]`
//! `cargo run -p corniche-tidy budget [--sink]`: prints the bytes of product code by crate with
//! their budget; `--sink` lowers the budget to them.
//! `cargo run -p corniche-tidy page`: prints the hash of the sources of the page in the program.

use std::{
    collections::BTreeSet,
    env,
    fmt::Write as _,
    fs,
    io::{self, Write as _},
    path::{Path, PathBuf},
};

use anyhow::{Context as _, Result};
use corniche_tidy::{
    BUDGET, Bytes, CrateFigures, Graph, crates_of, figures, over_budget, page_sources,
    product_bytes, read_budget, read_crate, root, sunk, uses,
};

/// The number of longest functions and files that are listed.
const LONGEST: usize = 12;

fn main() -> Result<()> {
    let mut arguments = env::args().skip(1);
    let mut text = String::new();
    let first = arguments.next();
    if first.as_deref() == Some("budget") {
        show_budget(arguments.next().as_deref() == Some("--sink"), &mut text)?;
        io::stdout().write_all(text.as_bytes())?;
        return Ok(());
    }
    if first.as_deref() == Some("page") {
        writeln!(io::stdout(), "{}", page_sources(&root())?)?;
        return Ok(());
    }
    let root = first.map_or_else(|| PathBuf::from("."), PathBuf::from);
    let mut all = Vec::new();
    for folder in crates_of(&root)? {
        let name = show_graph(&folder, &mut text)?;
        all.push((name, figures(&folder)?));
    }
    for extra in ["tests", "fuzz", "tidy"] {
        if root.join(extra).join("Cargo.toml").is_file() {
            all.push((extra.to_owned(), figures(&root.join(extra))?));
        }
    }
    show_figures(&all, &mut text)?;
    io::stdout().write_all(text.as_bytes())?;
    Ok(())
}

fn show_budget(is_to_sink: bool, text: &mut String) -> Result<()> {
    let path = root().join(BUDGET);
    let read = || -> Result<Bytes> {
        read_budget(&fs::read_to_string(&path).with_context(|| format!("cannot read {BUDGET}"))?)
    };
    let found = product_bytes(&root())?;
    if is_to_sink {
        fs::write(&path, sunk(&read()?, &found)?)
            .with_context(|| format!("cannot write {BUDGET}"))?;
    }
    let budget = read()?;
    let names: BTreeSet<_> = found.keys().chain(budget.keys()).collect();
    for name in names {
        let [bytes, row] = [&found, &budget].map(|of| of.get(name).copied().unwrap_or_default());
        writeln!(text, "{name:12} {bytes:9} of {row:9}")?;
    }
    let [bytes, row] = [&found, &budget].map(|of| of.values().sum::<u64>());
    writeln!(text, "{:12} {bytes:9} of {row:9}", "all")?;
    for wrong in over_budget(&budget, &found) {
        writeln!(text, "{wrong}")?;
    }
    Ok(())
}

fn show_graph(folder: &Path, text: &mut String) -> Result<String> {
    let read = read_crate(folder)?;
    let found = uses(&read);
    let files = Graph::of_files(&read, &found);
    writeln!(text, "# {}", read.name)?;
    for rank in files.ranks() {
        writeln!(text, "  {}", rank.join("  "))?;
    }
    let children = Graph::of_children(&read, &found);
    for cycle in files.cycles().into_iter().chain(children.iter().flat_map(Graph::cycles)) {
        writeln!(text, "cycle in {cycle}")?;
    }
    writeln!(text)?;
    Ok(read.name)
}

fn show_figures(all: &[(String, CrateFigures)], text: &mut String) -> Result<()> {
    writeln!(
        text,
        "| crate | product | test | comment | public items | longest file | longest function |"
    )?;
    writeln!(text, "|---|---|---|---|---|---|---|")?;
    for (name, figures) in all {
        let file = figures.files.iter().map(|(_, lines)| lines).max().unwrap_or(&0);
        let function = figures.functions.iter().map(|function| function.lines).max().unwrap_or(0);
        let CrateFigures { product_lines, test_lines, comment_lines, public_items, .. } = figures;
        writeln!(
            text,
            "| {name} | {product_lines} | {test_lines} | {comment_lines} | {public_items} | {file} | {function} |"
        )?;
    }
    let sum =
        |of: fn(&CrateFigures) -> usize| all.iter().map(|(_, figures)| of(figures)).sum::<usize>();
    writeln!(
        text,
        "| all | {} | {} | {} | {} | | |",
        sum(|figures| figures.product_lines),
        sum(|figures| figures.test_lines),
        sum(|figures| figures.comment_lines),
        sum(|figures| figures.public_items),
    )?;

    let mut functions: Vec<_> = all
        .iter()
        .flat_map(|(name, figures)| figures.functions.iter().map(move |function| (name, function)))
        .collect();
    functions.sort_by_key(|(_, function)| std::cmp::Reverse(function.lines));
    writeln!(text, "\nlongest functions:")?;
    for (name, function) in functions.iter().take(LONGEST) {
        writeln!(
            text,
            "  {:4} {name}/{} {}",
            function.lines,
            function.file.display(),
            function.name
        )?;
    }
    let mut files: Vec<_> = all
        .iter()
        .flat_map(|(name, figures)| figures.files.iter().map(move |file| (name, file)))
        .collect();
    files.sort_by_key(|(_, (_, lines))| std::cmp::Reverse(*lines));
    writeln!(text, "longest files:")?;
    for (name, (file, lines)) in files.iter().take(LONGEST) {
        writeln!(text, "  {lines:4} {name}/{}", file.display())?;
    }
    Ok(())
}
