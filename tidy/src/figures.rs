//! Sizes of crates: lines, functions, public items.

use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result};
use syn::{ImplItem, Item, TraitItem, Visibility, spanned::Spanned, visit::Visit};

use crate::{
    files::files_below,
    source::{attributes_of, is_test, is_test_file},
};

/// The figures of a crate. A line is counted once: as comment, as test or as product; empty lines
/// are not counted.
#[derive(Debug, Default, Clone, PartialEq, Eq)]
pub struct CrateFigures {
    /// Lines of Rust that are neither test nor comment.
    pub product_lines: usize,
    /// Lines of tests, benches and examples.
    pub test_lines: usize,
    /// Lines with only a comment, in products and tests.
    pub comment_lines: usize,
    /// Functions, types, traits, constants and methods that are `pub`. Lints forbid `pub` for items
    /// that cannot be reached.
    pub public_items: usize,
    /// Every product file with all its lines.
    pub files: Vec<(PathBuf, usize)>,
    /// Every product function.
    pub functions: Vec<Function>,
}

/// A function and its length.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Function {
    /// The path of its file, relative to the crate's folder.
    pub file: PathBuf,
    /// Its name.
    pub name: String,
    /// Lines from its first to its last, signature included.
    pub lines: usize,
}

/// Counts the crate in `folder`: `src`, `tests`, `benches` and `examples`.
///
/// # Errors
/// When a file cannot be read or is not valid Rust.
pub fn figures(folder: &Path) -> Result<CrateFigures> {
    let mut figures = CrateFigures::default();
    for part in ["src", "tests", "benches", "examples", "fuzz_targets"] {
        for file in files_below(&folder.join(part), "rs")? {
            let text = fs::read_to_string(&file)
                .with_context(|| format!("cannot read {}", file.display()))?;
            let parsed = syn::parse_file(&text)
                .with_context(|| format!("{} is not valid Rust", file.display()))?;
            let inside = file.strip_prefix(folder).unwrap_or(&file);
            let tests = if part == "src" && !is_test_file(inside) {
                figures.files.push((inside.to_owned(), text.lines().count()));
                let mut product =
                    Product { file: inside, tests: Vec::new(), figures: &mut figures };
                product.visit_file(&parsed);
                product.tests
            } else {
                vec![[1, usize::MAX]]
            };
            figures.count(&text, &tests);
        }
    }
    Ok(figures)
}

/// First and last lines, from 1, of the tests in a product file.
pub(crate) fn test_lines(parsed: &syn::File) -> Vec<[usize; 2]> {
    let mut figures = CrateFigures::default();
    let mut product = Product { file: Path::new(""), tests: Vec::new(), figures: &mut figures };
    product.visit_file(parsed);
    product.tests
}

impl CrateFigures {
    /// Counts the lines of one file, of which `tests` (first and last line, from 1) are tests.
    fn count(&mut self, text: &str, tests: &[[usize; 2]]) {
        for (number, line) in (1..).zip(text.lines().map(str::trim)) {
            if line.is_empty() {
                continue;
            }
            let is_test = tests.iter().any(|&[first, last]| (first..=last).contains(&number));
            if line.starts_with("//") {
                self.comment_lines += 1;
            } else if is_test {
                self.test_lines += 1;
            } else {
                self.product_lines += 1;
            }
        }
    }
}

/// Walks through a product file.
struct Product<'a> {
    file: &'a Path,
    tests: Vec<[usize; 2]>,
    figures: &'a mut CrateFigures,
}

impl Product<'_> {
    fn function(&mut self, name: &syn::Ident, span: proc_macro2::Span) {
        let lines = span.end().line + 1 - span.start().line;
        let function = Function { file: self.file.to_owned(), name: name.to_string(), lines };
        self.figures.functions.push(function);
    }

    fn public(&mut self, visibility: &Visibility) {
        self.figures.public_items += usize::from(matches!(visibility, Visibility::Public(_)));
    }
}

impl<'ast> Visit<'ast> for Product<'_> {
    fn visit_item(&mut self, item: &'ast Item) {
        if is_test(attributes_of(item)) {
            let span = item.span();
            self.tests.push([span.start().line, span.end().line]);
            return;
        }
        match item {
            Item::Const(item) => self.public(&item.vis),
            Item::Enum(item) => self.public(&item.vis),
            Item::Fn(item) => {
                self.public(&item.vis);
                self.function(&item.sig.ident, body(&item.sig, &item.block));
            }
            Item::Static(item) => self.public(&item.vis),
            Item::Struct(item) => self.public(&item.vis),
            Item::Trait(item) => self.public(&item.vis),
            Item::Type(item) => self.public(&item.vis),
            _ => {}
        }
        syn::visit::visit_item(self, item);
    }

    fn visit_impl_item(&mut self, item: &'ast ImplItem) {
        match item {
            ImplItem::Const(item) => self.public(&item.vis),
            ImplItem::Fn(item) if is_test(&item.attrs) => {
                let span = item.span();
                self.tests.push([span.start().line, span.end().line]);
                return;
            }
            ImplItem::Fn(item) => {
                self.public(&item.vis);
                self.function(&item.sig.ident, body(&item.sig, &item.block));
            }
            _ => {}
        }
        syn::visit::visit_impl_item(self, item);
    }

    fn visit_trait_item(&mut self, item: &'ast TraitItem) {
        if let TraitItem::Fn(item) = item
            && let Some(block) = &item.default
        {
            self.function(&item.sig.ident, body(&item.sig, block));
        }
        syn::visit::visit_trait_item(self, item);
    }
}

/// The function from the signature to the closing brace, without docs and attributes.
fn body(signature: &syn::Signature, block: &syn::Block) -> proc_macro2::Span {
    signature.span().join(block.span()).unwrap_or_else(|| block.span())
}
