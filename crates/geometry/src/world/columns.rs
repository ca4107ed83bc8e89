//! Rays and hits of batches, in columns.

use super::geometry::GeometryId;
use super::hit::Hit;
use super::instance::InstancePath;
use crate::bvh::{Packet, WIDTH};
use lanes::{Each, Int, MAX_LANES, Mask, Real};
use math::{CameraEnd, Ray, Vec2, Vec3, Vector3};

/// Rays of a batch: a column for each of their numbers. Columns may be longer than needed.
#[derive(Clone, Copy, Debug)]
pub struct RayColumns<'a> {
    /// The number of rays.
    pub len: usize,
    /// Origins.
    pub o: [&'a [f32]; 3],
    /// Directions.
    pub d: [&'a [f32]; 3],
    /// Shutter times.
    pub time: &'a [f32],
    /// Ends; `None` where no ray has any.
    pub t_max: Option<&'a [f32]>,
    /// Where the camera is on all of them.
    pub camera: CameraEnd,
}

impl<'a> RayColumns<'a> {
    /// The rays from a place on, `len` at most.
    pub fn part(&self, first: usize, len: usize) -> Self {
        let from = |column: &'a [f32]| &column[first..];
        Self {
            len: len.min(self.len - first),
            o: self.o.each(from),
            d: self.d.each(from),
            time: from(self.time),
            t_max: self.t_max.map(from),
            camera: self.camera,
        }
    }

    /// The number of rays.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is no ray.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The ray at a place in the batch.
    #[inline(always)]
    pub fn ray(&self, place: usize) -> Ray {
        let vector =
            |columns: &[&[f32]; 3]| Vec3::new(columns[0][place], columns[1][place], columns[2][place]);
        Ray { o: vector(&self.o), d: vector(&self.d), time: self.time[place], camera: self.camera }
    }

    /// Its end.
    #[inline(always)]
    pub fn t_max(&self, place: usize) -> f32 {
        self.t_max.map_or(f32::INFINITY, |t_max| t_max[place])
    }

    /// The rays from a place on, one in each lane, and their ends; the last one is repeated.
    #[inline(always)]
    pub(super) fn lanes<R: Real>(&self, first: usize) -> (Vector3<R>, Vector3<R>, R) {
        let len = self.len;
        let [ox, oy, oz] = self.o;
        let [dx, dy, dz] = self.d;
        let o = Vec3::new(load(ox, first, len), load(oy, first, len), load(oz, first, len));
        let d = Vec3::new(load(dx, first, len), load(dy, first, len), load(dz, first, len));
        let t_max = match self.t_max {
            Some(t_max) => load(t_max, first, len),
            None => R::splat(f32::INFINITY),
        };
        (o, d, t_max)
    }

    /// The rays at some places, and those without a direction where there are fewer.
    #[inline(always)]
    pub(super) fn packet(&self, places: impl Iterator<Item = usize>) -> Packet {
        let mut packet = Packet::NONE;
        for (lane, place) in places.enumerate().take(WIDTH) {
            for axis in 0..3 {
                packet.o[axis][lane] = self.o[axis][place];
                packet.d[axis][lane] = self.d[axis][place];
            }
            packet.t_max[lane] = self.t_max(place);
        }
        packet
    }

    /// The same of sixteen rays from a place on.
    #[inline(always)]
    pub(super) fn packet_from(&self, first: usize) -> Packet {
        let of = |column: &[f32]| *column[first..].first_chunk().unwrap_or(&[0.0; WIDTH]);
        let t_max = self.t_max.map_or([f32::INFINITY; WIDTH], of);
        Packet { o: self.o.each(of), d: self.d.each(of), t_max }
    }

    /// Prefetches a ray.
    #[inline(always)]
    pub(super) fn prefetch(&self, place: usize) {
        for column in self.o.iter().chain(&self.d) {
            lanes::prefetch(&raw const column[place]);
        }
    }
}

/// The numbers of a column from a place on, where the column has `len`; the last one is repeated.
#[inline(always)]
fn load<R: Real>(column: &[f32], first: usize, len: usize) -> R {
    if first + R::LANES <= len {
        return R::load(&column[first..]);
    }
    let (mut numbers, rest) = ([0.0; MAX_LANES], &column[first..len]);
    for (lane, number) in numbers.iter_mut().enumerate() {
        *number = rest[lane.min(rest.len() - 1)];
    }
    R::load(&numbers)
}

/// Rays that are collected for a batch.
#[derive(Clone, Debug, Default)]
pub struct RayBuffer {
    o: [Vec<f32>; 3],
    d: [Vec<f32>; 3],
    time: Vec<f32>,
    t_max: Vec<f32>,
}

impl RayBuffer {
    /// Adds a ray that ends at `t_max`.
    pub fn push(&mut self, ray: &Ray, t_max: f32) {
        for (column, x) in self.o.iter_mut().zip(ray.o.to_array()) {
            column.push(x);
        }
        for (column, x) in self.d.iter_mut().zip(ray.d.to_array()) {
            column.push(x);
        }
        self.time.push(ray.time);
        self.t_max.push(t_max);
    }

    /// Adds the rays of a mask's lanes.
    #[inline(always)]
    pub fn append<R: Real>(&mut self, ray: &Ray<R>, t_max: R, mask: R::Mask) {
        for (column, x) in self.o.iter_mut().zip([ray.o.x, ray.o.y, ray.o.z]) {
            x.append(mask, column);
        }
        for (column, x) in self.d.iter_mut().zip([ray.d.x, ray.d.y, ray.d.z]) {
            x.append(mask, column);
        }
        ray.time.append(mask, &mut self.time);
        t_max.append(mask, &mut self.t_max);
    }

    /// Removes all rays.
    pub fn clear(&mut self) {
        self.o.iter_mut().chain(&mut self.d).for_each(Vec::clear);
        [&mut self.time, &mut self.t_max].into_iter().for_each(Vec::clear);
    }

    /// All rays.
    pub fn columns(&self) -> RayColumns<'_> {
        let [ox, oy, oz] = &self.o;
        let [dx, dy, dz] = &self.d;
        RayColumns {
            len: self.time.len(),
            o: [ox, oy, oz],
            d: [dx, dy, dz],
            time: &self.time,
            t_max: Some(&self.t_max),
            camera: CameraEnd::Neither,
        }
    }
}

