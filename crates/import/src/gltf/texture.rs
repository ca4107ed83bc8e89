//! References of materials to textures: the image, how it is sampled, and at which coordinates.

use description::{EdgeMode, TextureFilter, WrapMode};
use math::{DAffine2, DMat2, DVec2};

use super::document::{self, Document};
use super::json::{Place, Result};
use crate::log::Log;

/// A texture as one use of a material has it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TextureRef {
    /// The index of the image.
    pub image: usize,
    /// The number of the set of texture coordinates.
    pub set: usize,
    /// From texture coordinates to those of the image, of which [0, 1]² is the image, twice as
    /// wide or high where it is mirrored. v is up in both, unlike in the file.
    pub transform: DAffine2,
    /// Whether the image is followed by its mirror image, to the right and above.
    pub mirrored: [bool; 2],
    /// What is beyond the image.
    pub wrap: WrapMode,
    /// How texels are filtered.
    pub filter: TextureFilter,
    /// The place of the reference.
    pub pointer: String,
}

impl TextureRef {
    /// The texture that a member of an object refers to; `None` if it is absent, or has no image
    /// that is read.
    pub fn parse(document: &Document, place: &Place, key: &str) -> Result<Option<Self>> {
        let Some(info) = place.object(key)? else { return Ok(None) };
        let Some(index) = document.index(&info, "index", "textures")? else {
            return Err(info.invalid("`index` is missing"));
        };
        let mut set = info.integer("texCoord")?.unwrap_or(0);
        let mut transform = DAffine2::IDENTITY;
        if let Some(moved) = info.extension("KHR_texture_transform")? {
            set = moved.integer("texCoord")?.unwrap_or(set);
            let [x, y] = moved.numbers("offset")?.unwrap_or([0.0; 2]);
            let [width, height] = moved.numbers("scale")?.unwrap_or([1.0; 2]);
            let (sin, cos) = libm::sincos(moved.number("rotation")?.unwrap_or(0.0));
            // Counter-clockwise where v is down.
            let turn = DMat2::from_cols(DVec2::new(cos, -sin), DVec2::new(sin, cos));
            let scale = DMat2::from_diagonal(DVec2::new(width, height));
            transform = DAffine2::from_mat2_translation(turn * scale, DVec2::new(x, y));
        }
        if !transform.is_finite() || transform.to_cols_array().iter().any(|number| number.abs() > 1e30) {
            return Err(info.invalid("the numbers of the transform are too large"));
        }
        let texture = item(document, "textures", index, &info)?;
        let Some(image) = image(document, &texture)? else { return Ok(None) };
        let sampler = match document.index(&texture, "sampler", "samplers")? {
            Some(index) => Sampler::parse(&item(document, "samplers", index, &texture)?)?,
            None => Sampler { wraps: [REPEAT; 2], is_nearest: false },
        };
        let mirrored = sampler.wraps.map(|wrap| wrap == MIRRORED_REPEAT);
        let edges = sampler.wraps.map(|wrap| match wrap {
            CLAMP_TO_EDGE => EdgeMode::Clamp,
            _ => EdgeMode::Repeat,
        });
        // v is up from here on.
        let flip = DAffine2::from_scale_angle_translation(DVec2::new(1.0, -1.0), 0.0, DVec2::Y);
        let scale = DVec2::new(if mirrored[0] { 0.5 } else { 1.0 }, if mirrored[1] { 0.5 } else { 1.0 });
        Ok(Some(Self {
            image,
            set,
            transform: DAffine2::from_scale(scale) * flip * transform * flip,
            mirrored,
            wrap: WrapMode::of_axes(edges),
            filter: if sampler.is_nearest { TextureFilter::Point } else { TextureFilter::Bilinear },
            pointer: info.pointer,
        }))
    }
}

fn item<'a>(document: &Document<'a>, array: &str, index: usize, user: &Place) -> Result<Place<'a>> {
    document.item(array, index).ok_or_else(|| user.invalid(format!("/{array}/{index} is no object")))
}

/// Says which textures have no image that is read, so that they are left out.
pub(super) fn check(document: &Document, log: &mut Log) {
    for texture in document.items("textures") {
        // Faults of a reference are reported by those who use it.
        let Ok(None) = image(document, &texture) else { continue };
        let names = texture.get("extensions").and_then(|extensions| extensions.value.as_object());
        let names: Vec<_> = names.into_iter().flat_map(|names| names.keys()).map(String::as_str).collect();
        let reason = match names.as_slice() {
            [] => "it has no image".to_owned(),
            names => {
                let unread = names.iter().find_map(|name| document::unread(name));
                let unread = unread.unwrap_or_else(|| "is not read".into());
                format!("its image is in `{}`, which {unread}", names.join("`, `"))
            }
        };
        let message = format!("this texture is left out, and its factor is drawn alone: {reason}");
        log.warn("not-drawn", texture.pointer, message);
    }
}

/// The image of a texture: of those in several formats the one that is read; `None` if there is
/// none.
fn image(document: &Document, texture: &Place) -> Result<Option<usize>> {
    if let Some(webp) = texture.extension("EXT_texture_webp")?
        && let Some(index) = document.index(&webp, "source", "images")?
    {
        return Ok(Some(index));
    }
    if let Some(index) = document.index(texture, "source", "images")? {
        return Ok(Some(index));
    }
    let packed = texture.extension("KHR_texture_basisu")?.filter(|_| cfg!(feature = "basis"));
    packed.map_or(Ok(None), |packed| document.index(&packed, "source", "images"))
}

const CLAMP_TO_EDGE: usize = 33071;
const MIRRORED_REPEAT: usize = 33648;
const REPEAT: usize = 10497;

/// How an image is sampled.
struct Sampler {
    wraps: [usize; 2],
    is_nearest: bool,
}

impl Sampler {
    fn parse(place: &Place) -> Result<Self> {
        const NEAREST: usize = 9728;
        const LINEAR: usize = 9729;
        let choice = |key: &str, default: usize, known: &[usize]| {
            let code = place.integer(key)?.unwrap_or(default);
            match known.contains(&code) {
                true => Ok(code),
                false => Err(place.invalid_member(key, format!("{code} is not a value of it"))),
            }
        };
        let wraps = [CLAMP_TO_EDGE, MIRRORED_REPEAT, REPEAT];
        choice("minFilter", LINEAR, &[NEAREST, LINEAR, 9984, 9985, 9986, 9987])?;
        Ok(Self {
            wraps: [choice("wrapS", REPEAT, &wraps)?, choice("wrapT", REPEAT, &wraps)?],
            is_nearest: choice("magFilter", LINEAR, &[NEAREST, LINEAR])? == NEAREST,
        })
    }
}
