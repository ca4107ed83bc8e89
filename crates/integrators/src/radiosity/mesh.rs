//! The mesh of cells, into which surfaces are subdivided.
//!
//! A cell is a part of one primitive of the scene: a triangle or rectangle of the primitive's own
//! parameters, with corners on the surface. The root cell is the whole primitive, and a split
//! halves a cell across its longer side, so that the cells of a primitive are a binary tree and the
//! leaf of a ray's hit is found by descending it.
//!
//! Vertices are shared: corners at one position with similar normals are one vertex, also across
//! primitives. Where a cell's neighbour is subdivided further, there is a vertex in the middle of
//! the cell's side: a T-vertex. Interpolation between corners only would be discontinuous across
//! that side. So T-vertices are *anchored*: [`Mesh::outline`] returns the corners and all vertices
//! of neighbours on the sides between them, and interpolation over the fan of triangles between
//! that outline and the cell's centre is continuous ([Cohen 1986]; [Baum 1991] for anchors).

use std::collections::{HashMap, HashSet};

use geometry::{Geometry, GeometryId, Hit, InstancePath, SurfacePoint, World};
use math::{Normal3, Point3, Vec2};
use scene::Scene;

use super::domain::Domain;
use super::primitives::{self, is_sound};
use crate::{Cancelled, Control};

/// A corner of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Corner {
    /// Index of its vertex.
    pub vertex: u32,
    /// Parameters on the cell's primitive.
    pub uv: Vec2,
}

/// A part of a primitive.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    /// Index of its primitive.
    pub primitive: u32,
    corners: [Corner; 4],
    sides: u8,
    /// The first of its two halves.
    children: Option<u32>,
    /// The element of a leaf, set by the owner of the mesh.
    pub element: u32,
}

impl Cell {
    fn new(primitive: u32, corners: &[Corner]) -> Self {
        let mut all = [Corner::default(); 4];
        all[..corners.len()].copy_from_slice(corners);
        Self { primitive, corners: all, sides: corners.len() as u8, children: None, element: u32::MAX }
    }

    /// Three or four corners, in order.
    pub fn corners(&self) -> &[Corner] {
        &self.corners[..self.sides as usize]
    }

    /// Its parameter domain.
    pub fn domain(&self) -> Domain {
        let [a, b, c, d] = self.corners.map(|corner| corner.uv);
        if self.sides == 3 { Domain::Triangle([a, b, c]) } else { Domain::Rectangle([a, b, c, d]) }
    }
}

/// A vertex, which corners share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex {
    pub p: Point3,
    pub n: Normal3,
}

/// Below this cosine between their normals, corners at one place are two vertices.
const SMOOTH: f32 = 0.9;

/// The sag of a side, relative to its length, above which a cell is too curved to approximate its
/// surface.
const BENT: f32 = 0.05;

/// Vertices, with a hash grid of their positions.
#[derive(Clone, Debug)]
struct Vertices {
    all: Vec<Vertex>,
    /// Indices of vertices by grid cell, twice the tolerance wide.
    grid: HashMap<[i64; 3], Vec<u32>>,
    /// Maximum distance between corners of one vertex.
    tolerance: f32,
}

impl Vertices {
    fn square(&self, p: Point3, shift: f64) -> [i64; 3] {
        p.to_array().map(|x| (f64::from(x) / f64::from(2.0 * self.tolerance) + shift).floor() as i64)
    }

    /// The vertex with this position and a similar normal, if there is one.
    fn find(&self, vertex: &Vertex) -> Option<u32> {
        let low = self.square(vertex.p, -0.5);
        (0..8).find_map(|i| {
            let near = self.grid.get(&[low[0] + (i & 1), low[1] + (i >> 1 & 1), low[2] + (i >> 2)])?;
            near.iter().copied().find(|&i| {
                let other = &self.all[i as usize];
                other.p.distance(vertex.p) <= self.tolerance && other.n.dot(vertex.n) > SMOOTH
            })
        })
    }

