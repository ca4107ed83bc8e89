//! Information about a picture file, and the values of a pixel, as text and as JSON.

use std::fmt;
use std::path::Path;

use alhazen::image::{Attribute, Image, ImageInfo, LayerInfo, Pixels, Window};
use serde_json::{Map, Value, json};

use crate::numbers;

/// A picture file without its pixels.
pub struct FileInfo<'a> {
    /// Where the file is.
    pub path: &'a Path,
    /// Its length.
    pub bytes: u64,
    /// The information about its picture.
    pub info: ImageInfo,
}

impl FileInfo<'_> {
    /// All of it as one JSON object.
    pub fn to_json(&self) -> Value {
        let info = &self.info;
        let data = info.layers[0].data_window;
        let attributes: Map<_, _> =
            info.attributes.iter().map(|(name, value)| (name.clone(), attribute_json(value))).collect();
        json!({
            "status": "done",
            "file": self.path.display().to_string(),
            "bytes": self.bytes,
            "format": format!("{:?}", info.format).to_lowercase(),
            "width": data.width(),
            "height": data.height(),
            "display_window": window_json(info.display_window),
            "pixel_aspect": info.pixel_aspect,
            "layers": info.layers.iter().map(layer_json).collect::<Vec<_>>(),
            "attributes": attributes,
        })
    }
}

fn window_json(window: Window) -> Value {
    json!({ "min": window.min, "max": window.max })
}

fn layer_json(layer: &LayerInfo) -> Value {
    let channels: Vec<_> = layer
        .channels
        .iter()
        .map(|(name, sample)| json!({ "name": name, "type": sample.to_string() }))
        .collect();
    json!({
        "name": layer.name,
        "data_window": window_json(layer.data_window),
        "channels": channels,
        "compression": layer.compression,
        "tiles": layer.tiles,
    })
}

fn attribute_json(value: &Attribute) -> Value {
    match value {
        Attribute::Text(text) => json!(text),
        Attribute::TextList(texts) => json!(texts),
        Attribute::Integer(number) => json!(number),
        Attribute::Float(number) => json!(number),
        Attribute::Vector(numbers) => json!(numbers),
        Attribute::Matrix(matrix) => json!(matrix.transpose().to_cols_array_2d()),
    }
}

impl fmt::Display for FileInfo<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let info = &self.info;
        let main = &info.layers[0];
        let [width, height] = [main.data_window.width(), main.data_window.height()];
        let size = numbers::bytes(self.bytes);
        let format = format!("{:?}", info.format).to_uppercase();
        write!(f, "{}: {format}, {width} × {height} pixels, {size}", self.path.display())?;
        if main.data_window != info.display_window {
            write!(f, "\n  data window     {}", shown(main.data_window))?;
            write!(f, "\n  display window  {}", shown(info.display_window))?;
        }
        if info.pixel_aspect != 1.0 {
            write!(f, "\n  pixel aspect    {}", info.pixel_aspect)?;
        }
        if let Some(compression) = main.compression {
            let tiles = main.tiles.map(|[width, height]| format!(", tiles of {width} × {height}"));
            write!(f, "\n  compression     {compression}{}", tiles.unwrap_or_default())?;
        }
        for layer in &info.layers {
            write_layer(f, layer, main)?;
        }
        for (name, value) in &info.attributes {
            write!(f, "\n  {name:<15} {}", attribute_text(value))?;
        }
        Ok(())
    }
}

/// "x 0 to 639, y 0 to 479", both ends inside.
fn shown(window: Window) -> String {
    let ([x0, y0], [x1, y1]) = (window.min, window.max.map(|end| i64::from(end) - 1));
    format!("x {x0} to {x1}, y {y0} to {y1}")
}

/// A line for each type of sample in the layer; where its pixels lie if not where the main layer's
/// do.
fn write_layer(f: &mut fmt::Formatter<'_>, layer: &LayerInfo, main: &LayerInfo) -> fmt::Result {
    let title = if layer.name.is_empty() { "channels".into() } else { format!("layer {}", layer.name) };
    for run in layer.channels.chunk_by(|a, b| a.1 == b.1) {
        let names: Vec<_> = run.iter().map(|(name, _)| name.rsplit('.').next().unwrap_or(name)).collect();
        write!(f, "\n  {title:<15} {}, {}", names.join(" "), run[0].1)?;
    }
    if layer.data_window != main.data_window {
        write!(f, ", {}", shown(layer.data_window))?;
    }
    Ok(())
}

fn attribute_text(value: &Attribute) -> String {
    let joined =
        |numbers: &[f32]| numbers.iter().map(|number| format!("{number:?}")).collect::<Vec<_>>().join(" ");
    match value {
        Attribute::Text(text) => text.clone(),
        Attribute::TextList(texts) => texts.join(", "),
        Attribute::Integer(number) => number.to_string(),
        Attribute::Float(number) => number.to_string(),
        Attribute::Vector(numbers) => joined(numbers),
        Attribute::Matrix(matrix) => matrix.transpose().to_cols_array_2d().map(|row| joined(&row)).join("; "),
    }
}

/// The values of all channels at one pixel.
pub struct Pixel {
    at: [i32; 2],
    /// Names, linear values, and 8-bit codes where these are what the file stores.
    values: Vec<(String, f32, Option<u8>)>,
}

impl Pixel {
    /// The pixel of this column and row of the frame; an error if the picture has no such pixel.
    pub fn new(image: &Image, at: [i32; 2]) -> Result<Self, String> {
        let window = image.data_window();
        let inside = (0..2).all(|axis| window.min[axis] <= at[axis] && at[axis] < window.max[axis]);
        if !inside {
            return Err(format!("it has no pixel {},{}; it has {}", at[0], at[1], shown(window)));
        }
        let [x, y] = [0, 1].map(|axis| (at[axis] - window.min[axis]) as u32);
        let first = (y as usize * image.width() as usize + x as usize) * image.channel_count();
        let values = image.channels().iter().enumerate().map(|(c, name)| {
            let code = match image.pixels() {
                Pixels::U8(codes, _) => Some(codes[first + c]),
                Pixels::F16(_) | Pixels::F32(_) => None,
            };
            (name.clone(), image.channel(x, y, c), code)
        });
        Ok(Self { at, values: values.collect() })
    }

    /// The values as one JSON object; those that are not finite are `null`.
    pub fn to_json(&self, path: &Path) -> Value {
        let values: Map<_, _> =
            self.values.iter().map(|(name, value, _)| (name.clone(), json!(value))).collect();
        let codes: Map<_, _> =
            self.values.iter().filter_map(|(name, _, code)| Some((name.clone(), json!((*code)?)))).collect();
        json!({
            "status": "done",
            "file": path.display().to_string(),
            "pixel": self.at,
            "values": values,
            "codes": (!codes.is_empty()).then_some(codes),
        })
    }
}

impl fmt::Display for Pixel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, (name, value, code)) in self.values.iter().enumerate() {
            let line = if index == 0 { "" } else { "\n" };
            let code = code.map(|code| format!("  (code {code})")).unwrap_or_default();
            write!(f, "{line}{name:<10} {value}{code}")?;
        }
        Ok(())
    }
}
