//! A checked layer: its classes are distinct and can all be reached.

use std::collections::BTreeMap;

use crate::{
    AttributeKind, AttributeValue, ClassForm, DerivedNumber, LayerForm, LayerGeometry,
    LayerTableError, LinePlacement, TagCondition,
    layer_attribute::MAX_TAG_CHARS,
    shadowing::{Shadow, shadows},
    table_error::{CheckResult, ErrorPath, wrong},
    titles::is_plain_text,
};

/// A layer: which objects of an extract it contains, in which classes, and what packages keep of
/// them. A table is checked when it is created.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerTable {
    form: LayerForm,
    /// Keys of which every object with tags of a class has at least one, ascending.
    needed_keys: Vec<String>,
}

/// The largest number of classes of a layer: packages store a class as one byte.
pub const MAX_LAYER_CLASSES: usize = 256;
/// The largest number of relation types, roles, attributes and layers above.
const MAX_LISTED: usize = 64;
/// The largest number of alternatives of a class, and of conditions of an alternative.
const MAX_ALTERNATIVES: usize = 64;
/// The largest number of conditions of a layer, and of the values that they name.
const MAX_CONDITIONS: usize = 8192;
const MAX_VALUES: usize = 16_384;
/// The largest number in a condition; numbers of tags are not larger.
const MAX_NUMBER: f64 = 1e15;
/// The largest length of ids, characters.
const MAX_ID_CHARS: usize = 32;
/// The side of a pixel, metres: 1/96 inch, as in styles. On the ground it is this times the scale's
/// denominator.
const PIXEL_M: f64 = 0.0254 / 96.0;
/// The cells of levels on which a class is stored have at most this many pixels at the smallest
/// scale of the class.
const CELL_PIXELS: f64 = 2.0;

impl LayerTable {
    /// Checks a layer.
    ///
    /// # Errors
    /// When an id, title, key, value or number is not valid, a setting does not apply to the
    /// geometry, a limit is exceeded, or two classes have the same id.
    pub fn new(form: LayerForm) -> Result<Self, LayerTableError> {
        check_id(&form.id).at("id")?;
        check_titles(&form.title)?;
        check_geometry(&form)?;
        check_lists(&form)?;
        let cells = form.simplify_cells;
        if !(0.0..=8.0).contains(&cells) {
            Err(wrong(format!("expected 0 to 8 cells, got {cells}"))).at("simplify_cells")?;
        }
        let conditions =
            || form.classes.iter().flat_map(|class| class.tags.alternatives()).flatten();
        let values = conditions().map(|(_, condition)| condition.values().len()).sum();
        if form.classes.is_empty() || form.classes.len() > MAX_LAYER_CLASSES {
            let count = form.classes.len();
            Err(wrong(format!("a layer has 1 to {MAX_LAYER_CLASSES} classes, got {count}")))
                .at("class")?;
        }
        for (what, number, most) in
            [("conditions", conditions().count(), MAX_CONDITIONS), ("values", values, MAX_VALUES)]
        {
            if number > most {
                Err(wrong(format!("has {number} {what}; the limit is {most}"))).at("class")?;
            }
        }
        for (index, class) in form.classes.iter().enumerate() {
            let others = &form.classes[..index];
            check_class(&form, class, others).nth(index).at("class")?;
        }
        let mut needed_keys: Vec<String> = form.classes.iter().flat_map(needed_keys).collect();
        if form.classes.iter().any(|class| class.coastline) {
            needed_keys.push("natural".to_owned());
        }
        needed_keys.sort_unstable();
        needed_keys.dedup();
        Ok(Self { form, needed_keys })
    }

    /// Checks that each class can be reached.
    ///
    /// # Errors
    /// When classes before a class match all its objects, when this takes too long to decide, or
    /// when ranges of a key have two units.
    pub fn check_reach(&self) -> Result<(), LayerTableError> {
        let Some((index, shadow)) = shadows(&self.form.classes)? else { return Ok(()) };
        let own = &self.form.classes[index].id;
        let problem = match shadow {
            Shadow::ByClasses(names) => format!(
                "class {own:?} is never reached: classes before it ({}) match all its objects; move it up, or remove it",
                names.join(", ")
            ),
            Shadow::Unknown => format!(
                "whether class {own:?} can be reached takes too long to decide; use fewer conditions"
            ),
        };
        Err(wrong(problem)).at("tags").nth(index).at("class")
    }

    /// Returns the layer as it was written.
    #[must_use]
    pub const fn form(&self) -> &LayerForm {
        &self.form
    }

    /// Returns the layer's name.
    #[must_use]
    pub fn id(&self) -> &str {
        &self.form.id
    }

