//! `corniche layers`: the built-in layers, and tables of layers.

use std::path::Path;

use corniche_layers::{LayerForm, LayerTable};
use corniche_presets::{layer_preset, layer_preset_names, parse_layer_table};

use crate::{
    args::LayersArgs,
    documents::to_line,
    failure::Result,
    messages,
    presets::{refuse, text_of},
    table::Table,
};

pub(crate) fn run(args: &LayersArgs) -> Result<()> {
    let text = match &args.layer {
        None if args.schema => format!("{}\n", to_line(&schemars::schema_for!(LayerForm))),
        None => listed()?,
        Some(layer) => match layer_preset(layer) {
            Some(text) => text.to_owned(),
            None => described(&[table(layer)?]),
        },
    };
    messages::answer(&text)?;
    Ok(())
}

/// Reads the table of a layer: a built-in one by name, or a file by path.
pub(crate) fn table(name_or_path: &str) -> Result<LayerTable> {
    let what = format!("layer {name_or_path:?} is neither built in");
    let preset = layer_preset(name_or_path);
    let text = text_of(name_or_path, preset, (&what, layer_preset_names()))?;
    let named = |error| refuse(&format!("layer table {:?}", Path::new(name_or_path)), &error);
    parse_layer_table(&text).map_err(named)
}

fn listed() -> Result<String> {
    let tables: Vec<LayerTable> = layer_preset_names().map(table).collect::<Result<_, _>>()?;
    Ok(described(&tables))
}

fn described(tables: &[LayerTable]) -> String {
    let mut text = Table::new(["layer", "geometry", "classes", "attributes", "title"]);
    for table in tables {
        let form = table.form();
        text.row([
            form.id.clone(),
            form.geometry.name().to_owned(),
            form.classes.len().to_string(),
            form.attributes.len().to_string(),
            form.title.title(&["en"]).unwrap_or_default().to_owned(),
        ]);
    }
    text.to_text()
}
