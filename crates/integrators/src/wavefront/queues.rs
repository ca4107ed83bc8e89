//! What stages hand to each other.

use lanes::{Each, MAX_LANES, Mask, Real};
use math::{Ray, Vec3};
use spectrum::SampledSpectrum;

use super::columns::Rows;

/// The queues of a batch.
#[derive(Default)]
pub(super) struct Queues {
    /// The paths that go on.
    pub next: Vec<u32>,
    /// Hits to be shaded one by one: path, and index of its hit.
    pub scalar: Vec<(u32, u32)>,
    /// Shadow rays; those that interfaces occlude, and those that pass them.
    pub shadows: [Vec<ShadowRay>; 2],
}

/// A shadow ray, and the light that its path gets unless it is occluded.
pub(super) struct ShadowRay {
    pub path: u32,
    pub l: SampledSpectrum,
    pub ray: Ray,
    pub t_max: f32,
}

/// Shadow rays in lanes.
pub(super) struct Shadow<R: Real> {
    pub l: SampledSpectrum<R>,
    pub ray: Ray<R>,
    pub t_max: R,
}

impl Queues {
    /// Adds the shadow rays of a mask's lanes, which pass interfaces where `passes` is true.
    #[inline(always)]
    pub fn push_shadows<R: Real>(
        &mut self,
        rows: Rows<R>,
        mask: R::Mask,
        passes: R::Mask,
        shadow: &Shadow<R>,
    ) {
        let Shadow { l, ray, t_max } = shadow;
        let l = l.0.each(R::to_array);
        let [o, d] = [ray.o, ray.d].each(|v| v.to_array().each(R::to_array));
        let (time, t_max, passes) = (ray.time.to_array(), t_max.to_array(), passes.bits());
        rows.each_of(mask, |lane, row| {
            let vector = |v: &[[f32; MAX_LANES]; 3]| Vec3::from_array(v.each(|c| c[lane]));
            self.shadows[(passes >> lane & 1) as usize].push(ShadowRay {
                path: row as u32,
                l: SampledSpectrum(l.each(|l| l[lane])),
                ray: Ray::new(vector(&o), vector(&d), time[lane]),
                t_max: t_max[lane],
            });
        });
    }
}
