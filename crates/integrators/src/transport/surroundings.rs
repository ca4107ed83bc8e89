//! Pictures of the surroundings of objects, which reflections show instead of traced rays.
//!
//! An environment map is the radiance that arrives at one point, by direction ([Blinn & Newell
//! 1976]). Reflections that look it up by their direction alone are right where everything is far
//! away, and wrong nearby: the object itself is missing, and what stands close is shifted. The
//! point is the centre of a box around the object. An object is an instance with everything in it,
//! or a shape outside of instances.
//!
//! Where rays are traced nearby, what is near must not be in the picture, too: it is of what lies
//! beyond a distance from that point.
//!
//! A picture is square, in the equal-area octahedral mapping, and interpolated bilinearly. It is
//! made when the first ray is reflected by its object, from random numbers of its own, so that it
//! does not depend on which ray that is.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError, RwLock};

use description::WhittedDesc;
use geometry::Hit;
use image::{Image, Projection};
use math::{Ray, RayDifferential, Vec2, Vector3};
use sampling::Sampler;
use sampling::sampler::Independent;
use scene::ViewOptions;
use scene::medium::MediumId;
use scene::texture::SpectrumType;
use spectrum::{Rgb, RgbColorSpace, SampledSpectrum, SampledWavelengths, xyz_from};

use crate::{RayIntegrator, Tracer};

/// Samples of a pixel.
const SAMPLES: u32 = 16;

/// An object may be left through that many of its own surfaces.
const MAX_LAYERS: u32 = 1000;

/// An object that reflects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Object {
    /// The outermost instance.
    Instance(u32),
    /// A geometry outside of instances.
    Geometry(u32),
}

impl Object {
    /// The object that was hit.
    pub fn of(hit: &Hit) -> Self {
        match hit.instance.ids().first() {
            Some(instance) => Self::Instance(instance.0),
            None => Self::Geometry(hit.geometry.0),
        }
    }
}

/// What pictures depend on besides the scene.
pub(crate) type Circumstances = (WhittedDesc, Option<MediumId>, ViewOptions);

/// The pictures of a scene in the last circumstances. They are the same from wherever the scene is
/// viewed.
#[derive(Debug, Default)]
pub(crate) struct AllSurroundings(Mutex<Vec<(Circumstances, Arc<Surroundings>)>>);

impl AllSurroundings {
    /// The most circumstances of which pictures are kept.
    const MOST: usize = 4;

    /// The pictures that have been made in these circumstances.
    pub fn of(&self, circumstances: Circumstances) -> Arc<Surroundings> {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let known = all.iter().position(|(known, _)| *known == circumstances);
        let last = known.map_or_else(|| (circumstances, Arc::default()), |place| all.remove(place));
        let surroundings = Arc::clone(&last.1);
        all.truncate(Self::MOST - 1);
        all.insert(0, last);
        surroundings
    }
}

/// The pictures that have been made.
#[derive(Debug, Default)]
pub(crate) struct Surroundings(RwLock<HashMap<Object, Arc<Image>>>);

impl Surroundings {
    /// The radiance that arrives from direction `w`, of unit length, at the place of the object
    /// that was hit, whose picture `make` makes if there is none yet; black without it.
    pub fn radiance(
        &self,
        hit: &Hit,
        (w, lambda): (Vector3, &SampledWavelengths),
        make: impl FnOnce() -> Option<Image>,
    ) -> SampledSpectrum {
        let object = Object::of(hit);
        let known = self.0.read().unwrap_or_else(PoisonError::into_inner).get(&object).cloned();
        let picture = match known {
            Some(picture) => picture,
            None => {
                let Some(picture) = make() else { return SampledSpectrum::ZERO };
                let mut pictures = self.0.write().unwrap_or_else(PoisonError::into_inner);
                pictures.entry(object).or_insert(Arc::new(picture)).clone()
            }
        };
        let projection = Projection::EqualArea;
        let rgb = picture.bilerp_rgb(projection.position(w), projection.wrap());
        SpectrumType::Illuminant.sample_rgb(color_space(), rgb, lambda)
    }
}

/// The colour space of pictures.
fn color_space() -> &'static RgbColorSpace {
    RgbColorSpace::rec2020()
}

/// The picture of what surrounds the object that was hit, beyond a distance, with `resolution`
/// pixels along an edge and radiance as `rays` estimate it; `None` after a cancellation, and where
/// there is no memory for it.
pub(crate) fn picture(
    hit: &Hit,
    rays: &impl RayIntegrator,
    (resolution, beyond): (u32, f32),
    tracer: &mut Tracer,
) -> Option<Image> {
    let (object, bounds) = (Object::of(hit), tracer.scene.world().bounds_around(hit));
    let center = bounds.centroid();
    let center = if center.is_finite() { center } else { tracer.scene.sphere().center };
    let mut sampler = Sampler::Independent(Independent::new(SAMPLES, 0));
    let picture = Image::try_from_fn(resolution, resolution, ["R", "G", "B"], |x, y| {
        let mut sum = Rgb::splat(0.0);
        for index in 0..SAMPLES {
            sampler.start_pixel_sample([x as i32, y as i32], index, 0);
            let place = sampler.get_pixel_2d() + Vec2::new(x as f32, y as f32);
            let w = Projection::EqualArea.direction(place / resolution as f32);
            let mut lambda = SampledWavelengths::sample_visible((index as f32 + 0.5) / SAMPLES as f32);
            let l = tracer.apart(&mut sampler, |tracer| {
                let ray = leave(object, Ray::new(center + w * beyond, w, 0.0), tracer);
                rays.li(tracer, RayDifferential::from(ray), &mut lambda)
            });
            sum += color_space().to_rgb(xyz_from(&l, &lambda));
        }
        (sum.clamp_zero() / SAMPLES as f32).to_array()
    });
    tracer.finish().ok()?;
    picture.ok()
}

/// A ray, or its part behind all surfaces of an object that it hits before others.
fn leave(object: Object, mut ray: Ray, tracer: &mut Tracer) -> Ray {
    for _ in 0..MAX_LAYERS {
        match tracer.hit(&ray) {
            Some(hit) if Object::of(&hit) == object => {
                let scene = tracer.scene;
                ray = scene.interaction(&hit, scene.world().surface(&ray, &hit)).spawn_ray(ray.d);
            }
            _ => break,
        }
    }
    ray
}
