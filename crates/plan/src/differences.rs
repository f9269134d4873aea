//! The differences between two plans, in the words of the command line.

use corniche_settings::SettingValue as _;
use corniche_spec::{inputs::PlannedInput, manifest_texts};

use super::{
    BuildPlan, FrcTableRecord, PlannedGrid, PlannedLevel,
    facts::{Fact, different, different_facts, fact, setting_facts},
};

impl BuildPlan {
    /// Returns the differences between this plan and `store`, the plan with which a store was
    /// created. Differences that the user can change (program, files, settings) come first; derived
    /// values are compared only if these are the same. Empty if the plans are the same.
    #[must_use]
    pub fn differences(&self, store: &Self) -> Vec<String> {
        // Every field is named, so that a new field cannot be forgotten here.
        let Self {
            plan_version,
            generator,
            libraries,
            inputs: _,
            settings,
            frc_table,
            // The hashes of the tables are among the settings.
            layers: _,
            attribution,
            grid: _,
            levels: _,
        } = self;
        let mut said = Vec::new();
        if plan_version != &store.plan_version {
            let other = store.plan_version;
            said.push(format!(
                "this plan has version {plan_version}, the store's plan has version {other}"
            ));
        }
        for (ours, theirs) in [(generator, &store.generator), (libraries, &store.libraries)] {
            if ours != theirs {
                said.push(format!("this is {ours}, but the store was created by {theirs}"));
            }
        }
        said.extend(self.input_differences(store));
        said.extend(different_facts(&setting_facts(settings), &setting_facts(&store.settings)));
        said.extend(frc_table.difference(&store.frc_table));
        if attribution != &store.attribution {
            let (ours, theirs) = (attribution.text(), store.attribution.text());
            said.push(different("--attribution", &ours, &theirs));
        }
        if said.is_empty() {
            said = different_facts(&grid_facts(&self.grid), &grid_facts(&store.grid));
            said.extend(different_facts(&level_facts(&self.levels), &level_facts(&store.levels)));
        }
        if said.is_empty() && self.hash() != store.hash() {
            said.push("the store's plan contradicts itself: it was edited by hand".to_owned());
        }
        said
    }

    fn input_differences(&self, store: &Self) -> Vec<String> {
        let key = |input: &PlannedInput| (input.kind.clone(), input.path.clone());
        let paths = |plan: &Self| plan.inputs.iter().map(key).collect::<Vec<_>>();
        if paths(self) != paths(store) {
            let files = |plan: &Self| {
                let name = |input: &PlannedInput| format!("{} ({})", input.path, input.kind);
                plan.inputs.iter().map(name).collect::<Vec<_>>().text()
            };
            return vec![different("the list of input files", &files(self), &files(store))];
        }
        self.inputs
            .iter()
            .zip(&store.inputs)
            .filter_map(|(now, then)| {
                let change = now.change_since(then)?;
                Some(format!("{} has changed since the store was created: {change}", now.path))
            })
            .collect()
    }
}

impl FrcTableRecord {
    fn difference(&self, store: &Self) -> Option<String> {
        if self == store {
            return None;
        }
        let Self { name, least_class, values } = self;
        // Tables with different names already differ in the setting's name.
        let mut said = Vec::new();
        if least_class != &store.least_class {
            said.push(format!("least class {least_class} instead of {}", store.least_class));
        }
        let text = |table: &Self, value: &str| {
            let found = table.values.iter().find(|(other, _)| other == value);
            match found {
                Some((_, Some(class))) => format!("class {class}"),
                Some((_, None)) => "no road".to_owned(),
                None => "not listed".to_owned(),
            }
        };
        let mut highways: Vec<&str> =
            values.iter().chain(&store.values).map(|(value, _)| value.as_str()).collect();
        highways.sort_unstable();
        highways.dedup();
        for value in highways {
            let (ours, theirs) = (text(self, value), text(store, value));
            if ours != theirs {
                said.push(format!("highway={value} is {ours} instead of {theirs}"));
            }
        }
        // The names of two tables with the same entries are reported among the settings.
        (!said.is_empty()).then(|| {
            format!("--frc-table {name} differs from the table of the store: {}", said.join(", "))
        })
    }
}

fn grid_facts(grid: &PlannedGrid) -> Vec<Fact> {
    let PlannedGrid {
        frame,
        south_west,
        north_east,
        crs,
        crs_wkt,
        metres_per_unit,
        point_scale,
        data_bounds,
        wgs84_bounds,
        nodes_are_samples,
        resampling,
        vertical_datum,
        vertical_treatment,
        datum_operations,
        quantum_m,
    } = grid;
    vec![
        fact("the working CRS", crs),
        fact("the working CRS's WKT", crs_wkt),
        fact("the number of metres per unit of the CRS", metres_per_unit),
        fact("the scale at the centre", point_scale),
        fact("the grid", &format!("{frame:?}")),
        fact("the south-western node", &format!("{}, {}", south_west.i, south_west.j)),
        fact("the north-eastern node", &format!("{}, {}", north_east.i, north_east.j)),
        fact("the data's rectangle", &format!("{data_bounds:?}")),
        fact("the data's rectangle in degrees", &format!("{wgs84_bounds:?}")),
        fact("\"nodes are samples\"", &nodes_are_samples.to_string()),
        fact("how nodes relate to samples", resampling),
        fact("the vertical datum", vertical_datum),
        fact("the treatment of heights", vertical_treatment),
        fact(
            "PROJ's operation between datums",
            &datum_operations.iter().map(manifest_texts::operation_words).collect::<Vec<_>>(),
        ),
        fact("the height step in metres", quantum_m),
    ]
}

fn level_facts(levels: &[PlannedLevel]) -> Vec<Fact> {
    let words = |planned: &PlannedLevel| {
        let PlannedLevel {
            level,
            cell_m,
            max_error_m,
            least_class,
            simplify_tolerance_m,
            width_margin_m,
        } = planned;
        let values = format!(
            "cell {}, max error {max_error_m}, least class {}, simplification {simplify_tolerance_m}, margin {width_margin_m}",
            cell_m.text(),
            least_class.text(),
        );
        fact(&format!("level {level}"), &values)
    };
    levels.iter().map(words).collect()
}