impl FromIterator<(Ray, f32)> for RayBuffer {
    fn from_iter<I: IntoIterator<Item = (Ray, f32)>>(rays: I) -> Self {
        let mut buffer = Self::default();
        rays.into_iter().for_each(|(ray, t_max)| buffer.push(&ray, t_max));
        buffer
    }
}

/// Hits of a batch, in columns.
#[derive(Clone, Debug, Default)]
pub struct HitColumns {
    /// Distances; without a meaning for rays that hit nothing, as the other numbers.
    pub t: Vec<f32>,
    /// Parameters, as [`Hit::uv`].
    pub uv: [Vec<f32>; 2],
    /// Geometries; [`Self::NONE`] where nothing is hit.
    pub geometry: Vec<u32>,
    /// Primitives.
    pub primitive: Vec<u32>,
    /// Empty where all hits are in the top group.
    instance: Vec<InstancePath>,
}

impl HitColumns {
    /// In place of a geometry where nothing is hit.
    pub const NONE: u32 = u32::MAX;

    /// The number of rays.
    pub fn len(&self) -> usize {
        self.geometry.len()
    }

    /// Whether there is no ray.
    pub fn is_empty(&self) -> bool {
        self.geometry.is_empty()
    }

    /// A hit.
    #[inline]
    pub fn get(&self, place: usize) -> Option<Hit> {
        (self.geometry[place] != Self::NONE).then(|| Hit {
            t: self.t[place],
            uv: Vec2::new(self.uv[0][place], self.uv[1][place]),
            geometry: GeometryId(self.geometry[place]),
            primitive: self.primitive[place],
            instance: if self.instance.is_empty() { InstancePath::TOP } else { self.instance[place] },
        })
    }

    /// Whether a hit is in the top group itself.
    #[inline]
    pub fn is_in_top_group(&self, place: usize) -> bool {
        self.instance.get(place).is_none_or(InstancePath::is_top)
    }

    /// The hits of these places that are in the top group itself.
    #[inline(always)]
    pub(super) fn in_top_group<R: Real>(&self, places: R::Int) -> R::Mask {
        if self.instance.is_empty() {
            return R::Mask::splat(true);
        }
        let places = places.to_array();
        let mut bits = 0;
        for (lane, &place) in places[..R::LANES].iter().enumerate() {
            bits |= (self.instance[place as usize].is_top() as u32) << lane;
        }
        R::Mask::from_bits(bits)
    }

    /// Room for the hits of `len` rays, whatever they are.
    pub(super) fn reset(&mut self, len: usize) {
        let [u, v] = &mut self.uv;
        [&mut self.t, u, v].into_iter().for_each(|column| column.resize(len, 0.0));
        [&mut self.geometry, &mut self.primitive]
            .into_iter()
            .for_each(|column| column.resize(len, Self::NONE));
        self.instance.clear();
    }

    #[inline(always)]
    pub(super) fn set(&mut self, place: usize, hit: Option<Hit>) {
        let Some(Hit { t, uv, geometry, primitive, instance }) = hit else {
            self.geometry[place] = Self::NONE;
            return;
        };
        self.t[place] = t;
        self.uv[0][place] = uv.x;
        self.uv[1][place] = uv.y;
        self.geometry[place] = geometry.0;
        self.primitive[place] = primitive;
        if !instance.is_top() && self.instance.is_empty() {
            self.instance.resize(self.geometry.len(), InstancePath::TOP);
        }
        if let Some(path) = self.instance.get_mut(place) {
            *path = instance;
        }
    }

    /// Sets the hits from a place on, as many as there are.
    #[inline(always)]
    pub(super) fn set_lanes<R: Real>(
        &mut self,
        first: usize,
        t: R,
        [u, v]: [R; 2],
        geometry: R::Int,
        primitive: R::Int,
    ) {
        let [us, vs] = &mut self.uv;
        for (column, x) in [&mut self.t, us, vs].into_iter().zip([t, u, v]) {
            match column.get_mut(first..first + R::LANES) {
                Some(column) => x.store(column),
                None => copy(&mut column[first..], &x.to_array()),
            }
        }
        for (column, x) in [&mut self.geometry, &mut self.primitive].into_iter().zip([geometry, primitive]) {
            match column.get_mut(first..first + R::LANES) {
                Some(column) => x.store(column),
                None => copy(&mut column[first..], &x.to_array()),
            }
        }
    }

    /// Prefetches the place of a hit.
    #[inline(always)]
    pub(super) fn prefetch(&self, place: usize) {
        for column in [&self.t, &self.uv[0], &self.uv[1]] {
            lanes::prefetch(&raw const column[place]);
        }
        for column in [&self.geometry, &self.primitive] {
            lanes::prefetch(&raw const column[place]);
        }
    }
}

#[inline(always)]
fn copy<T: Copy>(to: &mut [T], from: &[T]) {
    to.copy_from_slice(&from[..to.len()]);
}