    /// Returns the geometry of its objects.
    #[must_use]
    pub const fn geometry(&self) -> LayerGeometry {
        self.form.geometry
    }

    /// Returns the classes, the first one first.
    #[must_use]
    pub fn classes(&self) -> &[ClassForm] {
        &self.form.classes
    }

    /// Returns the kept tags: their keys, ascending, and what is kept of them.
    pub fn attributes(&self) -> impl Iterator<Item = (&str, AttributeKind)> {
        self.form.attributes.iter().map(|(key, &kind)| (key.as_str(), kind))
    }

    /// Returns the number of the class of an object with these `(key, value)` tags; `None` if the
    /// object does not belong to the layer. If a key occurs twice, the first value counts.
    #[must_use]
    pub fn classify(&self, tags: &[(&str, &str)]) -> Option<u8> {
        let class = self.form.classes.iter().position(|class| class.tags.is_met(tags))?;
        u8::try_from(class).ok()
    }

    /// Returns the values of the kept tags, in the order of [`Self::attributes`]. Calls `on_unread`
    /// with the key of each value that is not of its attribute's kind, or cannot be stored.
    pub fn values(
        &self,
        tags: &[(&str, &str)],
        mut on_unread: impl FnMut(&str),
    ) -> Vec<Option<AttributeValue>> {
        self.attributes().map(|(key, kind)| kind.read(key, tags, || on_unread(key))).collect()
    }

    /// Returns keys, ascending: an object that has none of them has no class by its own tags. Ways
    /// of relations ([`RelationMembers`](crate::RelationMembers)) get classes from the tags of the
    /// relation.
    #[must_use]
    pub fn needed_keys(&self) -> &[String] {
        &self.needed_keys
    }

    /// Returns the number of the class that is built from coastlines.
    #[must_use]
    pub fn coastline_class(&self) -> Option<u8> {
        let class = self.form.classes.iter().position(|class| class.coastline)?;
        u8::try_from(class).ok()
    }
}

impl ClassForm {
    /// Returns the largest cell, metres, of the levels on which the class is stored in addition to
    /// the finest level; `None` for all levels.
    #[must_use]
    pub fn coarsest_cell_m(&self) -> Option<f64> {
        self.scale.map(|scale| scale * PIXEL_M * CELL_PIXELS)
    }
}

fn check_id(id: &str) -> CheckResult {
    let is_plain = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'-';
    let begins = id.bytes().next().is_some_and(|byte| byte.is_ascii_lowercase());
    if begins && id.len() <= MAX_ID_CHARS && id.bytes().all(is_plain) && !id.ends_with('-') {
        return Ok(());
    }
    Err(wrong(format!(
        "{id:?} is not an id: use 1 to {MAX_ID_CHARS} characters of a-z, 0-9 and '-', beginning with a letter"
    )))
}

fn check_titles(titles: &crate::Titles) -> CheckResult {
    titles.check().map_err(wrong).at("title")
}

/// Refuses keys that do not apply to the geometry.
fn check_geometry(form: &LayerForm) -> CheckResult {
    let geometry = form.geometry;
    let only = |is_given: bool, key: &str, of: LayerGeometry| {
        if !is_given || geometry == of {
            return Ok(());
        }
        let (of, own) = (of.name(), geometry.name());
        Err(wrong(format!("applies to layers of geometry {of:?}, and this one has {own:?}")))
            .at(key)
    };
    only(form.placement != LinePlacement::Ground, "placement", LayerGeometry::Line)?;
    only(form.members.is_some(), "members", LayerGeometry::Line)?;
    only(!form.closed_ways, "closed_ways", LayerGeometry::Point)
}

fn check_lists(form: &LayerForm) -> CheckResult {
    check_length(form.above.len(), MAX_LISTED).at("above")?;
    check_length(form.attributes.len(), MAX_LISTED).at("attributes")?;
    for (index, layer) in form.above.iter().enumerate() {
        let checked = if *layer == form.id {
            Err(wrong("a layer cannot be above itself"))
        } else if form.above[..index].contains(layer) {
            Err(wrong(format!("layer {layer:?} is listed twice")))
        } else {
            check_id(layer)
        };
        checked.nth(index).at("above")?;
    }
    for (key, &kind) in &form.attributes {
        let derived = match kind {
            AttributeKind::Derived(number) => check_derived(form, number),
            _ => Ok(()),
        };
        check_text(key, "a key").and(derived).at(key).at("attributes")?;
    }
    let Some(members) = &form.members else { return Ok(()) };
    if members.types.is_empty() {
        Err(wrong("lists no type of relation")).at("types").at("members")?;
    }
    for (key, texts) in [("types", &members.types), ("roles", &members.roles)] {
        check_length(texts.len(), MAX_LISTED).at(key).at("members")?;
        for (index, text) in texts.iter().enumerate() {
            if key != "roles" || !text.is_empty() {
                check_text(text, "a value").nth(index).at(key).at("members")?;
            }
        }
    }
    Ok(())
}

