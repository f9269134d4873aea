//! What a table says of the classes of a layer of lines.

/// The classes of a layer, by their numbers from 0, and what makes a line of it.
#[derive(Debug)]
pub struct ClassTable {
    /// What the layer is called where a sentence begins.
    pub title: &'static str,
    /// The key of OSM without which nothing is a line of the layer.
    pub key: &'static str,
    /// The class of an object with these `(key, value)` tags, if it has one.
    pub of_tags: fn(&[(&str, &str)]) -> Option<u8>,
    /// Whether relations of the types `boundary` and `multipolygon` give their class to the ways around them.
    pub has_relations: bool,
    /// Names in settings, styles and exports, of the most important class first.
    pub names: &'static [&'static str],
    /// The coarsest cell, metres, on whose level a class is stored; `None`: all.
    pub coarsest_cells_m: &'static [Option<f64>],
}