    fn find_or_add(&mut self, vertex: Vertex) -> u32 {
        self.find(&vertex).unwrap_or_else(|| {
            let id = self.all.len() as u32;
            self.all.push(vertex);
            self.grid.entry(self.square(vertex.p, 0.0)).or_default().push(id);
            id
        })
    }
}

/// All surfaces that can be subdivided.
#[derive(Clone, Debug)]
pub(crate) struct Mesh {
    primitives: Vec<Hit>,
    left_out: usize,
    /// The root cells of primitives.
    roots: HashMap<(GeometryId, InstancePath, u32), u32>,
    cells: Vec<Cell>,
    vertices: Vertices,
    /// Sides that were split: both ends, the lower index first, and the vertex between.
    cut: HashSet<[u32; 3]>,
    /// The time at which moving shapes are subdivided.
    time: f32,
}

impl Mesh {
    /// One root cell for each primitive of the scene that can be subdivided and is not an
    /// interface. If there are more than `most`, lights come first and then the largest primitives.
    pub fn new(scene: &Scene, time: f32, most: usize, control: &Control) -> Result<Self, Cancelled> {
        let sphere = scene.sphere();
        let size = sphere.center.abs().max_element() + sphere.radius;
        let tolerance = (1e-6 * size).max(f32::MIN_POSITIVE);
        let vertices = Vertices { all: Vec::new(), grid: HashMap::new(), tolerance };
        let (primitives, left_out) = primitives::choose(scene, time, most, control)?;
        let mut mesh = Self {
            primitives,
            left_out,
            roots: HashMap::new(),
            cells: Vec::new(),
            vertices,
            cut: HashSet::new(),
            time,
        };
        for primitive in 0..mesh.primitives.len() as u32 {
            control.check()?;
            mesh.add_root(scene.world(), primitive);
        }
        Ok(mesh)
    }

    /// Adds the root cell of a primitive, if its corners are valid.
    fn add_root(&mut self, world: &World, primitive: u32) {
        let hit = self.primitives[primitive as usize];
        let domain = Domain::of(world, &hit);
        let surfaces: Option<Vec<SurfacePoint>> =
            domain.corners().iter().map(|&uv| self.surface(world, primitive, uv).filter(is_sound)).collect();
        let Some(surfaces) = surfaces else { return };
        let corner = |(surface, &uv): (SurfacePoint, &Vec2)| Corner {
            vertex: self.vertices.find_or_add(vertex_at(&surface)),
            uv,
        };
        let corners: Vec<Corner> = surfaces.into_iter().zip(domain.corners()).map(corner).collect();
        self.roots.insert((hit.geometry, hit.instance, hit.primitive), self.cells.len() as u32);
        self.cells.push(Cell::new(primitive, &corners));
    }

    /// The number of primitives without cells because of the limit.
    pub fn left_out(&self) -> usize {
        self.left_out
    }

    /// A cell by its index.
    pub fn cell(&self, cell: u32) -> &Cell {
        &self.cells[cell as usize]
    }

    /// Sets the element of a leaf.
    pub fn set_element(&mut self, cell: u32, element: u32) {
        self.cells[cell as usize].element = element;
    }

    /// The number of cells; their indices begin with 0.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// The primitive of a cell, as a hit without a position.
    pub fn primitive(&self, cell: &Cell) -> &Hit {
        &self.primitives[cell.primitive as usize]
    }

    /// All vertices.
    pub fn vertices(&self) -> &[Vertex] {
        &self.vertices.all
    }

    /// The time at which moving shapes are subdivided.
    pub fn time(&self) -> f32 {
        self.time
    }

    /// The point of a primitive with these parameters.
    pub fn surface(&self, world: &World, primitive: u32, uv: Vec2) -> Option<SurfacePoint> {
        let hit = &self.primitives[primitive as usize];
        world.surface_at(hit.geometry, hit.primitive, hit.instance, uv, self.time)
    }

    /// The position of the point with these parameters; the origin if there is none.
    fn position(&self, world: &World, cell: &Cell, uv: Vec2) -> Point3 {
        self.surface(world, cell.primitive, uv).map_or(Point3::ZERO, |surface| surface.p.p)
    }

