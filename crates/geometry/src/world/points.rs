//! Surface points of the hits of a batch, in columns.
//!
//! Hits on meshes gather their corners from the mesh's own arrays, one hit in each lane. A world of
//! few facets has a table of its primitives instead.

#![allow(unsafe_code)]

use super::World;
use super::columns::{HitColumns, RayColumns};
use super::geometry::{Geometry, GeometryId};
use super::sphere_points::{SphereHits, select};
use crate::patch::{Patch, PatchLanes, PatchPoints};
use crate::shape::{Shape, Triangle, TriangleMesh};
use crate::surface::{Shading, SurfacePoint};
use crate::triples::{triples, vector};
use lanes::{Each, Int, MAX_LANES, Mask, Real, Simd, Task};
use math::{Normal3, Point3Error, Vec2, Vec3, Vector3};

/// Surface points in columns.
#[derive(Clone, Debug, Default)]
pub struct PointColumns {
    /// Position, its error, normal, shading normal, ∂p/∂u, ∂p/∂v, shading tangent, and texture
    /// coordinates.
    values: [Vec<f32>; PointColumns::COLUMNS],
    /// Of shading ∂p/∂v, ∂n/∂u and ∂n/∂v.
    shading: [Vec<f32>; 3 + 3 + 3],
    /// 1 where lanes have computed a point, else 0.
    found: Vec<u32>,
}

impl PointColumns {
    const COLUMNS: usize = 3 + 3 + 3 + 3 + 3 + 3 + 3 + 2;

    /// The points from a place on.
    #[inline(always)]
    pub fn get<R: Real>(&self, first: usize) -> PatchPoints<R> {
        PatchPoints {
            p: Point3Error::new(self.vector(0, first), self.vector(3, first)),
            n: self.vector(6, first),
            ns: self.vector(9, first),
            dpdu: self.vector(12, first),
            dpdv: self.vector(15, first),
            ss: self.vector(18, first),
            uv: Vec2::new(self.number(21, first), self.number(22, first)),
        }
    }

    /// The shading geometry of points that [`World::points_with_shading`] has set.
    #[inline(always)]
    pub fn shading<R: Real>(&self, first: usize) -> Shading<R> {
        let mut numbers = [R::zero(); 9];
        for (i, number) in numbers.iter_mut().enumerate() {
            *number = R::load(&self.shading[i][first..]);
        }
        let [tx, ty, tz, ux, uy, uz, vx, vy, vz] = numbers;
        Shading {
            n: self.vector(9, first),
            dpdu: self.vector(18, first),
            dpdv: Vec3::new(tx, ty, tz),
            dndu: Vec3::new(ux, uy, uz),
            dndv: Vec3::new(vx, vy, vz),
        }
    }

    /// Changes the shading normals and tangents of points.
    #[inline(always)]
    pub fn set_normals<R: Real>(&mut self, first: usize, ns: Normal3<R>, ss: Vector3<R>) {
        for (column, x) in [(9, ns.x), (10, ns.y), (11, ns.z), (18, ss.x), (19, ss.y), (20, ss.z)] {
            x.store(&mut self.values[column][first..]);
        }
    }

    #[inline(always)]
    fn number<R: Real>(&self, column: usize, first: usize) -> R {
        R::load(&self.values[column][first..])
    }

    #[inline(always)]
    fn vector<R: Real>(&self, column: usize, first: usize) -> Vector3<R> {
        Vec3::new(self.number(column, first), self.number(column + 1, first), self.number(column + 2, first))
    }

    /// Makes room for `len` points, and for as many more as lanes may have.
    pub fn grow(&mut self, len: usize) {
        let len = len.next_multiple_of(MAX_LANES).max(self.found.len());
        self.values.iter_mut().for_each(|column| column.resize(len, 0.0));
        self.found.resize(len, 0);
    }

    #[inline(always)]
    fn set<R: Real>(&mut self, first: usize, points: &PatchPoints<R>, found: R::Mask) {
        let PatchPoints { p, n, ns, uv, dpdu, dpdv, ss } = points;
        let mut next = 0;
        for v in [&p.p, &p.error, n, ns, dpdu, dpdv, ss] {
            for x in [v.x, v.y, v.z] {
                x.store(&mut self.values[next][first..]);
                next += 1;
            }
        }
        uv.x.store(&mut self.values[next][first..]);
        uv.y.store(&mut self.values[next + 1][first..]);
        R::Int::select(found, R::Int::splat(1), R::Int::splat(0)).store(&mut self.found[first..]);
    }

