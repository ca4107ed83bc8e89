//! The choice of a light.
//!
//! | words | choice |
//! |---|---|
//! | `Uniform` | each light alike |
//! | `Power`, and for each light 4 words from the fifth on: threshold, probability, alias, 0 | in proportion to power |
//! | `Tree`, offsets of nodes, trails and infinite lights, the number of these and of nodes, the probability of them all | through a tree |
//!
//! A node of the tree is 16 words: the numbers of its cluster, its kind, and zeros.

use description::Span;
use scene::light_sampler::{LightSampler, PowerLightSampler};

use super::Flattener;
use crate::tags::ChoiceTag;

impl Flattener<'_> {
    /// The choice of lights; its offset.
    pub fn light_choice(&mut self, lights: &LightSampler) -> u32 {
        match lights {
            LightSampler::Uniform(_) => self.slab.add([ChoiceTag::Uniform as u32]),
            LightSampler::Power(power) => {
                let at = self.slab.add([ChoiceTag::Power as u32, 0, 0, 0]);
                self.slab.extend(bins(power));
                at
            }
            LightSampler::Bvh(tree) => {
                let nodes = tree.nodes();
                let count = nodes.len() as u32;
                let node = |(numbers, kind): (&[f32], u32)| {
                    numbers.iter().map(|x| x.to_bits()).chain([kind, 0, 0, 0]).collect::<Vec<u32>>()
                };
                let nodes = self.slab.add(nodes.flat_map(node));
                let trails = self.slab.add(tree.trails().flatten());
                let (ids, probability) = tree.infinite();
                let infinite = self.slab.add(ids.iter().copied());
                self.slab.add([
                    ChoiceTag::Tree as u32,
                    nodes,
                    trails,
                    infinite,
                    ids.len() as u32,
                    count,
                    probability.to_bits(),
                ])
            }
            LightSampler::Exhaustive(_) => {
                self.refuse("light sampler `exhaustive`", Span::NONE);
                0
            }
        }
    }

    /// The four words of each light that is chosen in proportion to power; their offset.
    pub fn power(&mut self, power: &PowerLightSampler) -> u32 {
        self.slab.add(bins(power))
    }
}

fn bins(power: &PowerLightSampler) -> impl Iterator<Item = u32> {
    let bins = power.table().into_iter().flat_map(|table| table.bins());
    bins.flat_map(|(threshold, pmf, alias)| [threshold.to_bits(), pmf.to_bits(), alias, 0])
}