    /// The area of a part of a primitive.
    pub fn area(&self, world: &World, cell: &Cell, domain: &Domain) -> f32 {
        domain.area(|uv| self.position(world, cell, uv))
    }

    /// The area of all surfaces, before any split.
    pub fn whole_area(&self, world: &World) -> f64 {
        let quarters = self.cells.iter().flat_map(|cell| cell.domain().quarters().map(|part| (cell, part)));
        quarters.map(|(cell, part)| f64::from(self.area(world, cell, &part))).sum()
    }

    /// The lengths of a cell in two directions: of a triangle, its first side and the longer one of
    /// the others; of a rectangle, its midlines through the surface point at the centre.
    fn lengths(&self, world: &World, cell: &Cell) -> [f32; 2] {
        let p = |uv| self.position(world, cell, uv);
        match cell.domain() {
            Domain::Triangle([a, b, c]) => {
                let (a, b, c) = (p(a), p(b), p(c));
                [a.distance(b), b.distance(c).max(c.distance(a))]
            }
            Domain::Rectangle([a, b, c, d]) => {
                let m = p((a + b + c + d) * 0.25);
                let way = |a: Vec2, b: Vec2, c: Vec2, d: Vec2| {
                    p((a + b) * 0.5).distance(m) + m.distance(p((c + d) * 0.5))
                };
                [way(d, a, b, c), way(a, b, c, d)]
            }
        }
    }

    /// The larger of a cell's lengths.
    pub fn size(&self, world: &World, cell: u32) -> f32 {
        let [a, b] = self.lengths(world, self.cell(cell));
        a.max(b)
    }

    /// Whether a cell is too curved to approximate its surface.
    pub fn is_bent(&self, world: &World, cell: u32) -> bool {
        let cell = self.cell(cell);
        let at = |corner: &Corner| self.vertices.all[corner.vertex as usize].p;
        sides(cell.corners()).any(|[a, b]| {
            let chord = (at(&a) + at(&b)) * 0.5;
            let sag = self.position(world, cell, (a.uv + b.uv) * 0.5).distance(chord);
            sag > BENT * (at(&a).distance(at(&b)) + sag)
        })
    }

    /// Halves a leaf. Returns the first of the two halves, which have consecutive indices.
    pub fn split(&mut self, world: &World, leaf: u32) -> u32 {
        let cell = self.cells[leaf as usize];
        let mut corners = cell.corners().to_vec();
        // Rotated so that the side to be split comes first.
        let turns = if let Domain::Triangle(uvs) = cell.domain() {
            let [a, b, c] = uvs.map(|uv| self.position(world, &cell, uv));
            let lengths = [a.distance(b), b.distance(c), c.distance(a)];
            (0..3).fold(0, |longest, i| if lengths[i] > lengths[longest] { i } else { longest })
        } else {
            let [along, across] = self.lengths(world, &cell);
            usize::from(across > along)
        };
        corners.rotate_left(turns);
        let first = self.cells.len() as u32;
        let half = self.cut_side(world, &cell, [corners[0], corners[1]]);
        let halves = if let [a, b, c, d] = corners[..] {
            let other = self.cut_side(world, &cell, [c, d]);
            [vec![a, half, other, d], vec![half, b, c, other]]
        } else {
            [vec![corners[0], half, corners[2]], vec![half, corners[1], corners[2]]]
        };
        self.cells.extend(halves.map(|corners| Cell::new(cell.primitive, &corners)));
        self.cells[leaf as usize].children = Some(first);
        first
    }

    fn cut_side(&mut self, world: &World, cell: &Cell, side: [Corner; 2]) -> Corner {
        let middle = self.middle(world, cell, side);
        let vertex = self.vertices.find_or_add(middle.1);
        self.cut.insert(side_key(side, vertex));
        Corner { vertex, uv: middle.0 }
    }

    fn middle(&self, world: &World, cell: &Cell, [a, b]: [Corner; 2]) -> (Vec2, Vertex) {
        let uv = (a.uv + b.uv) * 0.5;
        let surface = self.surface(world, cell.primitive, uv);
        let end = self.vertices.all[a.vertex as usize];
        (uv, surface.map_or(end, |surface| vertex_at(&surface)))
    }

