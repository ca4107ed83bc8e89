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
//! A picture is square, in the equal-area octahedral mapping, and interpolated bilinearly. Each of
//! its pixels is computed when a reflection first looks it up, from random numbers of its own, so
//! that it does not depend on which ray that is.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError, RwLock};

use description::WhittedDesc;
use geometry::Hit;
use image::{Projection, WrapMode};
use math::{Point3, Ray, RayDifferential, Vec2, Vector3};
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
        let last = known.map_or_else(
            || (circumstances, Arc::new(Surroundings::new(circumstances.0))),
            |place| all.remove(place),
        );
        let surroundings = Arc::clone(&last.1);
        all.truncate(Self::MOST - 1);
        all.insert(0, last);
        surroundings
    }
}

/// The pictures of objects. An object has none where there is no memory for it.
#[derive(Debug, Default)]
pub(crate) struct Surroundings {
    /// Pixels along an edge of a picture.
    resolution: u32,
    pictures: RwLock<HashMap<Object, Option<Arc<Picture>>>>,
}

impl Surroundings {
    fn new(settings: WhittedDesc) -> Self {
        Self { resolution: settings.reflection_resolution, ..Self::default() }
    }

    /// The radiance that arrives from direction `w`, of unit length, at the place of the object
    /// that was hit, as `rays()` estimate it, beyond a distance. Black after a cancellation.
    pub fn radiance<R: RayIntegrator>(
        &self,
        hit: &Hit,
        w: Vector3,
        lambda: &SampledWavelengths,
        rays: impl Fn() -> R,
        beyond: f32,
        tracer: &mut Tracer,
    ) -> SampledSpectrum {
        let object = Object::of(hit);
        let known = self.pictures.read().unwrap_or_else(PoisonError::into_inner).get(&object).cloned();
        let picture = known.unwrap_or_else(|| {
            let mut pictures = self.pictures.write().unwrap_or_else(PoisonError::into_inner);
            let picture = || Picture::new(place(hit, tracer), self.resolution).map(Arc::new);
            pictures.entry(object).or_insert_with(picture).clone()
        });
        let pixel = |at| pixel(at, object, picture.as_deref()?, &rays(), beyond, tracer);
        let rgb = picture.as_ref().and_then(|picture| picture.at(w, pixel)).unwrap_or_default();
        SpectrumType::Illuminant.sample_rgb(color_space(), rgb.to_array(), lambda)
    }
}

/// The picture of what surrounds an object.
#[derive(Debug)]
pub(crate) struct Picture {
    /// The place of the object.
    center: Point3,
    /// Pixels along an edge.
    resolution: u32,
    pixels: Box<[OnceLock<Rgb>]>,
}

impl Picture {
    /// A picture without pixels yet; `None` if there is no memory for it.
    fn new(center: Point3, resolution: u32) -> Option<Self> {
        let count = resolution as usize * resolution as usize;
        let mut pixels = Vec::new();
        pixels.try_reserve_exact(count).ok()?;
        pixels.resize_with(count, OnceLock::new);
        Some(Self { center, resolution, pixels: pixels.into() })
    }

    /// The radiance from a direction of unit length, of the four pixels around it, each of which
    /// `compute` computes if it is not known; `None` if it gives none.
    fn at(&self, w: Vector3, mut compute: impl FnMut([u32; 2]) -> Option<Rgb>) -> Option<Rgb> {
        let place = PROJECTION.position(w);
        let [x, y] = [place.x, place.y].map(|t| t * self.resolution as f32 - 0.5);
        // The pixels on both sides along an axis, each with its weight.
        let sides = |t: f32| {
            let (first, weight) = (t.floor(), t - t.floor());
            [(first as i32, 1.0 - weight), (first as i32 + 1, weight)]
        };
        let mut sum = Rgb::default();
        for (y, weight_y) in sides(y) {
            for (x, weight_x) in sides(x) {
                let (x, y) = WRAP.apply(x, y, self.resolution, self.resolution)?;
                let pixel = &self.pixels[(y * self.resolution + x) as usize];
                let value = match pixel.get() {
                    Some(value) => *value,
                    None => {
                        let value = compute([x, y])?;
                        *pixel.get_or_init(|| value)
                    }
                };
                sum += value * (weight_x * weight_y);
            }
        }
        Some(sum)
    }
}

/// The mapping of pictures, and what lies beyond their edges.
const PROJECTION: Projection = Projection::EqualArea;
const WRAP: WrapMode = WrapMode::OctahedralSphere;

/// The colour space of pictures.
fn color_space() -> &'static RgbColorSpace {
    RgbColorSpace::rec2020()
}

/// Where an object is seen from: the middle of its box, or of the scene if it has none.
fn place(hit: &Hit, tracer: &Tracer) -> Point3 {
    let center = tracer.scene.world().bounds_around(hit).centroid();
    if center.is_finite() { center } else { tracer.scene.sphere().center }
}

/// A pixel of the picture of what surrounds an object beyond a distance, with radiance as `rays`
/// estimate it; `None` after a cancellation.
fn pixel(
    [x, y]: [u32; 2],
    object: Object,
    picture: &Picture,
    rays: &impl RayIntegrator,
    beyond: f32,
    tracer: &mut Tracer,
) -> Option<Rgb> {
    let mut sampler = Sampler::Independent(Independent::new(SAMPLES, 0));
    let mut sum = Rgb::default();
    for index in 0..SAMPLES {
        sampler.start_pixel_sample([x as i32, y as i32], index, 0);
        let place = sampler.get_pixel_2d() + Vec2::new(x as f32, y as f32);
        let w = PROJECTION.direction(place / picture.resolution as f32);
        let mut lambda = SampledWavelengths::sample_visible((index as f32 + 0.5) / SAMPLES as f32);
        let l = tracer.apart(&mut sampler, |tracer| {
            let ray = leave(object, Ray::new(picture.center + w * beyond, w, 0.0), tracer);
            rays.li(tracer, RayDifferential::from(ray), &mut lambda)
        });
        sum += color_space().to_rgb(xyz_from(&l, &lambda));
    }
    tracer.finish().ok()?;
    Some(sum.clamp_zero() / SAMPLES as f32)
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
