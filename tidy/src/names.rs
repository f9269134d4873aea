//! The names of types, and the signatures of functions, in product code.

use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result};
use syn::{FnArg, GenericArgument, Item, PathArguments, Type, Visibility, visit::Visit};

use crate::{
    files::files_below,
    source::{attributes_of, crates_of, is_test, is_test_file},
};

/// A type or a function as it is declared.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Declaration {
    /// Its file, from the root of the workspace.
    pub file: PathBuf,
    /// Its line, from 1.
    pub line: usize,
    /// Its name.
    pub name: String,
}

/// The types and functions of the product code of a workspace.
#[derive(Debug, Default)]
pub struct Declarations {
    /// Structs, enums, unions, traits and aliases that other modules can name (`pub`,
    /// `pub(crate)`).
    pub public_types: Vec<Declaration>,
    /// All other types.
    pub private_types: Vec<Declaration>,
    /// All functions and methods.
    pub functions: Vec<Declaration>,
    /// Functions with a parameter whose type has a tuple of three or more.
    pub tuple_parameters: Vec<Declaration>,
}

/// Reads the declarations of all crates below `root`, without their tests.
///
/// # Errors
/// When a file cannot be read or is no Rust.
pub fn declarations(root: &Path) -> Result<Declarations> {
    let mut all = Declarations::default();
    for folder in crates_of(root)? {
        for file in files_below(&folder.join("src"), "rs")? {
            let inside = file.strip_prefix(root).unwrap_or(&file);
            if is_test_file(file.strip_prefix(&folder).unwrap_or(&file)) {
                continue;
            }
            let text = fs::read_to_string(&file)
                .with_context(|| format!("cannot read {}", file.display()))?;
            all.read(inside, &text).with_context(|| format!("{} is no Rust", file.display()))?;
        }
    }
    Ok(all)
}

impl Declarations {
    /// Adds the declarations of a file.
    ///
    /// # Errors
    /// When `text` is no Rust.
    pub fn read(&mut self, file: &Path, text: &str) -> Result<()> {
        let parsed = syn::parse_file(text)?;
        Visitor { file, into: self }.visit_file(&parsed);
        Ok(())
    }
}

struct Visitor<'a> {
    file: &'a Path,
    into: &'a mut Declarations,
}

impl Visitor<'_> {
    fn declare(&self, name: &syn::Ident) -> Declaration {
        let line = name.span().start().line;
        Declaration { file: self.file.to_owned(), line, name: name.to_string() }
    }

    fn add_type(&mut self, visibility: &Visibility, name: &syn::Ident) {
        let declaration = self.declare(name);
        let types = match visibility {
            Visibility::Inherited => &mut self.into.private_types,
            _ => &mut self.into.public_types,
        };
        types.push(declaration);
    }
}

impl<'ast> Visit<'ast> for Visitor<'_> {
    fn visit_item(&mut self, item: &'ast Item) {
        if is_test(attributes_of(item)) {
            return;
        }
        match item {
            Item::Enum(item) => self.add_type(&item.vis, &item.ident),
            Item::Struct(item) => self.add_type(&item.vis, &item.ident),
            Item::Trait(item) => self.add_type(&item.vis, &item.ident),
            Item::Type(item) => self.add_type(&item.vis, &item.ident),
            Item::Union(item) => self.add_type(&item.vis, &item.ident),
            // The methods of a foreign trait have the signatures that the trait gives them.
            Item::Impl(item) if item.trait_.is_some() => return,
            _ => {}
        }
        syn::visit::visit_item(self, item);
    }

    fn visit_signature(&mut self, signature: &'ast syn::Signature) {
        let declaration = self.declare(&signature.ident);
        let is_tuple = |input: &FnArg| matches!(input, FnArg::Typed(input) if has_tuple(&input.ty));
        if signature.inputs.iter().any(is_tuple) {
            self.into.tuple_parameters.push(declaration.clone());
        }
        self.into.functions.push(declaration);
        syn::visit::visit_signature(self, signature);
    }
}

/// Whether a type is a tuple of three or more, or holds one behind references, slices or type
/// arguments. The arguments of closures and function pointers do not count: they are calls and not
/// values.
fn has_tuple(of: &Type) -> bool {
    match of {
        Type::Tuple(tuple) => tuple.elems.len() > 2 || tuple.elems.iter().any(has_tuple),
        Type::Reference(reference) => has_tuple(&reference.elem),
        Type::Slice(slice) => has_tuple(&slice.elem),
        Type::Array(array) => has_tuple(&array.elem),
        Type::Path(path) => path.path.segments.iter().any(|segment| match &segment.arguments {
            PathArguments::AngleBracketed(arguments) => arguments.args.iter().any(
                |argument| matches!(argument, GenericArgument::Type(inner) if has_tuple(inner)),
            ),
            _ => false,
        }),
        _ => false,
    }
}
