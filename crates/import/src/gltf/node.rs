//! Nodes: the tree of a scene, and where its parts are.

use math::{DMat4, DQuat, DVec3};

use super::document::Document;
use super::json::{Fault, Place, Result};
use crate::log::Log;

/// A translation, a rotation and a scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Trs {
    pub translation: DVec3,
    pub rotation: DQuat,
    pub scale: DVec3,
}

impl Trs {
    pub fn matrix(&self) -> DMat4 {
        DMat4::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }
}

/// Where a node is, relative to its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Placement {
    Matrix(DMat4),
    Trs(Trs),
}

impl Placement {
    pub fn matrix(&self) -> DMat4 {
        match self {
            Self::Matrix(matrix) => *matrix,
            Self::Trs(trs) => trs.matrix(),
        }
    }
}

/// A node.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub placement: Placement,
    pub children: Vec<usize>,
    pub mesh: Option<usize>,
    pub camera: Option<usize>,
    pub light: Option<usize>,
    pub skin: Option<usize>,
    /// Weights of morph targets, if they are not those of the mesh.
    pub weights: Option<Vec<f64>>,
    /// Whether it and its children are drawn.
    pub is_visible: bool,
    parent: Option<usize>,
    pointer: String,
}

impl Node {
    fn parse(document: &Document, place: &Place) -> Result<Self> {
        let matrix = place.numbers::<16>("matrix")?;
        let (translation, rotation, scale) = (
            place.numbers::<3>("translation")?,
            place.numbers::<4>("rotation")?,
            place.numbers::<3>("scale")?,
        );
        let placement = match matrix {
            Some(matrix) if translation.is_none() && rotation.is_none() && scale.is_none() => {
                Placement::Matrix(DMat4::from_cols_array(&matrix))
            }
            Some(_) => {
                let message = "a node has either a matrix or a translation, rotation and scale";
                return Err(place.invalid_member("matrix", message));
            }
            None => {
                let rotation = DQuat::from_array(rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]));
                if rotation.length_squared() < 1e-12 {
                    return Err(place.invalid_member("rotation", "a rotation is not zero"));
                }
                Placement::Trs(Trs {
                    translation: translation.unwrap_or([0.0; 3]).into(),
                    rotation: rotation.normalize(),
                    scale: scale.unwrap_or([1.0; 3]).into(),
                })
            }
        };
        let count = document.count("nodes");
        let children = place.array("children")?;
        let children = children.iter().map(|child| child.as_index(count, "nodes")).collect::<Result<_>>()?;
        let light = match place.extension("KHR_lights_punctual")? {
            Some(extension) => {
                let lights = super::light::places(document)?.len();
                let index = extension.index("light", lights, "extensions/KHR_lights_punctual/lights")?;
                Some(index.ok_or_else(|| extension.invalid("`light` is missing"))?)
            }
            None => None,
        };
        let is_visible = match place.extension("KHR_node_visibility")? {
            Some(extension) => extension.boolean("visible", true)?,
            None => true,
        };
        let weights = place.array("weights")?;
        let weights = weights.iter().map(Place::as_number).collect::<Result<Vec<_>>>()?;
        Ok(Self {
            placement,
            children,
            mesh: document.index(place, "mesh", "meshes")?,
            camera: document.index(place, "camera", "cameras")?,
            skin: document.index(place, "skin", "skins")?,
            light,
            weights: (!weights.is_empty()).then_some(weights),
            is_visible,
            parent: None,
            pointer: place.pointer.clone(),
        })
    }
}

/// All nodes of a text.
#[derive(Clone, Debug, Default)]
pub(super) struct Nodes {
    pub nodes: Vec<Node>,
}