    /// Sets the point at a place.
    pub fn set_one(&mut self, place: usize, point: &SurfacePoint) {
        let SurfacePoint { p, n, shading, dpdu, dpdv, uv, .. } = point;
        let mut columns = self.values.iter_mut();
        for v in [p.p, p.error, *n, shading.n, *dpdu, *dpdv, shading.dpdu] {
            for (x, column) in v.to_array().into_iter().zip(&mut columns) {
                column[place] = x;
            }
        }
        for (x, column) in [uv.x, uv.y].into_iter().zip(columns) {
            column[place] = x;
        }
    }

    /// Sets the shading geometry of one point.
    fn set_shading(&mut self, place: usize, shading: &Shading) {
        let mut columns = self.shading.iter_mut();
        for v in [shading.dpdv, shading.dndu, shading.dndv] {
            for (x, column) in v.to_array().into_iter().zip(&mut columns) {
                column[place] = x;
            }
        }
    }
}

impl World {
    /// The surface points of the hits of rays at some places of a batch. Those of instances, of
    /// spheres so small or far away that floats do not do, and of shapes other than triangles,
    /// spheres of sets and bilinear patches without attributes are computed one by one.
    pub fn points(&self, rays: RayColumns, hits: &HitColumns, places: &[u32], points: &mut PointColumns) {
        points.grow(places.len());
        // SAFETY: the processor has the instruction set of a world.
        unsafe {
            self.tables.instruction_set.run(Points { world: self, rays, hits, places, points: &mut *points });
        }
        for (i, &place) in places.iter().enumerate() {
            if points.found[i] == 0
                && let Some(hit) = hits.get(place as usize)
            {
                points.set_one(i, &self.surface(&rays.ray(place as usize), &hit));
            }
        }
    }

    /// [`World::points`] with their [shading geometry](PointColumns::shading), computed one by one.
    pub fn points_with_shading(
        &self,
        rays: RayColumns,
        hits: &HitColumns,
        places: &[u32],
        points: &mut PointColumns,
    ) {
        points.grow(places.len());
        let len = points.found.len();
        points.shading.iter_mut().for_each(|column| column.resize(len, 0.0));
        for (i, &place) in places.iter().enumerate() {
            if let Some(hit) = hits.get(place as usize) {
                let point = self.surface(&rays.ray(place as usize), &hit);
                points.set_one(i, &point);
                points.set_shading(i, &point.shading);
            }
        }
    }
}

struct Points<'a> {
    world: &'a World,
    rays: RayColumns<'a>,
    hits: &'a HitColumns,
    places: &'a [u32],
    points: &'a mut PointColumns,
}

impl Task for Points<'_> {
    type Output = ();

    #[inline(always)]
    unsafe fn run<S: Simd>(self) {
        self.in_lanes::<S::Real>();
    }
}

impl Points<'_> {
    #[inline(always)]
    fn in_lanes<R: Real>(self) {
        let Self { world, rays, hits, places, points } = self;
        let has_spheres = !world.tables.top().spheres.blocks.is_empty();
        let mut first = 0;
        while first < places.len() {
            let left = &places[first..];
            let last = left.len() - 1;
            let places = if last + 1 < R::LANES {
                R::Int::from_fn(|lane| left[lane.min(last)])
            } else {
                R::Int::load(left)
            };
            let (u, v) = (R::gather(&hits.uv[0], places), R::gather(&hits.uv[1], places));
            let geometry = R::Int::gather(&hits.geometry, places);
            let primitive = R::Int::gather(&hits.primitive, places);
            let (lanes, found) = match world.tables.facets.as_ref().and_then(|facets| facets.patches.as_ref())
            {
                Some(patches) => (patches.get(geometry, primitive), R::Mask::splat(true)),
                None => world.patches(geometry, primitive, hits.in_top_group::<R>(places)),
            };
            let (mut of_lanes, is_regular) = lanes.points(u, v);
            let mut found = found & is_regular;
            if has_spheres {
                let is_in_top = hits.in_top_group::<R>(places);
                let mut left = (is_in_top & !found).bits();
                let geometries = geometry.to_array();
                while left != 0 {
                    let here = geometry
                        .eq(R::Int::splat(geometries[left.trailing_zeros() as usize % MAX_LANES]))
                        & R::Mask::from_bits(left);
                    left &= !here.bits();
                    let lane = here.bits().trailing_zeros() as usize % MAX_LANES;
                    if let Geometry::Spheres(set) = world.geometry(GeometryId(geometries[lane])) {
                        let sphere = R::Int::select(here, primitive, R::Int::splat(0));
                        let (o, d) = (gather(&rays.o, places), gather(&rays.d, places));
                        let of = SphereHits { sphere, o, d, t: R::gather(&hits.t, places) };
                        let (of_spheres, are_found) = of.points(set);
                        of_lanes = select(here & are_found, &of_spheres, &of_lanes);
                        found = found | here & are_found;
                    }
                }
            }
            points.set(first, &of_lanes, found);
            first += R::LANES;
        }
    }
}

