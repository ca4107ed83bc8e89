//! What is drawn for each instance: nothing, its triangles, or a sprite.

use super::eye::Eye;
use super::lens::Lens;
use super::models::Model;
use super::placements::Placement;
use super::sprites::{Album, SIDE, Sprite};

/// The triangles of instances that a picture may have, on GPUs and where software draws.
pub const BUDGET: [u64; 2] = [40_000_000, 4_000_000];

/// Groups of fewer triangles are never drawn as sprites.
const FEWEST: u64 = 64;

/// What a picture draws.
#[derive(Default)]
pub struct Drawn {
    /// The camera that sees it.
    pub eye: Eye,
    /// The groups that are drawn as triangles, with their first instance and the number of them.
    pub groups: Vec<(u32, std::ops::Range<u32>)>,
    /// The rows of the matrices of instances.
    pub instances: Vec<[[f32; 4]; 3]>,
    /// The sprites, the farthest first.
    pub sprites: Vec<[[f32; 4]; 4]>,
    /// The triangles.
    pub triangles: u64,
}

/// Decides what a camera sees of placements. Those are drawn as triangles that are larger on the
/// picture than a sprite, the largest first, while the budget lasts.
pub fn drawn(
    lens: &Lens,
    models: &[Model],
    placements: &[Placement],
    album: &mut Album,
    budget: u64,
) -> Drawn {
    let mut seen = Vec::new();
    for placement in placements {
        let model = &models[placement.group as usize];
        if model.indices.is_empty() {
            continue;
        }
        let (center, radius) = (placement.point(model.center), model.radius * placement.scale());
        if lens.sees(center, radius) {
            seen.push((lens.pixels_across(center, radius), (center - lens.eye).length(), placement, model));
        }
    }
    // Equally large ones stay in order.
    seen.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut drawn = Drawn::default();
    let (mut whole, mut sprites) = (vec![Vec::new(); models.len()], Vec::new());
    for (pixels, distance, placement, model) in seen {
        let is_single = placement.group == 0 || model.triangles() < FEWEST;
        let fits = drawn.triangles + model.triangles() <= budget;
        if !is_single
            && (pixels < SIDE as f32 || !fits)
            && let Some((sprite, layer)) = album.layer(Sprite::of(placement, model, lens.eye))
        {
            sprites.push((distance, sprite.instance(placement, model, layer)));
            continue;
        }
        drawn.triangles += model.triangles();
        whole[placement.group as usize].push(placement.rows());
    }
    for (rows, group) in whole.into_iter().zip(0..) {
        let first = drawn.instances.len() as u32;
        drawn.instances.extend(rows);
        drawn.groups.push((group, first..drawn.instances.len() as u32));
    }
    drawn.groups.retain(|(_, range)| !range.is_empty());
    sprites.sort_by(|a, b| b.0.total_cmp(&a.0));
    drawn.sprites = sprites.into_iter().map(|(_, sprite)| sprite).collect();
    drawn
}
