//! What is compared of two plans, as pairs of a name that users know and a value in words.

use corniche_tileset::{AreaTableRecord, PolygonRecord, ReliefLevels, SettingsRecord};

/// A setting's name, and its value in words.
pub(crate) type Fact = (String, String);

/// The sentence about one value.
pub(crate) fn different(name: &str, ours: &str, theirs: &str) -> String {
    format!("{name} is {ours}, the store was made with {theirs}")
}

pub(crate) fn different_facts(ours: &[Fact], theirs: &[Fact]) -> Vec<String> {
    let mut said: Vec<String> = ours
        .iter()
        .zip(theirs)
        .filter(|(ours, theirs)| ours != theirs)
        .map(|((name, ours), (_, theirs))| different(name, ours, theirs))
        .collect();
    if ours.len() != theirs.len() {
        said.push(format!("{} values are compared with {}", ours.len(), theirs.len()));
    }
    said
}

/// How the settings for the ground differ from those that a package records, in words; those for roads do not count.
pub(crate) fn terrain_differences(ours: &SettingsRecord, package: &SettingsRecord) -> Vec<String> {
    // The package's roads are not used.
    let mut theirs = SettingsRecord {
        frc_table: ours.frc_table.clone(),
        frc_table_sha256: ours.frc_table_sha256.clone(),
        class_labels: ours.class_labels.clone(),
        classes: ours.classes.clone(),
        class_max_cell_m: ours.class_max_cell_m.clone(),
        simplify_cells: ours.simplify_cells,
        // Photos are taken with the terrain.
        photo: ours.photo,
        areas: ours.areas.clone(),
        boundaries: ours.boundaries,
        spans: ours.spans,
        ..package.clone()
    };
    // A polygon is the same under another name.
    if let (Some(own), Some(recorded)) = (&ours.polygon, &mut theirs.polygon)
        && own.sha256 == recorded.sha256
    {
        recorded.name.clone_from(&own.name);
    }
    // Relief that a package has may be left out.
    if ours.relief == ReliefLevels::Off {
        theirs.relief = ReliefLevels::Off;
    }
    differences_from(ours, &theirs)
}

/// How the settings for roads and areas differ from those that a package records, in words; those for the ground do not count.
#[must_use]
pub fn network_differences(ours: &SettingsRecord, package: &SettingsRecord) -> Vec<String> {
    let theirs = SettingsRecord {
        frc_table: package.frc_table.clone(),
        classes: package.classes.clone(),
        class_max_cell_m: package.class_max_cell_m.clone(),
        simplify_cells: package.simplify_cells,
        areas: package.areas.clone(),
        boundaries: package.boundaries,
        spans: package.spans,
        ..ours.clone()
    };
    differences_from(ours, &theirs)
}

fn differences_from(ours: &SettingsRecord, theirs: &SettingsRecord) -> Vec<String> {
    setting_facts(ours)
        .into_iter()
        .zip(setting_facts(theirs))
        .filter(|(ours, theirs)| ours != theirs)
        .map(|((name, ours), (_, theirs))| format!("{name} is {ours}, it was made with {theirs}"))
        .collect()
}

/// A polygon by the name of its file and the beginning of its hash, which tells it from others.
fn polygon_text(polygon: &PolygonRecord) -> String {
    let digits = polygon.sha256.get(..12).unwrap_or(&polygon.sha256);
    format!("{} ({digits}…)", polygon.name)
}

/// A table by its name and the beginning of its hash, which tells it from others.
fn area_table_text(areas: &AreaTableRecord) -> String {
    let digits = areas.sha256.get(..12).unwrap_or(&areas.sha256);
    format!("{} ({digits}…)", areas.table)
}

pub(crate) fn list<T: AsRef<str>>(texts: impl IntoIterator<Item = T>) -> String {
    let texts: Vec<String> = texts.into_iter().map(|text| text.as_ref().to_owned()).collect();
    if texts.is_empty() { "none".to_owned() } else { texts.join(", ") }
}

pub(crate) fn given<T: ToString>(value: Option<&T>) -> String {
    value.map_or_else(|| "not given".to_owned(), ToString::to_string)
}

pub(crate) fn pair([a, b]: [f64; 2]) -> String {
    format!("{a},{b}")
}

pub(crate) fn fact(name: &str, value: &impl ToString) -> Fact {
    (name.to_owned(), value.to_string())
}

pub(crate) fn setting_facts(record: &SettingsRecord) -> Vec<Fact> {
    // Every field is named, so that a new one cannot be forgotten here.
    let SettingsRecord {
        max_error_m,
        fill_voids,
        nodata,
        height_range_m,
        dem_band,
        dem_crs,
        dem_vertical_crs,
        vertical_crs,
        vertical_shift_m,
        vertical_unit,
        crs,
        cell_m,
        cell_every,
        scale_latitude_deg,
        bounds_deg,
        polygon,
        relief,
        frc_table,
        // The table's entries are compared one by one.
        frc_table_sha256: _,
        class_labels,
        classes: chosen_classes,
        class_max_cell_m,
        simplify_cells,
        photo,
        areas,
        boundaries,
        spans,
    } = record;
    let classes = class_max_cell_m.iter().enumerate().map(|(class, cell_m)| match cell_m {
        Some(cell_m) => format!("{class}: {cell_m}"),
        None => format!("{class}: all"),
    });
    vec![
        fact("--max-error", max_error_m),
        fact("--fill-voids", fill_voids),
        fact("--nodata", &list(nodata.iter().map(ToString::to_string))),
        fact("--height-range", &given(height_range_m.map(pair).as_ref())),
        fact("--dem-band", &given(dem_band.as_ref())),
        fact("--dem-crs", &given(dem_crs.as_ref())),
        fact("--dem-vertical-crs", &given(dem_vertical_crs.as_ref())),
        fact("--vertical-crs", &given(vertical_crs.as_ref())),
        fact("--vertical-shift", vertical_shift_m),
        fact("--vertical-unit", &given(vertical_unit.as_ref())),
        fact("--crs", &given(crs.as_ref())),
        fact("--cell", &given(cell_m.map(|cell| pair(cell.to_array())).as_ref())),
        fact("--cell-every", &given(cell_every.as_ref())),
        fact("--scale-latitude", &given(scale_latitude_deg.as_ref())),
        fact(
            "--bounds",
            &given(bounds_deg.map(|bounds| bounds.map(|deg| deg.to_string()).join(",")).as_ref()),
        ),
        fact("--polygon", &given(polygon.as_ref().map(polygon_text).as_ref())),
        fact("--relief", &relief.name()),
        fact("--frc-table", frc_table),
        fact("the names of classes", &given(class_labels.as_ref().map(list).as_ref())),
        fact(
            "--classes",
            &given(
                chosen_classes
                    .as_ref()
                    .map(|chosen| list(chosen.iter().map(ToString::to_string)))
                    .as_ref(),
            ),
        ),
        fact("class-max-cell (--all-classes)", &list(classes)),
        fact("--structures", &if *spans { "spans" } else { "ground" }),
        fact("--simplify", simplify_cells),
        fact("--photo-levels", &given(photo.map(|photo| photo.levels).as_ref())),
        fact("--photo-quality", &given(photo.map(|photo| photo.quality).as_ref())),
        fact("--areas", &given(areas.as_ref().map(area_table_text).as_ref())),
        fact("--boundaries", &if *boundaries { "on" } else { "off" }),
    ]
}
