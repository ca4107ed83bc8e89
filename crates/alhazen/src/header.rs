//! The header of a picture: the camera and settings of the scene.

use description::schema::Settings;
use description::{CameraKind, SceneDesc};
use film::{Development, Film};
use image::{Attribute, Image, ImageMetadata};
use integrators::SessionState;
use math::Mat4;
use serde_json::{Map, Value, json};

/// The header of a picture: the camera and settings of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Header(Vec<(String, Attribute)>);

impl Header {
    /// The header of pictures of a scene.
    pub(crate) fn of(desc: &SceneDesc) -> Self {
        let camera = match &desc.camera.kind {
            CameraKind::Perspective { fov, .. } => format!("perspective, {fov} degrees"),
            CameraKind::Orthographic { .. } => "orthographic".into(),
            CameraKind::Spherical { .. } => "spherical".into(),
            CameraKind::Realistic(_) => "realistic".into(),
        };
        let transform = desc.camera.camera_from_world.start.as_mat4();
        let attributes = [
            (ImageMetadata::SOFTWARE, Attribute::Text(concat!("alhazen ", env!("CARGO_PKG_VERSION")).into())),
            (ImageMetadata::WORLD_TO_CAMERA, Attribute::Matrix(transform)),
            ("camera", Attribute::Text(camera)),
            ("integrator", Attribute::Text(desc.integrator.name().into())),
            ("sampler", Attribute::Text(desc.sampler.name().into())),
            ("seed", Attribute::Integer(desc.sampler.seed.unwrap_or(desc.options.seed))),
        ];
        Self(attributes.map(|(name, value)| (name.to_owned(), value)).to_vec())
    }

    /// The picture of a render so far, with this header and the number of passes.
    pub fn picture(&self, state: &SessionState) -> Image {
        state.with_film(|film| self.picture_of(film, state.done.count()))
    }

    /// Calls `look` with [`Self::picture`] and all layers. Rows are computed when they are read, so
    /// that a large picture needs no copy in memory.
    pub fn with_development<T>(&self, state: &SessionState, look: impl FnOnce(&Development) -> T) -> T {
        state.with_film(|film| {
            let mut development = film.development();
            self.set(&mut development.metadata, state.done.count());
            look(&development)
        })
    }

    /// The picture of a film with this number of samples per pixel.
    pub(crate) fn picture_of(&self, film: &Film, samples_per_pixel: u32) -> Image {
        let mut picture = film.develop();
        self.set(&mut picture.metadata, samples_per_pixel);
        picture
    }

    fn set(&self, metadata: &mut ImageMetadata, samples_per_pixel: u32) {
        for (name, value) in &self.0 {
            metadata.set(name, value.clone());
        }
        metadata.set("samplesPerPixel", Attribute::Integer(samples_per_pixel as i32));
    }

    /// As JSON: strings, integers and matrices.
    pub(crate) fn to_json(&self) -> Value {
        let value = |value: &Attribute| match value {
            Attribute::Text(text) => json!(text),
            Attribute::Integer(number) => json!(number),
            Attribute::Matrix(matrix) => json!(matrix.to_cols_array()),
            Attribute::TextList(_) | Attribute::Float(_) | Attribute::Vector(_) => Value::Null,
        };
        self.0.iter().map(|(name, attribute)| (name.clone(), value(attribute))).collect::<Map<_, _>>().into()
    }

    /// Parses the JSON of [`to_json`](Self::to_json).
    pub(crate) fn from_json(json: &Value) -> Option<Self> {
        let value = |value: &Value| match value {
            Value::String(text) => Some(Attribute::Text(text.clone())),
            Value::Number(number) => Some(Attribute::Integer(i32::try_from(number.as_i64()?).ok()?)),
            Value::Array(columns) => {
                let columns: Option<Vec<f32>> =
                    columns.iter().map(|number| number.as_f64().map(|number| number as f32)).collect();
                let columns: [f32; 16] = columns?.try_into().ok()?;
                Some(Attribute::Matrix(Mat4::from_cols_array(&columns)))
            }
            _ => None,
        };
        let attributes = json.as_object()?.iter();
        attributes.map(|(name, json)| Some((name.clone(), value(json)?))).collect::<Option<_>>().map(Self)
    }
}
