//! Uses of modules as a directed graph: its cycles, and its nodes by rank.

use std::{
    collections::{BTreeMap, BTreeSet},
    fmt,
    path::Path,
};

use petgraph::{
    algo::tarjan_scc,
    graph::{DiGraph, NodeIndex},
};

use crate::{
    source::Crate,
    uses::{Use, files_of},
};

/// A directed graph of uses. Its nodes are the files of a crate, or the child modules of one
/// module, each including everything below it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Graph {
    /// The crate's `src`, or the module whose children the nodes are.
    pub place: String,
    /// The nodes, sorted.
    pub nodes: Vec<String>,
    /// Edges from the user to the used node, with the names that are used.
    pub edges: BTreeMap<(String, String), BTreeSet<String>>,
}

/// Nodes that use each other, directly or through others.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cycle {
    /// The graph's crate or module.
    pub place: String,
    /// The nodes of the cycle, sorted.
    pub nodes: Vec<String>,
    /// The edges between them, with the names used.
    pub edges: Vec<String>,
}

impl fmt::Display for Cycle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} use each other", self.place, self.nodes.join(", "))?;
        for edge in &self.edges {
            write!(f, "\n  {edge}")?;
        }
        Ok(())
    }
}

impl Graph {
    /// The graph of a crate's files.
    #[must_use]
    pub fn of_files(of: &Crate, uses: &[Use]) -> Self {
        let text = |path: &Path| path.to_string_lossy().into_owned();
        let mut graph = Self {
            place: format!("{}/src", of.name),
            nodes: files_of(of).iter().map(|file| text(file)).collect(),
            edges: BTreeMap::new(),
        };
        for found in uses {
            let [from, to] = found.files(of);
            graph.add(text(from), text(to), &found.name);
        }
        graph
    }

    /// The graphs of all modules with children. Each child includes everything below it. Two
    /// folders may use each other although no two of their files do; that is a cycle, too.
    #[must_use]
    pub fn of_children(of: &Crate, uses: &[Use]) -> Vec<Self> {
        let mut graphs: BTreeMap<usize, Self> = BTreeMap::new();
        for (index, module) in of.modules.iter().enumerate() {
            if module.children.is_empty() {
                continue;
            }
            let mut place = vec![of.name.clone()];
            place.extend(module.path.iter().cloned());
            let nodes = module.children.keys().cloned().collect();
            graphs.insert(index, Self { place: place.join("::"), nodes, edges: BTreeMap::new() });
        }
        for found in uses {
            let [from, to] = [found.user, found.owner].map(|module| &of.modules[module].path);
            let common = from.iter().zip(to).take_while(|(a, b)| a == b).count();
            // A module and a module below it are not siblings.
            if from.len() == common || to.len() == common {
                continue;
            }
            let parent = of.modules.iter().position(|module| module.path == from[..common]);
            if let Some(graph) = parent.and_then(|parent| graphs.get_mut(&parent)) {
                graph.add(from[common].clone(), to[common].clone(), &found.name);
            }
        }
        graphs.into_values().collect()
    }

    fn add(&mut self, from: String, to: String, name: &str) {
        self.edges.entry((from, to)).or_default().insert(name.to_owned());
    }

    /// Groups of nodes that use each other, sorted.
    #[must_use]
    pub fn cycles(&self) -> Vec<Cycle> {
        let mut cycles: Vec<Cycle> = self
            .components()
            .into_iter()
            .filter(|nodes| nodes.len() > 1)
            .map(|nodes| {
                let inside =
                    |(from, to): &(String, String)| nodes.contains(from) && nodes.contains(to);
                let edges = self.edges.iter().filter(|(ends, _)| inside(ends));
                let edges = edges
                    .map(|((from, to), names)| {
                        let names: Vec<&str> = names.iter().map(String::as_str).collect();
                        format!("{from} -> {to}: {}", names.join(", "))
                    })
                    .collect();
                Cycle { place: self.place.clone(), nodes, edges }
            })
            .collect();
        cycles.sort_by(|a, b| a.nodes.cmp(&b.nodes));
        cycles
    }

    /// The nodes from top to bottom: each has a higher rank than all nodes that it uses. The nodes
    /// of a cycle share a rank.
    #[must_use]
    pub fn ranks(&self) -> Vec<Vec<String>> {
        let mut height: BTreeMap<&str, usize> = BTreeMap::new();
        let components = self.components();
        // Used nodes come before their users.
        for nodes in &components {
            let below = self
                .edges
                .keys()
                .filter(|(from, to)| nodes.contains(from) && !nodes.contains(to))
                .filter_map(|(_, to)| height.get(to.as_str()))
                .max();
            let rank = below.map_or(0, |rank| rank + 1);
            height.extend(nodes.iter().map(|node| (node.as_str(), rank)));
        }
        let top = height.values().max().map_or(0, |rank| rank + 1);
        let mut ranks = vec![Vec::new(); top];
        for (node, rank) in height {
            ranks[top - 1 - rank].push(node.to_owned());
        }
        ranks
    }

    /// Strongly connected components, each sorted; used components come before their users (Tarjan
    /// 1972).
    fn components(&self) -> Vec<Vec<String>> {
        let ends = self.edges.keys().flat_map(|(from, to)| [from, to]);
        let names: BTreeSet<&str> = self.nodes.iter().chain(ends).map(String::as_str).collect();
        let mut graph = DiGraph::<&str, ()>::new();
        let indices: BTreeMap<&str, _> =
            names.into_iter().map(|name| (name, graph.add_node(name))).collect();
        for (from, to) in self.edges.keys() {
            graph.add_edge(indices[from.as_str()], indices[to.as_str()], ());
        }
        let owned = |nodes: Vec<NodeIndex>| {
            let mut nodes: Vec<String> =
                nodes.into_iter().map(|node| graph[node].to_owned()).collect();
            nodes.sort();
            nodes
        };
        tarjan_scc(&graph).into_iter().map(owned).collect()
    }
}