impl World {
    /// The primitives of hits, and a mask of the lanes that have one: the lanes of one geometry
    /// after those of another.
    #[inline(always)]
    fn patches<R: Real>(&self, geometry: R::Int, primitive: R::Int, of: R::Mask) -> (PatchLanes<R>, R::Mask) {
        let mut lanes = PatchLanes::splat(&NO_PATCH);
        let mut found = R::Mask::splat(false);
        let (geometries, primitives) = (geometry.to_array(), primitive.to_array());
        let mut left = of.bits();
        while left != 0 {
            let lane = left.trailing_zeros() as usize % MAX_LANES;
            let mut here = geometry.eq(R::Int::splat(geometries[lane])) & of;
            match self.geometry(GeometryId(geometries[lane])) {
                Geometry::Mesh(mesh) => {
                    let primitive = R::Int::select(here, primitive, R::Int::splat(primitives[lane]));
                    lanes = PatchLanes::select(here, &triangles(mesh, primitive), &lanes);
                    found = found | here;
                }
                Geometry::Shapes(shapes) => {
                    here = R::Mask::from_bits(1 << lane);
                    let patch = match &shapes[primitives[lane] as usize] {
                        Shape::BilinearPatch(patch) => patch.patch(),
                        _ => None,
                    };
                    if let Some(patch) = patch {
                        lanes = PatchLanes::select(here, &PatchLanes::splat(&patch), &lanes);
                        found = found | here;
                    }
                }
                _ => {}
            }
            left &= !here.bits();
        }
        (lanes, found)
    }
}

/// What lanes hold that have no hit.
const NO_PATCH: Patch = Patch {
    corner: Vec3::ZERO,
    sides: [Vec3::ZERO; 2],
    twist: Vec3::ZERO,
    normals: None,
    uv: Triangle::DEFAULT_UV,
    flips: false,
};

/// Triangles of a mesh, one in each lane.
#[inline(always)]
fn triangles<R: Real>(mesh: &TriangleMesh, triangle: R::Int) -> PatchLanes<R> {
    let (indices, three) = (mesh.all_indices(), R::Int::splat(3));
    let first = triangle.wrapping_mul(three);
    let corners = R::Int::gather_rows::<3>(indices, first);
    let [a, b, c] = vertices(mesh.positions(), corners);
    let uv = match mesh.uvs() {
        Some(uvs) => {
            let (numbers, [a, b, c]) = (pairs(uvs), corners);
            [pair(numbers, a.shl(1)), pair(numbers, b.shl(1)), pair(numbers, c.shl(1))]
        }
        None => Triangle::DEFAULT_UV.each(Vec2::broadcast),
    };
    // No closure, which would be called without the instruction set.
    let mut normals = None;
    if let Some(given) = mesh.normals() {
        normals = Some(vertices(given, corners));
    }
    let mut tangents = None;
    if let Some(given) = mesh.tangents() {
        tangents = Some(vertices(given, corners));
    }
    PatchLanes {
        corner: a,
        sides: [b - a, c - a],
        twist: None,
        normals,
        tangents,
        uv,
        sign: R::splat(if mesh.flips() { -1.0 } else { 1.0 }),
    }
}

/// The vectors of three corners.
#[inline(always)]
fn vertices<R: Real>(vectors: &[Vec3], corners: [R::Int; 3]) -> [Vector3<R>; 3] {
    let numbers = triples(vectors);
    let [a, b, c] = corners.each(|corner| corner.wrapping_mul(R::Int::splat(3)));
    [vector(numbers, a), vector(numbers, b), vector(numbers, c)]
}