fn check_derived(form: &LayerForm, DerivedNumber::Isolation: DerivedNumber) -> CheckResult {
    let key = DerivedNumber::HEIGHT_KEY;
    let has_heights = matches!(form.attributes.get(key), Some(AttributeKind::Number(_)));
    if form.geometry == LayerGeometry::Point && !form.closed_ways && has_heights {
        return Ok(());
    }
    Err(wrong(format!(
        "isolation applies to layers of points with closed_ways = false and with the attribute {key} = {{ number = \"m\" }}"
    )))
}

fn check_length(length: usize, most: usize) -> CheckResult {
    if length > most {
        Err(wrong(format!("has {length} entries; the limit is {most}")))
    } else {
        Ok(())
    }
}

fn check_text(text: &str, what: &str) -> CheckResult {
    if is_plain_text(text, MAX_TAG_CHARS) {
        return Ok(());
    }
    Err(wrong(format!(
        "{text:?} is not accepted as {what}: use 1 to {MAX_TAG_CHARS} characters in one line, without spaces at the ends and without characters that are invisible or change the direction of writing"
    )))
}

fn check_class(form: &LayerForm, class: &ClassForm, before: &[ClassForm]) -> CheckResult {
    check_id(&class.id).at("id")?;
    if before.iter().any(|other| other.id == class.id) {
        Err(wrong(format!("two classes are called {:?}", class.id))).at("id")?;
    }
    check_titles(&class.title)?;
    if let Some(scale) = class.scale.filter(|scale| !(1.0..=1e9).contains(scale)) {
        let problem = "expected the denominator of a scale, 1 to 1e9 (25000 for 1:25 000)";
        Err(wrong(format!("{problem}, got {scale}"))).at("scale")?;
    }
    if class.coastline {
        if form.geometry != LayerGeometry::Area || before.iter().any(|other| other.coastline) {
            Err(wrong("only one class can be built from coastlines, and only in a layer of areas"))
                .at("coastline")?;
        }
        if !class.tags.alternatives().is_empty() {
            Err(wrong("a class that is built from coastlines has no tags")).at("tags")?;
        }
        return Ok(());
    }
    let alternatives = class.tags.alternatives();
    if alternatives.is_empty() {
        Err(wrong("the class has no tags")).at("tags")?;
    }
    check_length(alternatives.len(), MAX_ALTERNATIVES).at("tags")?;
    for (index, conditions) in alternatives.iter().enumerate() {
        let checked = check_alternative(conditions);
        if matches!(class.tags, crate::TagRule::AllOf(_)) {
            checked.at("tags")?;
        } else {
            checked.nth(index).at("tags")?;
        }
    }
    Ok(())
}

fn check_alternative(conditions: &BTreeMap<String, TagCondition>) -> CheckResult {
    check_length(conditions.len(), MAX_ALTERNATIVES)?;
    for (key, condition) in conditions {
        check_text(key, "a key").and_then(|()| check_condition(condition)).at(key)?;
    }
    if conditions.values().any(TagCondition::needs_tag) {
        return Ok(());
    }
    Err(wrong(
        "requires no tag, so that almost every object would match; name a tag that objects must have",
    ))
}

fn check_condition(condition: &TagCondition) -> CheckResult {
    match condition {
        TagCondition::Present | TagCondition::Absent => Ok(()),
        TagCondition::OneOf(values)
        | TagCondition::NoneOf(values)
        | TagCondition::OtherThan(values) => {
            if values.is_empty() {
                return Err(wrong("lists no value"));
            }
            values.iter().try_for_each(|value| check_text(value, "a value"))
        }
        &TagCondition::Range { min, below, .. } => {
            let are_numbers =
                [min, below].into_iter().flatten().all(|number| number.abs() <= MAX_NUMBER);
            let is_open = min.zip(below).is_none_or(|(min, below)| min < below);
            if are_numbers && is_open && (min.is_some() || below.is_some()) {
                return Ok(());
            }
            Err(wrong(
                "contains no number: pass min, below or both, at most 1e15, with min less than below",
            ))
        }
    }
}

/// The keys of which an object of a class has at least one: for each alternative, the first key
/// that it requires.
fn needed_keys(class: &ClassForm) -> impl Iterator<Item = String> {
    class.tags.alternatives().iter().filter_map(|conditions| {
        let needed = conditions.iter().find(|(_, condition)| condition.needs_tag());
        needed.map(|(key, _)| key.clone())
    })
}

#[cfg(test)]
#[path = "layer_table_tests.rs"]
mod tests;
