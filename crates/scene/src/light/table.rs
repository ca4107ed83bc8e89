//! The table of the lights of a scene, and references to single lights.
//!
//! A row holds one light, or one light per primitive of an emitting geometry, with consecutive ids.
//! A mesh of a million emitting triangles is one row.

use super::{
    AreaEmission, EmissionId, Light, LightBounds, LightId, LightLeSample, LightLiSample, LightModel,
    LightPoint, LightSampleContext, each_light,
};
use crate::medium::{MediumId, MediumInterface};
use crate::texture::Textures;
use description::Span;
use geometry::World;
use math::{Normal3, Point2, Point3, Ray, Vector3};
use spectrum::{SampledSpectrum, SampledWavelengths};

/// The rows, and the emissions that they share.
#[derive(Clone, Debug, Default)]
pub(crate) struct LightTable {
    rows: Vec<Light>,
    /// The id of each row's first light.
    first: Vec<u32>,
    /// The row of each light.
    row: Vec<u32>,
    /// The media around each row.
    media: Vec<MediumInterface>,
    /// The group of each row.
    groups: Vec<u32>,
    /// Where each row is described.
    spans: Vec<Span>,
    emissions: Vec<AreaEmission>,
    infinite: Vec<LightId>,
}

impl LightTable {
    /// A table without lights.
    pub fn new(emissions: Vec<AreaEmission>) -> Self {
        Self { emissions, ..Self::default() }
    }

    /// Adds a row of `count` lights of a group. The media are those on the sides of its surface;
    /// without one, it is in the outer.
    pub fn push(&mut self, light: Light, count: u32, media: MediumInterface, group: u32, span: Span) {
        if each_light!(&light, light => light.is_infinite()) {
            self.infinite.push(LightId(self.row.len() as u32));
        }
        self.first.push(self.row.len() as u32);
        self.row.resize(self.row.len() + count as usize, self.rows.len() as u32);
        self.rows.push(light);
        self.media.push(media);
        self.groups.push(group);
        self.spans.push(span);
    }

    /// Whether there is no light.
    pub fn is_empty(&self) -> bool {
        self.row.is_empty()
    }

    /// The emissions of area lights.
    pub fn emissions(&self) -> &[AreaEmission] {
        &self.emissions
    }

    /// The lights whose radiance rays that leave the scene receive.
    pub fn infinite(&self) -> &[LightId] {
        &self.infinite
    }
}

/// The lights of a scene with the tables that they refer to.
#[derive(Clone, Copy, Debug)]
pub struct Lights<'a> {
    pub(crate) table: &'a LightTable,
    pub(crate) world: &'a World,
    pub(crate) textures: &'a Textures,
}

impl<'a> Lights<'a> {
    /// The number of lights; their ids are 0 … `len` − 1.
    pub fn len(self) -> usize {
        self.table.row.len()
    }

    /// Whether there is no light.
    pub fn is_empty(self) -> bool {
        self.table.is_empty()
    }

    /// The rows of the table, each with the id of its first light.
    pub fn rows(self) -> impl ExactSizeIterator<Item = (LightId, &'a Light)> {
        self.table.first.iter().map(|&id| LightId(id)).zip(&self.table.rows)
    }

    /// A light by its id.
    #[inline]
    pub fn get(self, id: LightId) -> LightRef<'a> {
        let LightTable { rows, first, row, .. } = self.table;
        let row = row[id.0 as usize] as usize;
        LightRef { id, light: &rows[row], part: LightPart { primitive: id.0 - first[row], lights: self } }
    }

    /// The powers of all lights in the order of their ids. The image of an emission is traversed
    /// once for each row, not for each primitive.
    pub fn powers(self, lambda: &SampledWavelengths) -> impl Iterator<Item = SampledSpectrum> {
        let mut row = None;
        self.iter().map(move |light| match light.row() {
            Light::Area(area) => {
                let mean_radiance = match row {
                    Some(mean_radiance) if light.primitive() > 0 => mean_radiance,
                    _ => *row.insert(area.mean_radiance(&light.part, lambda)),
                };
                area.power(&light.part, mean_radiance)
            }
            _ => light.phi(lambda),
        })
    }

    /// All lights in the order of their ids.
    pub fn iter(self) -> impl ExactSizeIterator<Item = LightRef<'a>> {
        (0..self.table.row.len() as u32).map(move |id| self.get(LightId(id)))
    }
}

/// Selects one of the lights of a row, with the tables that it refers to.
#[derive(Clone, Copy, Debug)]
pub struct LightPart<'a> {
    /// The primitive of an emitting geometry; 0 for other lights.
    pub primitive: u32,
    lights: Lights<'a>,
}