impl Nodes {
    /// Reads all nodes. What is wrong with them is reported; then there may be none.
    pub fn read(document: &Document, log: &mut Log) -> Self {
        let nodes = document.items("nodes").map(|place| log.keep(Node::parse(document, &place)));
        let nodes: Vec<_> = nodes.collect();
        if nodes.len() != document.count("nodes") || nodes.iter().any(Option::is_none) {
            return Self::default();
        }
        let mut nodes = Self { nodes: nodes.into_iter().flatten().collect() };
        match nodes.connect() {
            Ok(()) => nodes,
            Err(fault) => {
                log.fault(fault);
                Self::default()
            }
        }
    }

    /// Finds the parents; an error where the nodes are no trees.
    fn connect(&mut self) -> Result<()> {
        for parent in 0..self.nodes.len() {
            for (at, child) in self.nodes[parent].children.clone().into_iter().enumerate() {
                if let Some(other) = self.nodes[child].parent.replace(parent) {
                    let pointer = format!("{}/children/{at}", self.nodes[parent].pointer);
                    let message = format!("node {child} is a child of node {other} already");
                    return Err(Fault::new("invalid-gltf", pointer, message));
                }
            }
        }
        // Every node has one parent at most, so that what no root leads to is a ring.
        let roots = self.roots();
        let mut reached = vec![false; self.nodes.len()];
        let mut open = roots;
        while let Some(node) = open.pop() {
            reached[node] = true;
            open.extend(&self.nodes[node].children);
        }
        match reached.iter().position(|reached| !reached) {
            Some(node) => {
                Err(Fault::new("invalid-gltf", &self.nodes[node].pointer, "this node is its own descendant"))
            }
            None => Ok(()),
        }
    }

    /// The nodes without parents.
    pub fn roots(&self) -> Vec<usize> {
        (0..self.nodes.len()).filter(|&node| self.nodes[node].parent.is_none()).collect()
    }

    /// The nodes of a scene that are drawn, parents before their children.
    pub fn below(&self, roots: &[usize]) -> Vec<usize> {
        let mut drawn = Vec::new();
        let mut open: Vec<usize> = roots.iter().rev().copied().collect();
        while let Some(node) = open.pop() {
            if self.nodes[node].is_visible {
                drawn.push(node);
                open.extend(self.nodes[node].children.iter().rev());
            }
        }
        drawn
    }

    /// Where all nodes are in the world.
    pub fn world(&self) -> Vec<DMat4> {
        let mut world = vec![DMat4::IDENTITY; self.nodes.len()];
        let mut open = self.roots();
        while let Some(index) = open.pop() {
            let node = &self.nodes[index];
            let parent = node.parent.map_or(DMat4::IDENTITY, |parent| world[parent]);
            world[index] = parent * node.placement.matrix();
            open.extend(&node.children);
        }
        world
    }
}

/// The scene that is drawn: the chosen one, else the text's own, else the first; `None` if there is
/// none.
pub(super) fn scene_index(document: &Document, chosen: Option<usize>) -> Result<Option<usize>> {
    let count = document.count("scenes");
    match (chosen, document.index(&document.root(), "scene", "scenes")?) {
        (Some(chosen), _) if chosen >= count => {
            let message = format!("there is no scene {chosen}; there are {count}");
            Err(Fault::new("unknown-choice", "/scenes", message))
        }
        (Some(index), _) | (None, Some(index)) => Ok(Some(index)),
        (None, None) => Ok((count > 0).then_some(0)),
    }
}

/// The roots of a scene.
pub(super) fn scene_roots(scene: &Place, document: &Document, nodes: &Nodes) -> Result<Vec<usize>> {
    let count = document.count("nodes");
    let roots = scene.array("nodes")?;
    let mut seen = std::collections::HashSet::new();
    let mut indices = Vec::new();
    for place in &roots {
        let node = place.as_index(count, "nodes")?;
        if !seen.insert(node) {
            return Err(place.invalid(format!("node {node} is in this scene twice")));
        }
        if nodes.nodes.get(node).is_some_and(|node| node.parent.is_some()) {
            return Err(place.invalid(format!("node {node} has a parent, so that it is no root")));
        }
        indices.push(node);
    }
    indices.retain(|&node| node < nodes.nodes.len());
    Ok(indices)
}
