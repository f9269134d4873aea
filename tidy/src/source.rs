//! A crate's source as modules: the names that each module defines and imports, and every path in
//! its code.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result};
use proc_macro2::{TokenStream, TokenTree};
use syn::{
    Attribute, Expr, Item, Token, UseTree, Visibility, parse::Parser, punctuated::Punctuated,
    visit::Visit,
};

/// A crate of the workspace whose source was read.
#[derive(Debug)]
pub struct Crate {
    /// The name of its folder.
    pub name: String,
    /// The path of its folder.
    pub folder: PathBuf,
    /// Its modules, the root first. A module inside another module's file has that file.
    pub modules: Vec<Module>,
}

/// A module that is not a test.
#[derive(Debug, Default)]
pub struct Module {
    /// Its path from the crate's root; empty for the root.
    pub path: Vec<String>,
    /// The path of its file, relative to the crate's `src`.
    pub file: PathBuf,
    /// Index of the module that declares it.
    pub parent: Option<usize>,
    /// Names of its child modules, with their index.
    pub children: BTreeMap<String, usize>,
    /// Names that it defines itself.
    pub items: Vec<String>,
    /// Names that it imports or re-exports.
    pub imports: Vec<Import>,
    /// Paths that its code names, each as its segments.
    pub paths: Vec<Vec<String>>,
}

/// A leaf of a `use` declaration.
#[derive(Debug, Clone)]
pub struct Import {
    /// The name that it introduces; `None` for `*`.
    pub name: Option<String>,
    /// The path that is imported.
    pub path: Vec<String>,
    /// Whether it is a re-export.
    pub is_public: bool,
}

/// The folders of the crates of a workspace, by name.
///
/// # Errors
/// When `root` has no folder `crates` that can be read.
pub fn crates_of(root: &Path) -> Result<Vec<PathBuf>> {
    let crates = root.join("crates");
    let mut folders = Vec::new();
    for entry in
        fs::read_dir(&crates).with_context(|| format!("cannot list {}", crates.display()))?
    {
        let folder = entry?.path();
        if folder.join("Cargo.toml").is_file() {
            folders.push(folder);
        }
    }
    folders.sort();
    Ok(folders)
}

/// Reads the modules of the crate in `folder`, starting at its `lib.rs` or `main.rs`.
///
/// # Errors
/// When a file cannot be read or is not valid Rust, or a module has no file.
pub fn read_crate(folder: &Path) -> Result<Crate> {
    let src = folder.join("src");
    let root = ["lib.rs", "main.rs"]
        .into_iter()
        .find(|name| src.join(name).is_file())
        .with_context(|| format!("{} has no lib.rs and no main.rs", src.display()))?;
    let mut reader = Reader { src, modules: Vec::new() };
    reader.read_file(PathBuf::from(root), Vec::new(), None)?;
    let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Crate { name, folder: folder.to_owned(), modules: reader.modules })
}

/// Whether an item with these attributes is for tests only.
#[must_use]
pub fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("test")
            || attribute.path().is_ident("cfg")
                && attribute.parse_args::<syn::Path>().is_ok_and(|path| path.is_ident("test"))
    })
}

struct Reader {
    src: PathBuf,
    modules: Vec<Module>,
}

impl Reader {
    fn read_file(
        &mut self,
        file: PathBuf,
        path: Vec<String>,
        parent: Option<usize>,
    ) -> Result<usize> {
        let on_disk = self.src.join(&file);
        let text = fs::read_to_string(&on_disk)
            .with_context(|| format!("cannot read {}", on_disk.display()))?;
        let parsed = syn::parse_file(&text)
            .with_context(|| format!("{} is not valid Rust", on_disk.display()))?;
        self.read_items(&parsed.items, file, path, parent)
    }

    fn read_items(
        &mut self,
        items: &[Item],
        file: PathBuf,
        path: Vec<String>,
        parent: Option<usize>,
    ) -> Result<usize> {
        let index = self.modules.len();
        self.modules.push(Module { path, file, parent, ..Module::default() });
        for item in items {
            if is_test(attributes_of(item)) {
                continue;
            }
            match item {
                Item::Mod(child) => self.read_module(child, index)?,
                Item::Use(import) => {
                    let is_public = !matches!(import.vis, Visibility::Inherited);
                    let imports = &mut self.modules[index].imports;
                    flatten(&import.tree, &mut Vec::new(), is_public, imports);
                }
                _ => {
                    let module = &mut self.modules[index];
                    module.items.extend(names_of(item));
                    Paths { found: &mut module.paths }.visit_item(item);
                }
            }
        }
        Ok(index)
    }

    fn read_module(&mut self, item: &syn::ItemMod, parent: usize) -> Result<()> {
        let name = item.ident.to_string();
        let mut path = self.modules[parent].path.clone();
        path.push(name.clone());
        let child = if let Some((_, items)) = &item.content {
            self.read_items(items, self.modules[parent].file.clone(), path, Some(parent))?
        } else {
            let file = self.file_of(item, parent)?;
            self.read_file(file, path, Some(parent))?
        };
        self.modules[parent].children.insert(name, child);
        Ok(())
    }

