//! Which crates start threads, use `unsafe` or open files: each such crate is in a list here, with
//! its reason.
//!
//! The tests find paths in the syntax tree, resolved through the file's own imports; comments,
//! texts and test code do not count. A method of a value whose type is not named is not found,
//! except for those methods of GDAL's drivers that create files.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    sync::LazyLock,
};

use corniche_tidy::{attributes_of, crates_of, is_test, read_crate, root};
use proc_macro2::{TokenStream, TokenTree};
use syn::{ImplItem, Item, Stmt, UseTree, visit::Visit};

/// Crates that start threads, or work in the threads of a pool.
const THREADS: [(&str, &str); 9] = [
    (
        "cli",
        "signals, the end of standard input, progress without updates, a flight that is shown in a window",
    ),
    ("live", "tiles are loaded while another thread draws"),
    ("objects", "the runtime of the library for object storage"),
    ("osm", "blobs are decoded in the caller's pool"),
    ("pieces", "the pool in which extracts are decoded and their objects split"),
    ("remote", "a thread that waits for the network"),
    ("serve", "simultaneous connections"),
    ("window", "files are written while the window draws"),
    ("work", "parallel work on tiles and roads, and the thread that writes the results"),
];

/// Crates with `unsafe` code.
const UNSAFE: [(&str, &str); 2] = [
    ("cli", "a call of the C library that returns free memory to the system"),
    ("gis", "functions of GDAL and PROJ that the `gdal` crate does not wrap"),
];

/// Crates that open files.
const FILES: [(&str, &str); 11] = [
    ("cli", "settings, styles, lists, pages and everything that commands write"),
    ("export", "the files that it writes, and scratch space"),
    ("gis", "rasters, polygons, vector files, lists of files"),
    ("objects", "the file that is uploaded, and the record of an unfinished upload"),
    ("osm", "extracts"),
    ("overlay", "the file of lines that a person draws"),
    ("spec", "hashes of inputs, the system's memory limits"),
    ("store", "the store's own files, and files next to targets"),
    ("tileset", "packages"),
    ("verify", "a folder for intermediate results"),
    ("window", "pictures and flights that a person saves"),
];

/// Files that write to the terminal, or query its type.
const PRINTERS: [(&str, &str); 3] = [
    ("crates/cli/src/main.rs", "help and messages of the command-line parser, in colour"),
    ("crates/cli/src/messages.rs", "answers, notes, warnings and errors"),
    ("crates/cli/src/progress.rs", "progress bars with fixed texts"),
];

/// Actions that only some crates may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Deed {
    StartsThreads,
    IsUnsafe,
    OpensFiles,
    Prints,
}

/// Methods of GDAL's drivers that create a file.
const DRIVER_METHODS: [&str; 4] = [
    "create_copy",
    "create_vector_only",
    "create_with_band_type",
    "create_with_band_type_with_options",
];

/// Functions of `std::fs` that open a file.
const FS_FUNCTIONS: [&str; 4] = ["copy", "read", "read_to_string", "write"];
/// Functions of `std::fs::File` that open a file.
const FILE_FUNCTIONS: [&str; 4] = ["create", "create_new", "open", "options"];

/// The action of a path given from its root, such as `std::thread::spawn`.
#[expect(clippy::match_same_arms, reason = "a row for each library")]
fn deed_of(path: &[&str]) -> Option<Deed> {
    match path {
        ["std", "thread", "spawn" | "scope" | "Builder", ..]
        | ["tokio", "runtime" | "spawn" | "task", ..] => Some(Deed::StartsThreads),
        ["rayon", "ThreadPool"] => None,
        ["rayon", ..] => Some(Deed::StartsThreads),
        ["std" | "tokio", "fs", "OpenOptions", ..] | ["tempfile", ..] => Some(Deed::OpensFiles),
        ["std" | "tokio", "fs", "File", function, ..] if FILE_FUNCTIONS.contains(function) => {
            Some(Deed::OpensFiles)
        }
        ["std" | "tokio", "fs", function] if FS_FUNCTIONS.contains(function) => {
            Some(Deed::OpensFiles)
        }
        ["rustix", "fs", "open" | "openat"]
        | ["gdal", "Dataset", "open" | "open_ex"]
        | ["gdal_sys", "VSIFOpenL"] => Some(Deed::OpensFiles),
        ["std", "io", "stdout" | "stderr" | "Stdout" | "Stderr", ..] | ["indicatif", ..] => {
            Some(Deed::Prints)
        }
        _ => None,
    }
}

