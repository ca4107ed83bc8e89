//! The header of a picture: the camera and settings of the scene.

use description::schema::Settings;
use description::{CameraKind, SceneDesc};
use film::{Development, Film, Layer};
use image::{Attribute, Image, ImageError, ImageMetadata};
use integrators::SessionState;
use math::Mat4;
use scene::Scene;
use serde_json::{Map, Value, json};

/// The most bytes of the names in a table; further names are left out.
const MAX_NAME_BYTES: usize = 4 << 20;

/// The header of a picture: the camera and settings of the scene, and the names of identifiers.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    attributes: Vec<(String, Attribute)>,
    /// The names of objects, materials and assets, where the film has their identifiers.
    names: [Vec<String>; ID_LAYERS.len()],
}

/// The layers of identifiers that [`Header::names`] are for, and their keys in JSON.
const ID_LAYERS: [(Layer, &str); Layer::IDS.len()] =
    [(Layer::ObjectId, "objects"), (Layer::MaterialId, "materials"), (Layer::AssetId, "assets")];

impl Header {
    /// The header of pictures of a scene.
    pub(crate) fn of(desc: &SceneDesc, scene: &Scene, film: &Film) -> Self {
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
        let names = scene.names();
        let listed = |layer, names: &mut dyn Iterator<Item = String>| match film.layers().has(layer) {
            true => limited(names),
            false => Vec::new(),
        };
        Self {
            attributes: attributes.map(|(name, value)| (name.to_owned(), value)).to_vec(),
            names: [
                listed(Layer::ObjectId, &mut names.objects()),
                listed(Layer::MaterialId, &mut names.materials().map(str::to_owned)),
                listed(Layer::AssetId, &mut names.assets()),
            ],
        }
    }

    /// The picture of a render so far, with this header and the number of passes; refused where
    /// there is no memory for it.
    pub fn picture(&self, state: &SessionState) -> Result<Image, ImageError> {
        self.picture_of(state, state.done.count())
    }

    /// [`Self::picture`] with all layers. Rows are computed when they are read, so that a large
    /// picture needs no copy in memory.
    pub fn development<'state>(&self, state: &'state SessionState) -> Development<'state> {
        self.named(state.development(), state.done.count())
    }

    /// A picture with this header.
    pub(crate) fn named<'film>(
        &self,
        mut development: Development<'film>,
        samples_per_pixel: u32,
    ) -> Development<'film> {
        self.set(&mut development.metadata, samples_per_pixel);
        for ((layer, _), names) in ID_LAYERS.into_iter().zip(&self.names) {
            development.set_names(layer, names);
        }
        development
    }

    /// The picture of a render with this number of samples per pixel.
    pub(crate) fn picture_of(
        &self,
        state: &SessionState,
        samples_per_pixel: u32,
    ) -> Result<Image, ImageError> {
        let mut picture = state.develop()?;
        self.set(&mut picture.metadata, samples_per_pixel);
        Ok(picture)
    }

    fn set(&self, metadata: &mut ImageMetadata, samples_per_pixel: u32) {
        for (name, value) in &self.attributes {
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
        let attributes = self.attributes.iter().map(|(name, attribute)| (name.clone(), value(attribute)));
        let mut json = json!({ "attributes": attributes.collect::<Map<_, _>>() });
        for ((_, key), names) in ID_LAYERS.into_iter().zip(&self.names) {
            json[key] = json!(names);
        }
        json
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
        let attributes = json["attributes"].as_object()?.iter();
        let attributes = attributes.map(|(name, json)| Some((name.clone(), value(json)?)));
        let list = |(_, key): (Layer, &str)| {
            let names = json[key].as_array().into_iter().flatten();
            names.map(|name| Some(name.as_str()?.to_owned())).collect::<Option<Vec<_>>>()
        };
        let [objects, materials, assets] = ID_LAYERS.map(list);
        let names = [objects?, materials?, assets?];
        Some(Self { attributes: attributes.collect::<Option<_>>()?, names })
    }
}

/// As many of these names as fit in a header.
fn limited(names: &mut dyn Iterator<Item = String>) -> Vec<String> {
    let mut bytes = 0;
    let fits = |name: &String| {
        bytes += name.len();
        bytes <= MAX_NAME_BYTES
    };
    names.take_while(fits).collect()
}