    /// The path of the file of `mod name;`: given by `#[path]`, or next to or below the file of its
    /// parent.
    fn file_of(&self, item: &syn::ItemMod, parent: usize) -> Result<PathBuf> {
        let parent = &self.modules[parent];
        let beside = parent.file.parent().unwrap_or(Path::new(""));
        if let Some(path) = path_attribute(&item.attrs) {
            return Ok(beside.join(path));
        }
        let folder: PathBuf = parent.path.iter().collect();
        let name = item.ident.to_string();
        [folder.join(format!("{name}.rs")), folder.join(&name).join("mod.rs")]
            .into_iter()
            .find(|file| self.src.join(file).is_file())
            .with_context(|| format!("no file for module {name} of {}", parent.file.display()))
    }
}

fn path_attribute(attributes: &[Attribute]) -> Option<String> {
    attributes.iter().find_map(|attribute| match &attribute.meta {
        syn::Meta::NameValue(pair) if pair.path.is_ident("path") => match &pair.value {
            Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) => Some(text.value()),
            _ => None,
        },
        _ => None,
    })
}

fn flatten(tree: &UseTree, prefix: &mut Vec<String>, is_public: bool, into: &mut Vec<Import>) {
    match tree {
        UseTree::Path(path) => {
            prefix.push(path.ident.to_string());
            flatten(&path.tree, prefix, is_public, into);
            prefix.pop();
        }
        UseTree::Group(group) => {
            for tree in &group.items {
                flatten(tree, prefix, is_public, into);
            }
        }
        UseTree::Glob(_) => into.push(Import { name: None, path: prefix.clone(), is_public }),
        UseTree::Name(leaf) => {
            into.push(import(&leaf.ident, None, prefix, is_public));
        }
        UseTree::Rename(leaf) => {
            into.push(import(&leaf.ident, Some(&leaf.rename), prefix, is_public));
        }
    }
}

fn import(
    leaf: &syn::Ident,
    rename: Option<&syn::Ident>,
    prefix: &[String],
    is_public: bool,
) -> Import {
    let mut path = prefix.to_vec();
    // `use a::{self}` imports `a`.
    if leaf != "self" {
        path.push(leaf.to_string());
    }
    let name = rename.map(ToString::to_string).or_else(|| path.last().cloned());
    Import { name, path, is_public }
}

/// The names that an item defines in its module.
fn names_of(item: &Item) -> Vec<String> {
    let name = match item {
        Item::Const(item) => &item.ident,
        Item::Enum(item) => &item.ident,
        Item::Fn(item) => &item.sig.ident,
        Item::Macro(item) => return names_of_macro(item),
        Item::Static(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::Type(item) => &item.ident,
        Item::Union(item) => &item.ident,
        _ => return Vec::new(),
    };
    vec![name.to_string()]
}

/// The names that a macro defines: its own name, and the names after `enum`, `struct` or `trait` in
/// its text. A macro that defines types is assumed to be called in the file that defines it.
fn names_of_macro(item: &syn::ItemMacro) -> Vec<String> {
    let mut names: Vec<String> = item.ident.iter().map(ToString::to_string).collect();
    gather_definitions(item.mac.tokens.clone(), &mut names);
    names
}

fn gather_definitions(tokens: TokenStream, into: &mut Vec<String>) {
    let mut is_definition = false;
    for token in tokens {
        match token {
            TokenTree::Ident(ident) => {
                if is_definition {
                    into.push(ident.to_string());
                }
                is_definition = ["enum", "struct", "trait"].iter().any(|keyword| ident == keyword);
                continue;
            }
            TokenTree::Group(group) => gather_definitions(group.stream(), into),
            _ => {}
        }
        is_definition = false;
    }
}

/// The attributes of an item; empty for items that contain no code.
#[must_use]
pub fn attributes_of(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// Collects every path in an item, including those in the arguments of macros such as `format!`.
struct Paths<'a> {
    found: &'a mut Vec<Vec<String>>,
}

impl<'ast> Visit<'ast> for Paths<'_> {
    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.found.push(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        syn::visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, invocation: &'ast syn::Macro) {
        syn::visit::visit_macro(self, invocation);
        let arguments = Punctuated::<Expr, Token![,]>::parse_terminated;
        if let Ok(arguments) = arguments.parse2(invocation.tokens.clone()) {
            for argument in &arguments {
                Paths { found: self.found }.visit_expr(argument);
            }
        }
    }

    fn visit_item_use(&mut self, import: &'ast syn::ItemUse) {
        // Names that imports inside a function introduce are used there.
        let mut imports = Vec::new();
        flatten(&import.tree, &mut Vec::new(), false, &mut imports);
        self.found.extend(imports.into_iter().map(|import| import.path));
    }
}

/// Whether a file in `src` contains only tests: `NAME_tests.rs`, or a file in the folder of such a
/// file.
pub(crate) fn is_test_file(file: &Path) -> bool {
    let is_tests = |name: &std::ffi::OsStr| {
        let name = name.to_string_lossy();
        let stem = name.strip_suffix(".rs").unwrap_or(&name);
        stem == "tests" || stem.ends_with("_tests")
    };
    file.iter().any(is_tests)
}