/// The actions in the code of a file, outside tests.
#[derive(Default)]
struct Finder {
    imports: BTreeMap<String, Vec<String>>,
    uses_gdal: bool,
    found: BTreeSet<Deed>,
}

impl Finder {
    /// Reads a file's text.
    fn deeds(text: &str) -> BTreeSet<Deed> {
        let file = syn::parse_file(text).expect("it is Rust");
        let mut imports = Imports::default();
        imports.visit_file(&file);
        let uses_gdal =
            imports.found.values().any(|path| path.first().is_some_and(|first| first == "gdal"));
        let mut finder = Self { imports: imports.found, uses_gdal, found: BTreeSet::new() };
        finder.visit_file(&file);
        finder.found
    }

    /// Adds a path as the code names it.
    fn take(&mut self, named: &[String]) {
        let Some((first, rest)) = named.split_first() else { return };
        let whole: Vec<&str> = match self.imports.get(first) {
            Some(path) => path.iter().chain(rest).map(String::as_str).collect(),
            None => named.iter().map(String::as_str).collect(),
        };
        self.found.extend(deed_of(&whole));
    }

    /// Searches the tokens of a macro for paths and for `unsafe`.
    fn take_tokens(&mut self, tokens: TokenStream) {
        let mut path: Vec<String> = Vec::new();
        let mut colons = 0;
        for token in tokens {
            match token {
                TokenTree::Ident(ident) => {
                    if ident == "unsafe" {
                        self.found.insert(Deed::IsUnsafe);
                    }
                    if colons != 2 {
                        self.take(&path);
                        path.clear();
                    }
                    path.push(ident.to_string());
                    colons = 0;
                }
                TokenTree::Punct(punct) if punct.as_char() == ':' => colons += 1,
                other => {
                    self.take(&path);
                    path.clear();
                    colons = 0;
                    if let TokenTree::Group(group) = other {
                        self.take_tokens(group.stream());
                    }
                }
            }
        }
        self.take(&path);
    }
}

impl<'ast> Visit<'ast> for Finder {
    fn visit_item(&mut self, item: &'ast Item) {
        if !is_test(attributes_of(item)) {
            syn::visit::visit_item(self, item);
        }
    }

    fn visit_impl_item(&mut self, item: &'ast ImplItem) {
        let is_test = matches!(item, ImplItem::Fn(function) if is_test(&function.attrs));
        if !is_test {
            syn::visit::visit_impl_item(self, item);
        }
    }

    fn visit_stmt(&mut self, statement: &'ast Stmt) {
        let is_test = matches!(statement, Stmt::Local(local) if is_test(&local.attrs));
        if !is_test {
            syn::visit::visit_stmt(self, statement);
        }
    }

    fn visit_item_use(&mut self, import: &'ast syn::ItemUse) {
        let mut leaves = Vec::new();
        flatten(&import.tree, &mut Vec::new(), &mut leaves);
        for (_, path) in leaves {
            self.found.extend(deed_of(&path.iter().map(String::as_str).collect::<Vec<_>>()));
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let named: Vec<String> =
            path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        self.take(&named);
        syn::visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, invocation: &'ast syn::Macro) {
        self.take_tokens(invocation.tokens.clone());
    }

    fn visit_expr_method_call(&mut self, call: &'ast syn::ExprMethodCall) {
        // A method of the command-line parser.
        if call.method == "print" && call.args.is_empty() {
            self.found.insert(Deed::Prints);
        }
        if self.uses_gdal && DRIVER_METHODS.iter().any(|name| call.method == name) {
            self.found.insert(Deed::OpensFiles);
        }
        syn::visit::visit_expr_method_call(self, call);
    }

    fn visit_expr_unsafe(&mut self, block: &'ast syn::ExprUnsafe) {
        self.found.insert(Deed::IsUnsafe);
        syn::visit::visit_expr_unsafe(self, block);
    }

    fn visit_signature(&mut self, signature: &'ast syn::Signature) {
        self.found.extend(signature.unsafety.map(|_| Deed::IsUnsafe));
        syn::visit::visit_signature(self, signature);
    }

    fn visit_item_impl(&mut self, block: &'ast syn::ItemImpl) {
        self.found.extend(block.unsafety.map(|_| Deed::IsUnsafe));
        syn::visit::visit_item_impl(self, block);
    }

    fn visit_item_trait(&mut self, item: &'ast syn::ItemTrait) {
        self.found.extend(item.unsafety.map(|_| Deed::IsUnsafe));
        syn::visit::visit_item_trait(self, item);
    }

    fn visit_item_foreign_mod(&mut self, block: &'ast syn::ItemForeignMod) {
        // The blocks of `wasm-bindgen` are not marked: it generates safe functions from them.
        self.found.extend(block.unsafety.map(|_| Deed::IsUnsafe));
        syn::visit::visit_item_foreign_mod(self, block);
    }
}

/// All imports of a file outside tests: the name that each introduces, and its path.
#[derive(Default)]
struct Imports {
    found: BTreeMap<String, Vec<String>>,
}

impl<'ast> Visit<'ast> for Imports {
    fn visit_item(&mut self, item: &'ast Item) {
        if !is_test(attributes_of(item)) {
            syn::visit::visit_item(self, item);
        }
    }

