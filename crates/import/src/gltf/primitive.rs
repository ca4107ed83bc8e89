//! Primitives of meshes: their vertices, triangles and morph targets.

use math::{Point2, Vec3};

use super::accessor::Accessor;
use super::buffer::Buffers;
use super::document::Document;
use super::draco::Packed;
use super::json::{Place, Result};
use crate::primitives::{Primitive, Target};

/// Numbers of modes that draw points, lines and triangles.
const POINTS: usize = 0;
const LINES: [usize; 3] = [1, 2, 3];
const TRIANGLES: usize = 4;
const STRIP: usize = 5;
const FAN: usize = 6;

/// The primitives of a mesh, without their vertices.
pub(super) fn places<'a>(document: &Document<'a>, mesh: usize) -> Result<Vec<Place<'a>>> {
    let Some(place) = document.item("meshes", mesh) else { return Ok(Vec::new()) };
    let primitives = place.array("primitives")?;
    if primitives.is_empty() {
        return Err(place.invalid("a mesh has at least one primitive"));
    }
    Ok(primitives)
}

/// The names of kinds of primitives that are not drawn.
pub(super) fn not_drawn(place: &Place) -> Result<Option<&'static str>> {
    match place.integer("mode")?.unwrap_or(TRIANGLES) {
        POINTS => Ok(Some("points")),
        mode if LINES.contains(&mode) => Ok(Some("lines")),
        TRIANGLES | STRIP | FAN => Ok(None),
        mode => Err(place.invalid_member("mode", format!("{mode} is not a kind of primitive"))),
    }
}

/// Reads a primitive of a text.
pub(super) struct Reader<'r, 'a> {
    document: &'r Document<'a>,
    buffers: &'r Buffers,
    packed: Option<Packed<'a>>,
}

impl<'r, 'a> Reader<'r, 'a> {
    /// A reader of one primitive, whose data may be packed.
    pub fn new(document: &'r Document<'a>, buffers: &'r Buffers, place: &Place<'a>) -> Result<Self> {
        let attributes =
            place.object("attributes")?.ok_or_else(|| place.invalid("`attributes` is missing"))?;
        let packed = match Accessor::of(document, &attributes, "POSITION")? {
            Some(positions) if !positions.has_data() => Packed::of(place, buffers)?,
            _ => None,
        };
        Ok(Self { document, buffers, packed })
    }

    /// Where packed data are not as many as the accessors say, and how many there are.
    pub fn stale_counts(&self, place: &Place) -> Result<Option<(String, String)>> {
        let Some(packed) = &self.packed else { return Ok(None) };
        let attributes = place.object("attributes")?;
        let positions =
            attributes.map_or(Ok(None), |attributes| Accessor::of(self.document, &attributes, "POSITION"))?;
        let indices = Accessor::of(self.document, place, "indices")?;
        let said = [positions, indices].map(|accessor| accessor.map_or(0, |accessor| accessor.count));
        let [vertices, corners] = packed.counts();
        // A strip has fewer indices than its triangles have corners.
        let is_strip = place.integer("mode")?.is_some_and(|mode| mode != TRIANGLES);
        if said[0] == vertices && (is_strip || said[1] == corners) {
            return Ok(None);
        }
        let message = format!(
            "the accessors say {} vertices and {} indices; drawn are those that are packed, {vertices} and {corners}",
            said[0], said[1]
        );
        Ok(Some((packed.place.pointer.clone(), message)))
    }

