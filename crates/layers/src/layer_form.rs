//! A layer as a table or a manifest writes it, not yet checked.

use std::collections::BTreeMap;

use corniche_roads::listed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{AttributeKind, TagRule, Titles};

/// A layer as it is written: [`LayerTable::new`](crate::LayerTable::new) checks it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LayerForm {
    /// The layer's name in options, styles, packages and exports: lower-case letters, digits and
    /// hyphens.
    pub id: String,
    /// The layer's title, for legends.
    #[serde(default, skip_serializing_if = "Titles::is_missing")]
    pub title: Titles,
    /// Whether its objects are lines, areas or points.
    pub geometry: LayerGeometry,
    /// Lines only: whether lines are on the ground everywhere. Default: they are.
    #[serde(default, skip_serializing_if = "is_default")]
    pub placement: LinePlacement,
    /// Lines only: relations whose ways are lines of the layer, with the tags of the relation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub members: Option<RelationMembers>,
    /// Points only: whether closed ways and multipolygons with the tags become points, too, at a
    /// position inside them. Default: true.
    #[serde(default = "on", skip_serializing_if = "is_on")]
    pub closed_ways: bool,
    /// The layers above which this one is drawn, by id.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub above: Vec<String>,
    /// Lines only: how far simplification may move a line, in cells of a level. Default: 0.5.
    #[serde(default = "half", skip_serializing_if = "is_half")]
    pub simplify_cells: f64,
    /// The tags that are kept, by key.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub attributes: BTreeMap<String, AttributeKind>,
    /// The classes. An object belongs to the first class whose tags it has.
    #[serde(rename = "class")]
    pub classes: Vec<ClassForm>,
}

/// A class of a layer as it is written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClassForm {
    /// The name of the class in styles, packages and exports: lower-case letters, digits and
    /// hyphens.
    pub id: String,
    /// The title of the class, for legends.
    #[serde(default, skip_serializing_if = "Titles::is_missing")]
    pub title: Titles,
    /// The denominator of the smallest scale at which the class is shown: 25000 for 1:25 000 and
    /// larger scales. Default: all scales. Tiles of the finest level always contain the class.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// Areas only: the class is the sea, which is built from coastlines and has no tags.
    #[serde(default, skip_serializing_if = "is_default")]
    pub coastline: bool,
    /// The tags of its objects.
    #[serde(default, skip_serializing_if = "is_default")]
    pub tags: TagRule,
}

listed! {
    /// Whether the objects of a layer are lines, areas or points.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
    #[serde(rename_all = "kebab-case")]
    pub enum LayerGeometry {
        /// Ways.
        Line = "line",
        /// Closed ways and multipolygons.
        Area = "area",
        /// Nodes, and places inside closed ways.
        Point = "point",
    }

    /// Returns the name in tables.
    pub fn name() -> &'static str;
}

listed! {
    /// Whether the lines of a layer are on the ground everywhere.
    #[derive(
        Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize, JsonSchema,
    )]
    #[serde(rename_all = "kebab-case")]
    pub enum LinePlacement {
        /// On the ground, everywhere.
        #[default]
        Ground = "ground",
        /// On the ground, but bridges and tunnels are above and below it, like those of roads.
        Spans = "spans",
    }

    /// Returns the name in tables.
    pub fn name() -> &'static str;
}

/// Relations whose ways are lines of a layer. If several objects give a way a class, the way gets
/// the first of these classes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RelationMembers {
    /// Values of `type` of the relations.
    pub types: Vec<String>,
    /// The roles of their ways; an empty role is `""`. Default: all roles.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub roles: Vec<String>,
}

/// The default of [`LayerForm::simplify_cells`].
fn half() -> f64 {
    0.5
}

fn is_half<T: PartialEq<f64>>(cells: &T) -> bool {
    *cells == half()
}

fn on() -> bool {
    true
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_on(flag: &bool) -> bool {
    *flag
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