    fn visit_item_use(&mut self, import: &'ast syn::ItemUse) {
        let mut leaves = Vec::new();
        flatten(&import.tree, &mut Vec::new(), &mut leaves);
        self.found.extend(leaves.into_iter().filter_map(|(name, path)| Some((name?, path))));
    }
}

/// The leaves of a `use` declaration: the name that each introduces, `None` for `*`, and its path.
fn flatten(
    tree: &UseTree,
    prefix: &mut Vec<String>,
    into: &mut Vec<(Option<String>, Vec<String>)>,
) {
    let with = |prefix: &[String], leaf: &syn::Ident| {
        let mut path = prefix.to_vec();
        if leaf != "self" {
            path.push(leaf.to_string());
        }
        path
    };
    match tree {
        UseTree::Path(path) => {
            prefix.push(path.ident.to_string());
            flatten(&path.tree, prefix, into);
            prefix.pop();
        }
        UseTree::Group(group) => {
            for tree in &group.items {
                flatten(tree, prefix, into);
            }
        }
        UseTree::Glob(_) => into.push((None, prefix.clone())),
        UseTree::Name(leaf) => {
            let path = with(prefix, &leaf.ident);
            into.push((path.last().cloned(), path));
        }
        UseTree::Rename(leaf) => {
            into.push((Some(leaf.rename.to_string()), with(prefix, &leaf.ident)));
        }
    }
}

/// The actions of each crate of the workspace in its own code, with the files concerned, relative
/// to the workspace's root.
static DEEDS: LazyLock<BTreeMap<(Deed, String), BTreeSet<String>>> = LazyLock::new(deeds_of_crates);

/// Reads all crates but `testing`, which only serves tests.
fn deeds_of_crates() -> BTreeMap<(Deed, String), BTreeSet<String>> {
    let mut found: BTreeMap<_, BTreeSet<String>> = BTreeMap::new();
    let root = root();
    for folder in crates_of(&root).unwrap() {
        let read = read_crate(&folder).unwrap();
        if read.name == "testing" {
            continue;
        }
        let files: BTreeSet<_> = read.modules.iter().map(|module| &module.file).collect();
        for file in files {
            let path = folder.join("src").join(file);
            let text = fs::read_to_string(&path).unwrap();
            for deed in Finder::deeds(&text) {
                let name = path.strip_prefix(&root).unwrap_or(&path).display().to_string();
                found.entry((deed, read.name.clone())).or_default().insert(name);
            }
        }
    }
    found
}

/// Compares the actions of crates with a list of the crates that may take them.
fn check(deed: Deed, allowed: &[(&str, &str)], list: &str) {
    let doers = DEEDS.iter().filter(|((what, _), _)| *what == deed);
    for ((_, name), files) in doers {
        let is_listed = allowed.iter().any(|(listed, _)| listed == name);
        assert!(
            is_listed,
            "{name} {deed:?} in {files:?}: do it elsewhere, or add it to {list} with a reason"
        );
    }
    for (name, reason) in allowed {
        assert!(!reason.is_empty(), "{name} has no reason in {list}");
        let does = DEEDS.contains_key(&(deed, (*name).to_owned()));
        assert!(does, "{name} is in {list} but no longer {deed:?}");
    }
}

#[test]
fn crates_that_start_threads_are_listed() {
    check(Deed::StartsThreads, &THREADS, "THREADS");
}

#[test]
fn crates_with_unsafe_code_are_listed() {
    check(Deed::IsUnsafe, &UNSAFE, "UNSAFE");
}

#[test]
fn crates_that_open_files_are_listed() {
    check(Deed::OpensFiles, &FILES, "FILES");
}

/// Foreign text is escaped in one module, so no other module writes to the terminal.
#[test]
fn one_module_prints_and_others_that_write_to_the_terminal_are_listed() {
    let printing = DEEDS.iter().filter(|((deed, _), _)| *deed == Deed::Prints);
    let found: BTreeSet<&str> = printing.flat_map(|(_, files)| files).map(String::as_str).collect();
    assert_eq!(found, PRINTERS.iter().map(|(file, _)| *file).collect());
    assert!(PRINTERS.iter().all(|(_, reason)| !reason.is_empty()));
}

/// Every form of an action is found, with any imports.
#[test]
fn what_is_planted_is_found() {
    let planted = [
        ("fn f() { std::thread::spawn(|| ()); }", Deed::StartsThreads),
        ("use std::thread; fn f() { thread::scope(|_| ()); }", Deed::StartsThreads),
        ("use std::thread::{self as t}; fn f() { t::Builder::new(); }", Deed::StartsThreads),
        ("use rayon::prelude::*;", Deed::StartsThreads),
        ("fn f() { rayon::ThreadPoolBuilder::new(); }", Deed::StartsThreads),
        ("use tokio::{runtime::Builder, time}; fn f() {}", Deed::StartsThreads),
        ("fn f() { g(tokio::spawn) }", Deed::StartsThreads),
        ("fn f() { unsafe { g() } }", Deed::IsUnsafe),
        ("unsafe fn f() {}", Deed::IsUnsafe),
        ("struct S; unsafe impl Send for S {}", Deed::IsUnsafe),
        ("unsafe extern \"C\" { fn f(); }", Deed::IsUnsafe),
        ("impl S { fn f() { assert!(unsafe { g() }); } }", Deed::IsUnsafe),
        ("use std::fs::File; fn f() { File::open(path); }", Deed::OpensFiles),
        ("use std::{fs, io}; fn f() { paths.map(fs::read); }", Deed::OpensFiles),
        ("use std::fs::read_to_string as text; fn f() { text(path); }", Deed::OpensFiles),
        ("fn f() { println!(\"{}\", std::fs::read(path).len()); }", Deed::OpensFiles),
        ("fn f() { std::fs::OpenOptions::new(); }", Deed::OpensFiles),
        ("use tempfile::NamedTempFile; struct S(NamedTempFile);", Deed::OpensFiles),
        ("use gdal::Dataset; fn f() { Dataset::open(path); }", Deed::OpensFiles),
        ("use gdal::Driver; fn f(d: Driver) { d.create_vector_only(p); }", Deed::OpensFiles),
        ("use std::io; fn f() { writeln!(io::stderr(), \"a\"); }", Deed::Prints),
        ("fn f(error: clap::Error) { error.print(); }", Deed::Prints),
    ];
    for (text, deed) in planted {
        assert_eq!(Finder::deeds(text), BTreeSet::from([deed]), "{text}");
    }
}

/// Comments, texts, tests and names that are merely similar are not found.
#[test]
fn what_only_looks_like_it_is_not_found() {
    let harmless = [
        "/// unsafe: `std::thread::spawn`\nfn f() {} // std::fs::read",
        "const TEXT: &str = \"unsafe std::fs::read(path)\";",
        "#[cfg(test)] mod tests { fn f() { std::thread::spawn(|| ()); } }",
        "#[test] fn f() { std::fs::read(path); }",
        "impl S { #[cfg(test)] fn f() { unsafe { g() } } }",
        "use std::{fs, thread}; fn f() { fs::metadata(path); thread::sleep(time); }",
        "use crate::{File, OpenOptions}; fn f() { File::open(path); OpenOptions::default(); }",
        "fn f(pool: &rayon::ThreadPool) { pool.install(g); }",
        "fn f() { maker.create_copy(); }",
    ];
    for text in harmless {
        assert_eq!(Finder::deeds(text), BTreeSet::new(), "{text}");
    }
}