    /// The leaf that a ray has hit, and the parameters of the hit; `None` on primitives without
    /// cells.
    pub fn leaf(&self, world: &World, hit: &Hit, surface: &SurfacePoint) -> Option<(&Cell, Vec2)> {
        let (root, uv) = self.place(world, hit, surface)?;
        Some((self.leaf_in(root, uv), uv))
    }

    /// The root cell of the primitive that a ray has hit, and the parameters of the hit; `None` on
    /// primitives without cells.
    pub fn place(&self, world: &World, hit: &Hit, surface: &SurfacePoint) -> Option<(u32, Vec2)> {
        let root = self.roots.get(&(hit.geometry, hit.instance, hit.primitive))?;
        let is_sphere = matches!(world.geometry(hit.geometry), Geometry::Spheres(_));
        Some((*root, if is_sphere { surface.uv } else { hit.uv }))
    }

    /// The leaf of a cell that contains the parameters `uv`.
    pub fn leaf_in(&self, cell: u32, uv: Vec2) -> &Cell {
        let mut cell = self.cell(cell);
        while let Some(first) = cell.children {
            // The second and third corner of the first half are the ends of the split.
            let half = self.cell(first);
            let [a, b] = [half.corners[1].uv, half.corners[2].uv];
            let inner = half.corners[0].uv;
            let is_first = (b - a).perp_dot(uv - a) * (b - a).perp_dot(inner - a) >= 0.0;
            cell = if is_first { half } else { self.cell(first + 1) };
        }
        cell
    }

    /// The corners of a leaf and all vertices of its neighbours between them, in order.
    pub fn outline(&self, world: &World, cell: &Cell) -> Vec<Corner> {
        let mut outline = Vec::new();
        for side in sides(cell.corners()) {
            outline.push(side[0]);
            self.anchors(world, cell, side, &mut outline);
        }
        outline
    }

    /// Whether a neighbour of a leaf is finer by more than one level, so that more than one vertex
    /// lies on a side.
    pub fn is_beside_finer(&self, world: &World, leaf: &Cell) -> bool {
        sides(leaf.corners()).any(|side| {
            let mut between = Vec::new();
            self.anchors(world, leaf, side, &mut between);
            between.len() > 1
        })
    }

    fn anchors(&self, world: &World, cell: &Cell, side: [Corner; 2], outline: &mut Vec<Corner>) {
        if side[0].vertex == side[1].vertex {
            return;
        }
        let (uv, middle) = self.middle(world, cell, side);
        let Some(vertex) = self.vertices.find(&middle).filter(|&v| self.cut.contains(&side_key(side, v)))
        else {
            return;
        };
        let middle = Corner { vertex, uv };
        self.anchors(world, cell, [side[0], middle], outline);
        outline.push(middle);
        self.anchors(world, cell, [middle, side[1]], outline);
    }

    /// Memory taken, in bytes, approximately.
    pub fn bytes(&self) -> usize {
        let roots = self.roots.capacity() * size_of::<((GeometryId, InstancePath, u32), u32)>();
        let hashed = roots + self.cut.capacity() * size_of::<[u32; 3]>() + self.vertices.all.len() * 56;
        size_of_val(&*self.primitives) + size_of_val(&*self.cells) + size_of_val(&*self.vertices.all) + hashed
    }
}

fn vertex_at(surface: &SurfacePoint) -> Vertex {
    Vertex { p: surface.p.p, n: surface.shading.n }
}

/// The sides, from each corner to the next.
fn sides(corners: &[Corner]) -> impl Iterator<Item = [Corner; 2]> + '_ {
    (0..corners.len()).map(|i| [corners[i], corners[(i + 1) % corners.len()]])
}

fn side_key([a, b]: [Corner; 2], middle: u32) -> [u32; 3] {
    [a.vertex.min(b.vertex), a.vertex.max(b.vertex), middle]
}
