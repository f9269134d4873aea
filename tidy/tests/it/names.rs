//! One name for one thing: words that once had many meanings are not used as names of types and
//! files of products.

use std::{collections::BTreeMap, fs, path::Path, sync::LazyLock};

use corniche_tidy::{Declaration, Declarations, crates_of, declarations, files_below, root};

/// Bare nouns and participles, and nouns that up to seven types shared: they say nothing without
/// the noun that belongs to them, as in `GridFrame` or `RoadPart`. `Item` and others may be
/// associated types of foreign traits.
const BARE: [&str; 27] = [
    "Answer",
    "Asked",
    "Block",
    "Entry",
    "Found",
    "Frame",
    "Given",
    "Head",
    "Item",
    "Kept",
    "Kind",
    "Laid",
    "Line",
    "Listed",
    "Looked",
    "Made",
    "Part",
    "PartRecord",
    "Piece",
    "Place",
    "Placed",
    "Record",
    "Seen",
    "Splitting",
    "Told",
    "Wanted",
    "Written",
];
/// Each of these was the name of several files.
const FILES: [&str; 3] = ["place.rs", "request.rs", "run.rs"];

/// The declarations of the workspace, read once for all rules.
static DECLARATIONS: LazyLock<Declarations> = LazyLock::new(|| declarations(&root()).unwrap());

#[test]
fn no_file_has_a_name_that_stood_for_many() {
    for folder in crates_of(&root()).unwrap() {
        for file in files_below(&folder.join("src"), "rs").unwrap() {
            let name = file.file_name().unwrap();
            assert!(
                !FILES.iter().any(|taken| name == *taken),
                "{}: the file's name is too general; add what it contains",
                file.display()
            );
        }
    }
}

/// Functional road classes are 0 to 8: 8 is for paths, steps and cycleways.
#[test]
fn functional_road_classes_are_0_to_8() {
    let wrong = ["FRC 0–7", "FRC 0-7", "FRC 0..7", "FRC 0 to 7"];
    for file in files_below(&root().join("crates"), "rs").unwrap() {
        let text = fs::read_to_string(&file).unwrap();
        for form in wrong {
            assert!(!text.contains(form), "{}: {form}", file.display());
        }
    }
}

fn places<'a>(declarations: impl IntoIterator<Item = &'a Declaration>) -> String {
    let place = |Declaration { file, line, name }: &Declaration| {
        format!("{}:{line}: {name}", file.display())
    };
    declarations.into_iter().map(place).collect::<Vec<_>>().join("\n")
}

#[test]
fn names_of_public_types_are_unique() {
    let types = &DECLARATIONS.public_types;
    assert!(types.len() > 1000, "only {} types were found", types.len());
    let mut by_name: BTreeMap<&str, Vec<&Declaration>> = BTreeMap::new();
    for declaration in types {
        by_name.entry(&declaration.name).or_default().push(declaration);
    }
    // A crate may have its own short form of the standard library's type, as `std::io` does.
    by_name.remove("Result");
    let twice: Vec<_> = by_name.into_values().filter(|all| all.len() > 1).flatten().collect();
    assert!(twice.is_empty(), "say in the name what it is in particular:\n{}", places(twice));
}

#[test]
fn names_of_types_have_a_noun_of_their_own() {
    let Declarations { public_types, private_types, .. } = &*DECLARATIONS;
    let is_bare = |declaration: &&Declaration| BARE.contains(&&*declaration.name);
    let bare: Vec<_> = public_types.iter().chain(private_types).filter(is_bare).collect();
    assert!(bare.is_empty(), "these names need their noun:\n{}", places(bare));
}

/// `Level::of(tile)` reads well and cannot be searched for.
#[test]
fn no_function_is_called_of() {
    let functions = &DECLARATIONS.functions;
    assert!(functions.len() > 5000, "only {} functions were found", functions.len());
    let found: Vec<_> = functions.iter().filter(|function| function.name == "of").collect();
    assert!(found.is_empty(), "say in the name what is made from what:\n{}", places(found));
}

#[test]
fn no_parameter_is_a_tuple_of_three() {
    // Nodes of made-up extracts are id, latitude and longitude in some hundred tests.
    let is_product = |function: &&Declaration| !function.file.starts_with("crates/testing");
    let found: Vec<_> = DECLARATIONS.tuple_parameters.iter().filter(is_product).collect();
    assert!(found.is_empty(), "a struct with names, or fewer arguments:\n{}", places(found));
}

#[test]
fn what_names_forbid_is_seen() {
    let mut read = Declarations::default();
    let text = "pub struct Found; enum Item { A } fn of(a: (u8, u8, u8), b: [u8; 3]) {}\n\
                impl Found { fn pair(&self, of: (u8, u8), f: impl Fn((u8, u8, u8))) {} fn list(of: &[(u8, u8, u8)]) {} }";
    read.read(Path::new("a.rs"), text).unwrap();
    let names = |found: &[Declaration]| {
        found.iter().map(|declaration| declaration.name.clone()).collect::<Vec<_>>()
    };
    assert_eq!(names(&read.public_types), ["Found"]);
    assert_eq!(names(&read.private_types), ["Item"]);
    assert_eq!(names(&read.functions), ["of", "pair", "list"]);
    assert_eq!(names(&read.tuple_parameters), ["of", "list"]);
}