    /// The accessor of an attribute; `None` if it is absent.
    fn accessor(&self, attributes: &Place, name: &str) -> Result<Option<Accessor<'a>>> {
        let Some(mut accessor) = Accessor::of(self.document, attributes, name)? else { return Ok(None) };
        // The integers of colours are always normalised.
        if name == "COLOR_0" {
            accessor = accessor.with_normalized();
        }
        let unpacked = match &self.packed {
            Some(packed) if !accessor.has_data() => packed.attribute(name, &accessor)?,
            _ => None,
        };
        Ok(Some(match unpacked {
            Some(unpacked) => accessor.with_data(unpacked),
            None => accessor,
        }))
    }

    /// A primitive with the texture coordinates of a set, and of others that it has.
    pub fn primitive(&self, place: &Place, set: usize, others: &[usize]) -> Result<Primitive> {
        let attributes =
            place.object("attributes")?.ok_or_else(|| place.invalid("`attributes` is missing"))?;
        check_names(&attributes)?;
        let Some(accessor) = self.accessor(&attributes, "POSITION")? else {
            return Err(attributes.invalid("`POSITION` is missing"));
        };
        let positions =
            points(accessor.vectors(self.buffers).map_err(|fault| within(&attributes, "POSITION", fault))?);
        let count = positions.len();
        let (colors, opacities) = self.colors(&attributes, count)?;
        let mut primitive = Primitive {
            normals: points(self.attribute(&attributes, "NORMAL", count)?),
            tangents: self.attribute(&attributes, "TANGENT", count)?,
            uvs: self.coordinates(&attributes, set, count)?,
            colors,
            opacities,
            influences: self.influences(&attributes, count)?,
            positions,
            ..Primitive::default()
        };
        for &other in others {
            let uvs = self.coordinates(&attributes, other, count)?;
            if !uvs.is_empty() {
                primitive.other_uvs.push((other, uvs));
            }
        }
        // Flat normals have no tangents of their own.
        if primitive.normals.is_empty() {
            primitive.tangents.clear();
        }
        for target in place.array("targets")? {
            check_names(&target)?;
            primitive.targets.push(Target {
                positions: points(self.attribute(&target, "POSITION", count)?),
                normals: points(self.attribute(&target, "NORMAL", count)?),
                tangents: points(self.attribute(&target, "TANGENT", count)?),
            });
        }
        primitive.triangles = self.triangles(place, count)?;
        Ok(primitive)
    }

    fn attribute<const N: usize>(
        &self,
        attributes: &Place,
        name: &str,
        count: usize,
    ) -> Result<Vec<[f32; N]>> {
        let Some(accessor) = self.accessor(attributes, name)? else { return Ok(Vec::new()) };
        if accessor.count != count {
            let message = format!("there are {} for {count} vertices", accessor.count);
            return Err(attributes.invalid_member(name, message));
        }
        accessor.vectors(self.buffers).map_err(|fault| within(attributes, name, fault))
    }

    fn coordinates(&self, attributes: &Place, set: usize, count: usize) -> Result<Vec<Point2>> {
        let uvs = self.attribute(attributes, &format!("TEXCOORD_{set}"), count)?;
        Ok(uvs.into_iter().map(|[u, v]| Point2::new(u, v)).collect())
    }

    /// Colours, and opacities where there are any.
    fn colors(&self, attributes: &Place, count: usize) -> Result<(Vec<[f32; 3]>, Vec<f32>)> {
        match self.accessor(attributes, "COLOR_0")? {
            Some(accessor) if accessor.width == 4 => {
                let colors = self.attribute(attributes, "COLOR_0", count)?;
                Ok(colors.into_iter().map(|[r, g, b, a]: [f32; 4]| ([r, g, b], a)).unzip())
            }
            Some(_) => Ok((self.attribute(attributes, "COLOR_0", count)?, Vec::new())),
            None => Ok((Vec::new(), Vec::new())),
        }
    }

    fn influences(&self, attributes: &Place, count: usize) -> Result<Vec<[(u32, f32); 4]>> {
        let Some(accessor) = self.accessor(attributes, "JOINTS_0")? else {
            return Ok(Vec::new());
        };
        let joints =
            accessor.integers::<4>(self.buffers).map_err(|fault| within(attributes, "JOINTS_0", fault))?;
        let weights: Vec<[f32; 4]> = self.attribute(attributes, "WEIGHTS_0", count)?;
        if joints.len() != weights.len() || weights.len() != count {
            let message = "`JOINTS_0` and `WEIGHTS_0` are there for all vertices, or for none";
            return Err(attributes.invalid(message));
        }
        let pair =
            |(joints, weights): (&[u32; 4], &[f32; 4])| std::array::from_fn(|i| (joints[i], weights[i]));
        Ok(joints.iter().zip(&weights).map(pair).collect())
    }

    fn triangles(&self, place: &Place, count: usize) -> Result<Vec<[u32; 3]>> {
        let accessor = Accessor::of(self.document, place, "indices")?;
        let packed = self.packed.as_ref().filter(|_| !accessor.as_ref().is_some_and(Accessor::has_data));
        let packed = packed.map(Packed::triangles);
        let indices: Vec<u32> = match (&packed, accessor) {
            (Some(triangles), _) => triangles.as_flattened().to_vec(),
            (None, Some(accessor)) => {
                let indices =
                    accessor.integers::<1>(self.buffers).map_err(|fault| within(place, "indices", fault))?;
                indices.into_iter().map(|[index]| index).collect()
            }
            (None, None) => {
                self.buffers.spend(place, 16 * count as u64)?;
                (0..count as u32).collect()
            }
        };
        if let Some(index) = indices.iter().find(|&&index| index as usize >= count) {
            let message = format!("there is no vertex {index} of {count}");
            return Err(place.invalid_member("indices", message));
        }
        let mode = if packed.is_some() { TRIANGLES } else { place.integer("mode")?.unwrap_or(TRIANGLES) };
        let mut triangles: Vec<[u32; 3]> = match mode {
            STRIP => {
                let turned = |(i, v): (usize, &[u32])| {
                    if i % 2 == 0 { [v[0], v[1], v[2]] } else { [v[0], v[2], v[1]] }
                };
                indices.windows(3).enumerate().map(turned).collect()
            }
            FAN => {
                let (first, rest) =
                    indices.split_first().map_or((0, &[][..]), |(&first, rest)| (first, rest));
                rest.windows(2).map(|v| [v[0], v[1], first]).collect()
            }
            _ => indices.as_chunks().0.to_vec(),
        };
        // Strips join their parts by triangles without an area.
        triangles.retain(|[a, b, c]| a != b && b != c && c != a);
        Ok(triangles)
    }
}

/// The fault of an accessor, as that of the attribute which refers to it.
fn within(attributes: &Place, name: &str, fault: super::json::Fault) -> super::json::Fault {
    let message = format!("{} (of {})", fault.message, fault.place);
    super::json::Fault { place: attributes.pointer_to(name), message, ..fault }
}

fn points(vectors: Vec<[f32; 3]>) -> Vec<Vec3> {
    vectors.into_iter().map(|[x, y, z]| Vec3::new(x, y, z)).collect()
}

/// Refuses attributes that are neither of the format nor of an application.
fn check_names(attributes: &Place) -> Result<()> {
    let names = attributes.value.as_object().into_iter().flat_map(|object| object.keys());
    for name in names {
        let numbered = ["TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"].into_iter();
        let is_numbered = numbered
            .filter_map(|start| name.strip_prefix(start))
            .any(|number| !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit()));
        if !(is_numbered
            || name.starts_with('_')
            || matches!(name.as_str(), "POSITION" | "NORMAL" | "TANGENT"))
        {
            return Err(attributes.invalid_member(name, "this is not the name of an attribute"));
        }
    }
    Ok(())
}
