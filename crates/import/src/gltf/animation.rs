//! Animations: placements of nodes and weights of morph targets at a time.

use math::{DQuat, DVec3};

use super::accessor::Accessor;
use super::buffer::Buffers;
use super::document::Document;
use super::json::{Place, Result};
use super::node::{Nodes, Placement};
use super::primitive;

/// What a channel moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Target {
    Translation,
    Rotation,
    Scale,
    Weights,
}

/// What is between two keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Interpolation {
    Step,
    Linear,
    /// Cubic Hermite splines, whose keys have a tangent before and after.
    CubicSpline,
}

/// A part of an animation: what one property of a node is over time.
#[derive(Clone, Debug)]
struct Channel {
    node: usize,
    target: Target,
    interpolation: Interpolation,
    /// Seconds, increasing.
    times: Vec<f32>,
    /// Values of all keys, one after another.
    values: Vec<f32>,
    /// Numbers of a value.
    width: usize,
}

/// An animation.
#[derive(Clone, Debug)]
pub(super) struct Animation {
    channels: Vec<Channel>,
}

impl Animation {
    /// Reads an animation.
    pub fn parse(document: &Document, buffers: &Buffers, place: &Place) -> Result<Self> {
        let samplers = place.array("samplers")?;
        let channels = place.array("channels")?;
        if samplers.is_empty() || channels.is_empty() {
            return Err(place.invalid("an animation has samplers and channels"));
        }
        let mut parsed = Vec::new();
        for channel in &channels {
            let index = channel.index("sampler", samplers.len(), "samplers")?;
            let sampler = &samplers[index.ok_or_else(|| channel.invalid("`sampler` is missing"))?];
            let target = channel.object("target")?.ok_or_else(|| channel.invalid("`target` is missing"))?;
            let node = document.index(&target, "node", "nodes")?;
            let path = match target.string("path")? {
                Some("translation") => Target::Translation,
                Some("rotation") => Target::Rotation,
                Some("scale") => Target::Scale,
                Some("weights") => Target::Weights,
                // Of KHR_animation_pointer, which is reported where it is used.
                Some("pointer") => continue,
                _ => {
                    let message = "this must be translation, rotation, scale or weights";
                    return Err(target.invalid_member("path", message));
                }
            };
            let Some(node) = node else { continue };
            parsed.push(Channel::parse(document, buffers, sampler, node, path)?);
        }
        Ok(Self { channels: parsed })
    }

    /// Moves the nodes to where they are at a time.
    pub fn apply(&self, nodes: &mut Nodes, time: f64) {
        for channel in &self.channels {
            let Some(node) = nodes.nodes.get_mut(channel.node) else { continue };
            let value = channel.at(time as f32);
            if channel.target == Target::Weights {
                node.weights = Some(value);
                continue;
            }
            let Placement::Trs(trs) = &mut node.placement else { continue };
            match (channel.target, value.as_slice()) {
                (Target::Translation, &[x, y, z]) => trs.translation = DVec3::new(x, y, z),
                (Target::Scale, &[x, y, z]) => trs.scale = DVec3::new(x, y, z),
                (Target::Rotation, &[x, y, z, w]) => trs.rotation = DQuat::from_xyzw(x, y, z, w).normalize(),
                _ => (),
            }
        }
    }
}

