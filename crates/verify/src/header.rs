//! Checks that the header and the metadata for PMTiles tools match the manifest and the tiles.

use corniche_tileset::{FilePackage, ToolRecord};

use super::{checks::Findings, error::Result};

/// The number of characters of a text that a finding shows.
const SHOWN: usize = 200;

pub(crate) fn verify(package: &FilePackage, findings: &mut Findings) -> Result<()> {
    let tiles = package.tile_ids()?.len() as u64;
    let said = fields(&package.tool_record()?);
    let wanted = fields(&ToolRecord::from_manifest(package.manifest(), tiles));
    for ((name, said), (_, wanted)) in said.into_iter().zip(wanted) {
        let shown = |text: &str| text.chars().take(SHOWN).collect::<String>();
        look!(
            findings,
            Header,
            said == wanted,
            "{name} is {}, not {}",
            shown(&said),
            shown(&wanted)
        );
    }
    Ok(())
}

/// All fields as text. The pattern names every field, so that a new field is compared, too.
fn fields(record: &ToolRecord) -> [(&'static str, String); 11] {
    let ToolRecord {
        addressed_tiles,
        tile_entries,
        tile_contents,
        clustered,
        zooms,
        bounds_e7,
        center_zoom,
        center_e7,
        name,
        description,
        attribution,
    } = record;
    [
        ("the count of addressed tiles", addressed_tiles.to_string()),
        ("the count of tile entries", tile_entries.to_string()),
        ("the count of tile contents", tile_contents.to_string()),
        ("clustered", clustered.to_string()),
        ("the range of levels", format!("{zooms:?}")),
        ("the rectangle in 10⁻⁷ degrees", format!("{bounds_e7:?}")),
        ("the level of the centre", center_zoom.to_string()),
        ("the centre in 10⁻⁷ degrees", format!("{center_e7:?}")),
        ("name", format!("{name:?}")),
        ("description", format!("{description:?}")),
        ("attribution", format!("{attribution:?}")),
    ]
}