impl<'a> LightPart<'a> {
    /// The geometry that emits.
    pub(super) fn world(&self) -> &'a World {
        self.lights.world
    }

    /// The alpha textures.
    pub(super) fn textures(&self) -> &'a Textures {
        self.lights.textures
    }

    /// The emission of an id.
    pub(super) fn emission(&self, id: EmissionId) -> &'a AreaEmission {
        &self.lights.table.emissions[id.0 as usize]
    }
}

/// One light of a scene. Its methods are those of [`LightModel`].
#[derive(Clone, Copy, Debug)]
pub struct LightRef<'a> {
    id: LightId,
    light: &'a Light,
    part: LightPart<'a>,
}

impl<'a> LightRef<'a> {
    /// Its id.
    pub fn id(&self) -> LightId {
        self.id
    }

    /// The primitive of the geometry that emits; 0 for other lights.
    pub fn primitive(&self) -> u32 {
        self.part.primitive
    }

    /// The row of the table that it belongs to.
    pub fn row(&self) -> &'a Light {
        self.light
    }

    /// Its group, an index of [`SceneDesc::light_groups`](description::SceneDesc::light_groups).
    pub fn group(&self) -> usize {
        let LightTable { row, groups, .. } = self.part.lights.table;
        groups[row[self.id.0 as usize] as usize] as usize
    }

    /// Where it is described: an area light by its shape.
    pub fn span(&self) -> Span {
        let LightTable { row, spans, .. } = self.part.lights.table;
        spans[row[self.id.0 as usize] as usize]
    }

    /// The medium of the light that leaves it along `w`, where its surface has the normal `n`, zero
    /// without a surface.
    pub fn medium_towards(&self, w: Vector3, n: Normal3) -> Option<MediumId> {
        let LightTable { row, media, .. } = self.part.lights.table;
        let media = media[row[self.id.0 as usize] as usize];
        if n == Normal3::ZERO { media.outside } else { media.towards(w, n) }
    }

    /// See [`LightModel::is_delta`].
    #[inline]
    pub fn is_delta(&self) -> bool {
        each_light!(self.light, light => light.is_delta())
    }

    /// See [`LightModel::is_infinite`].
    #[inline]
    pub fn is_infinite(&self) -> bool {
        each_light!(self.light, light => light.is_infinite())
    }

    /// See [`LightModel::is_distant`].
    #[inline]
    pub fn is_distant(&self) -> bool {
        each_light!(self.light, light => light.is_distant())
    }

    /// See [`LightModel::emits_within_scene`].
    pub fn emits_within_scene(&self) -> bool {
        each_light!(self.light, light => light.emits_within_scene())
    }

    /// See [`LightModel::phi`].
    pub fn phi(&self, lambda: &SampledWavelengths) -> SampledSpectrum {
        each_light!(self.light, light => light.phi(&self.part, lambda))
    }

    /// See [`LightModel::sample_li`].
    #[inline]
    pub fn sample_li(
        &self,
        context: &LightSampleContext,
        u: Point2,
        lambda: &SampledWavelengths,
        allow_incomplete: bool,
    ) -> Option<LightLiSample> {
        each_light!(self.light, light => light.sample_li(&self.part, context, u, lambda, allow_incomplete))
    }

    /// See [`LightModel::pdf_li`].
    pub fn pdf_li(
        &self,
        context: &LightSampleContext,
        wi: Vector3,
        point: LightPoint,
        allow_incomplete: bool,
    ) -> f32 {
        each_light!(self.light, light => light.pdf_li(&self.part, context, wi, point, allow_incomplete))
    }

    /// See [`LightModel::sample_le`].
    pub fn sample_le(
        &self,
        u_position: Point2,
        u_direction: Point2,
        time: f32,
        lambda: &SampledWavelengths,
    ) -> Option<LightLeSample> {
        each_light!(self.light, light => light.sample_le(&self.part, u_position, u_direction, time, lambda))
    }

    /// See [`LightModel::pdf_le`].
    pub fn pdf_le(&self, p: Point3, n: Normal3, w: Vector3, time: f32) -> (f32, f32) {
        each_light!(self.light, light => light.pdf_le(&self.part, p, n, w, time))
    }

    /// See [`LightModel::pdf_le_infinite`].
    pub fn pdf_le_infinite(&self, ray: &Ray) -> (f32, f32) {
        each_light!(self.light, light => light.pdf_le_infinite(ray))
    }

    /// See [`LightModel::le`].
    pub fn le(&self, ray: &Ray, lambda: &SampledWavelengths) -> SampledSpectrum {
        each_light!(self.light, light => light.le(ray, lambda))
    }

    /// See [`LightModel::radiance`].
    pub fn radiance(
        &self,
        n: Normal3,
        uv: Point2,
        w: Vector3,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        each_light!(self.light, light => light.radiance(&self.part, n, uv, w, lambda))
    }

    /// See [`LightModel::bounds`].
    pub fn bounds(&self) -> Option<LightBounds> {
        each_light!(self.light, light => light.bounds(&self.part))
    }
}
