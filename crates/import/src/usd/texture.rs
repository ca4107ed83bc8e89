//! Textures of shading networks: the image, which numbers of it are meant, and at which
//! coordinates.

use description::{EdgeMode, WrapMode};
use math::{DAffine2, DMat2, DVec2};

use super::stage::Prim;
use crate::log::Result;

/// How the codes of an image are decoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Space {
    /// As the format of the image suggests.
    Auto,
    Raw,
    Srgb,
}

/// A texture as one input has it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Texture {
    /// Where the image is; its name if it was not found.
    pub file: std::result::Result<String, String>,
    pub space: Space,
    /// Values are multiplied, and then moved.
    pub scale: [f64; 4],
    pub bias: [f64; 4],
    /// What it is without the image.
    pub fallback: [f64; 4],
    /// Which of red, green, blue and opacity is meant; `None` for a colour.
    pub channel: Option<usize>,
    /// The primvar of its coordinates.
    pub set: String,
    /// From those coordinates to those of the image, of which [0, 1]² is the image, twice as wide
    /// or high where it is mirrored. v is up in both.
    pub transform: DAffine2,
    /// Whether the image is followed by its mirror image, to the right and above.
    pub mirrored: [bool; 2],
    pub wrap: WrapMode,
    /// The path of the shader.
    pub place: String,
}

/// What the value of an input comes from.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Source<'s> {
    /// The value of a property.
    Value(Prim<'s>, String),
    Texture(Box<Texture>),
    /// A primvar of the shape.
    Primvar(String),
    /// A node of this name, which is not read.
    Unknown(String),
}

impl PartialEq for Prim<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.path() == other.path()
    }
}

impl std::fmt::Debug for Prim<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.path())
    }
}

/// The end of the connections of a property: the prim and property that have the value, and whether
/// that is an output of a shader. At most as many as no network has, so that circles end.
pub(super) fn end<'s>(prim: &Prim<'s>, property: &str) -> Result<(Prim<'s>, String)> {
    const MOST: usize = 64;
    let mut place = (prim.clone(), property.to_owned());
    for _ in 0..MOST {
        match place.0.connection(&place.1)? {
            Some(next) => place = next,
            None => return Ok(place),
        }
    }
    Err(prim.fault(property, "its connections do not end"))
}

/// Where the value of an input comes from; `None` if it is not given.
pub(super) fn source<'s>(shader: &Prim<'s>, input: &str) -> Result<Option<Source<'s>>> {
    let (prim, property) = end(shader, &format!("inputs:{input}"))?;
    let Some(output) = property.strip_prefix("outputs:") else {
        return Ok(Some(Source::Value(prim, property)));
    };
    let kind = prim.word("info:id")?.unwrap_or_default();
    Ok(Some(match kind.as_str() {
        "UsdUVTexture" => Source::Texture(Box::new(Texture::read(&prim, output)?)),
        kind if kind.starts_with("UsdPrimvarReader_") => match primvar_name(&prim)? {
            Some(name) => Source::Primvar(name),
            None => Source::Value(prim, "inputs:fallback".to_owned()),
        },
        _ if !prim.is_there() => return Ok(None),
        kind => Source::Unknown(kind.to_owned()),
    }))
}

/// The name of the primvar that a node reads.
fn primvar_name(node: &Prim) -> Result<Option<String>> {
    let (prim, property) = end(node, "inputs:varname")?;
    Ok(prim.word(&property)?.filter(|name| !name.is_empty()))
}

impl Texture {
    fn read(node: &Prim, output: &str) -> Result<Self> {
        let number4 = |name: &str, otherwise| {
            let (prim, property) = end(node, &format!("inputs:{name}"))?;
            Ok(prim.numbers::<4>(&property)?.unwrap_or(otherwise))
        };
        let word = |name: &str| {
            let (prim, property) = end(node, &format!("inputs:{name}"))?;
            prim.word(&property)
        };
        let wraps = [word("wrapS")?, word("wrapT")?].map(|word| word.unwrap_or_default());
        let mirrored = [0, 1].map(|axis: usize| wraps[axis] == "mirror");
        let edges = [0, 1].map(|axis: usize| match wraps[axis].as_str() {
            "repeat" | "mirror" => EdgeMode::Repeat,
            "clamp" => EdgeMode::Clamp,
            _ => EdgeMode::Black,
        });
        let (prim, property) = end(node, "inputs:file")?;
        let file = match prim.file(&property)? {
            Some((Some(found), _)) => Ok(found),
            Some((None, name)) => Err(name),
            None => Err(String::new()),
        };
        let space = match word("sourceColorSpace")?.as_deref() {
            Some("raw") => Space::Raw,
            Some("sRGB") => Space::Srgb,
            _ => Space::Auto,
        };
        let (set, transform) = coordinates(node)?;
        let scale = mirrored.map(|is_mirrored| if is_mirrored { 0.5 } else { 1.0 });
        Ok(Self {
            file,
            space,
            scale: number4("scale", [1.0; 4])?,
            bias: number4("bias", [0.0; 4])?,
            fallback: number4("fallback", [0.0, 0.0, 0.0, 1.0])?,
            channel: ["r", "g", "b", "a"].iter().position(|name| *name == output),
            set,
            transform: DAffine2::from_scale(DVec2::from(scale)) * transform,
            mirrored,
            wrap: WrapMode::of_axes(edges),
            place: node.path().to_owned(),
        })
    }

    /// The value without an image.
    pub fn constant(&self) -> [f64; 4] {
        std::array::from_fn(|i| self.fallback[i] * self.scale[i] + self.bias[i])
    }
}

/// The primvar of a texture's coordinates, and the transform from there.
fn coordinates(node: &Prim) -> Result<(String, DAffine2)> {
    const MOST: usize = 16;
    let mut transform = DAffine2::IDENTITY;
    let (mut prim, mut property) = end(node, "inputs:st")?;
    for _ in 0..MOST {
        if !property.starts_with("outputs:") {
            break;
        }
        match prim.word("info:id")?.unwrap_or_default().as_str() {
            "UsdTransform2d" => {
                let two = |name: &str, otherwise: [f64; 2]| {
                    let (prim, property) = end(&prim, &format!("inputs:{name}"))?;
                    Ok(DVec2::from(prim.numbers::<2>(&property)?.unwrap_or(otherwise)))
                };
                let (scale, translation) = (two("scale", [1.0; 2])?, two("translation", [0.0; 2])?);
                let (angle, name) = end(&prim, "inputs:rotation")?;
                let angle = angle.number(&name)?.unwrap_or(0.0).to_radians();
                let matrix = DMat2::from_angle(angle) * DMat2::from_diagonal(scale);
                transform *= DAffine2::from_mat2_translation(matrix, translation);
                (prim, property) = end(&prim, "inputs:in")?;
            }
            _ => return Ok((primvar_name(&prim)?.unwrap_or_else(|| "st".to_owned()), transform)),
        }
    }
    Ok(("st".to_owned(), transform))
}