/// The vectors of some places of columns.
#[inline(always)]
fn gather<R: Real>(columns: &[&[f32]; 3], places: R::Int) -> Vector3<R> {
    let [x, y, z] = *columns;
    Vec3::new(R::gather(x, places), R::gather(y, places), R::gather(z, places))
}

/// The pairs of numbers whose first ones are at some places.
#[inline(always)]
fn pair<R: Real>(numbers: &[f32], x: R::Int) -> Vec2<R> {
    Vec2::from_array(R::gather_rows::<2>(numbers, x))
}

/// The coordinates of points in the plane, one after another.
#[inline(always)]
fn pairs(vectors: &[Vec2]) -> &[f32] {
    // SAFETY: a vector is two floats, in order and without padding (`repr(C)`).
    unsafe { std::slice::from_raw_parts(vectors.as_ptr().cast(), 2 * vectors.len()) }
}

/// The primitives of a small world as plain data, from which lanes gather.
#[derive(Clone, Debug)]
pub(super) struct PatchTable {
    rows: Vec<[f32; PatchTable::COLUMNS]>,
    /// The row of the first primitive of each geometry.
    first: Vec<u32>,
    has_twists: bool,
    has_normals: bool,
}

impl PatchTable {
    /// Corner, sides, texture coordinates, sign, twist and normals.
    const COLUMNS: usize = 3 + 6 + 6 + 1 + 3 + 9;

    /// `None` if a primitive cannot be given as a patch.
    pub fn new(members: &[GeometryId], geometries: &[Geometry]) -> Option<Self> {
        let mut table = Self {
            rows: Vec::new(),
            first: vec![0; geometries.len()],
            has_twists: false,
            has_normals: false,
        };
        for &id in members {
            table.first[id.0 as usize] = table.rows.len() as u32;
            let geometry = &geometries[id.0 as usize];
            for primitive in 0..geometry.len() as u32 {
                let patch = match &*geometry.shape(primitive)? {
                    Shape::Triangle(triangle) if matches!(geometry, Geometry::Mesh(_)) => triangle.patch(),
                    Shape::BilinearPatch(patch) => patch.patch(),
                    _ => None,
                }?;
                table.has_twists |= patch.twist != Vec3::ZERO;
                table.has_normals |= patch.normals.is_some();
                table.rows.push(Self::row(&patch));
            }
        }
        Some(table)
    }

    fn row(patch: &Patch) -> [f32; Self::COLUMNS] {
        let Patch { corner, sides: [right, up], twist, normals, uv, flips } = *patch;
        let [n0, n1, n2] = normals.unwrap_or([Vec3::ZERO; 3]);
        let mut row = [0.0; Self::COLUMNS];
        for (vector, place) in [corner, right, up, twist, n0, n1, n2].iter().zip([0, 3, 6, 16, 19, 22, 25]) {
            row[place..place + 3].copy_from_slice(&vector.to_array());
        }
        row[9..15].copy_from_slice(&[uv[0].x, uv[0].y, uv[1].x, uv[1].y, uv[2].x, uv[2].y]);
        row[15] = if flips { -1.0 } else { 1.0 };
        row
    }

    #[inline(always)]
    fn get<R: Real>(&self, geometry: R::Int, primitive: R::Int) -> PatchLanes<R> {
        let row = R::Int::gather(&self.first, geometry).wrapping_add(primitive);
        let place = row.wrapping_mul(R::Int::splat(Self::COLUMNS as u32));
        let numbers = self.rows.as_flattened();
        let at = |column: u32| place.wrapping_add(R::Int::splat(column));
        let (mut twist, mut normals) = (None, None);
        if self.has_twists {
            twist = Some(vector(numbers, at(16)));
        }
        if self.has_normals {
            normals = Some([vector(numbers, at(19)), vector(numbers, at(22)), vector(numbers, at(25))]);
        }
        let [x, y, z, right_x] = R::gather_rows(numbers, place);
        let [right_y, right_z, up_x, up_y] = R::gather_rows(numbers, at(4));
        let [up_z, u0, v0, u1] = R::gather_rows(numbers, at(8));
        let [v1, u2, v2, sign] = R::gather_rows(numbers, at(12));
        PatchLanes {
            corner: Vec3::new(x, y, z),
            sides: [Vec3::new(right_x, right_y, right_z), Vec3::new(up_x, up_y, up_z)],
            twist,
            normals,
            tangents: None,
            uv: [Vec2::new(u0, v0), Vec2::new(u1, v1), Vec2::new(u2, v2)],
            sign,
        }
    }
}