impl Channel {
    fn parse(
        document: &Document,
        buffers: &Buffers,
        sampler: &Place,
        node: usize,
        target: Target,
    ) -> Result<Self> {
        let accessor = |key: &str| {
            Accessor::of(document, sampler, key)?
                .ok_or_else(|| sampler.invalid(format!("`{key}` is missing")))
        };
        let interpolation = match sampler.string("interpolation")? {
            None | Some("LINEAR") => Interpolation::Linear,
            Some("STEP") => Interpolation::Step,
            Some("CUBICSPLINE") => Interpolation::CubicSpline,
            Some(name) => {
                return Err(sampler.invalid_member("interpolation", format!("`{name}` is not a kind of it")));
            }
        };
        let times: Vec<f32> = accessor("input")?.vectors::<1>(buffers)?.into_iter().flatten().collect();
        if times.windows(2).any(|pair| pair[0] >= pair[1]) || times.iter().any(|&time| time < 0.0) {
            return Err(sampler.invalid_member("input", "times increase from 0"));
        }
        let output = accessor("output")?;
        let is_unit = match target {
            Target::Translation | Target::Scale => output.is_float(),
            Target::Rotation | Target::Weights => output.is_float() || output.is_normalized(),
        };
        if !is_unit {
            return Err(sampler.invalid_member(
                "output",
                "values are floats, or normalized integers of rotations and weights",
            ));
        }
        let values: Vec<f32> = match target {
            Target::Translation | Target::Scale => output.vectors::<3>(buffers)?.into_flattened(),
            Target::Rotation => output.vectors::<4>(buffers)?.into_flattened(),
            Target::Weights => output.vectors::<1>(buffers)?.into_flattened(),
        };
        let keys = times.len() * if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let width = match target {
            Target::Translation | Target::Scale => 3,
            Target::Rotation => 4,
            Target::Weights => targets(document, node)?,
        };
        if keys * width != values.len() || width == 0 {
            let message = format!("there are {} numbers for {keys} values of {width}", values.len());
            return Err(sampler.invalid_member("output", message));
        }
        Ok(Self { node, target, interpolation, times, values, width })
    }

    /// The value at a time; that of the first or last key outside of them.
    fn at(&self, time: f32) -> Vec<f64> {
        let after = self.times.partition_point(|&key| key <= time);
        let (Some(before), true) = (after.checked_sub(1), after < self.times.len()) else {
            return self.key(after.min(self.times.len() - 1), 1);
        };
        let (start, end) = (self.key(before, 1), self.key(after, 1));
        let duration = f64::from(self.times[after]) - f64::from(self.times[before]);
        let t = (f64::from(time) - f64::from(self.times[before])) / duration;
        match self.interpolation {
            Interpolation::Step => start,
            Interpolation::Linear if self.target == Target::Rotation => {
                let quaternion = |v: &[f64]| DQuat::from_xyzw(v[0], v[1], v[2], v[3]).normalize();
                quaternion(&start).slerp(quaternion(&end), t).to_array().to_vec()
            }
            Interpolation::Linear => start.iter().zip(&end).map(|(a, b)| a + (b - a) * t).collect(),
            Interpolation::CubicSpline => {
                let (leaving, entering) = (self.key(before, 2), self.key(after, 0));
                let (t2, t3) = (t * t, t * t * t);
                let weights = [
                    2.0 * t3 - 3.0 * t2 + 1.0,
                    duration * (t3 - 2.0 * t2 + t),
                    3.0 * t2 - 2.0 * t3,
                    duration * (t3 - t2),
                ];
                let parts = [start, leaving, end, entering];
                (0..self.width).map(|i| parts.iter().zip(weights).map(|(v, w)| v[i] * w).sum()).collect()
            }
        }
    }

    /// The value of a key: of a spline part 0 is the tangent before, 1 the value and 2 the tangent
    /// after.
    fn key(&self, key: usize, part: usize) -> Vec<f64> {
        let index = if self.interpolation == Interpolation::CubicSpline { 3 * key + part } else { key };
        self.values[index * self.width..][..self.width].iter().map(|&v| f64::from(v)).collect()
    }
}

/// The number of morph targets of a node's mesh.
fn targets(document: &Document, node: usize) -> Result<usize> {
    let Some(place) = document.item("nodes", node) else { return Ok(0) };
    let Some(mesh) = document.index(&place, "mesh", "meshes")? else { return Ok(0) };
    let primitives = primitive::places(document, mesh)?;
    Ok(primitives.first().map_or(Ok(Vec::new()), |primitive| primitive.array("targets"))?.len())
}
