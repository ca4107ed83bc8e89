//! `alhazen image`: pictures inspected, compared and converted.

use std::path::Path;

use alhazen::InSrgb;
use alhazen::image::flip::{PIXELS_PER_DEGREE, hdr_flip};
use alhazen::image::{
    Format, Image, ImageError, PixelSource, Projection, SampleDepth, WriteOptions, false_color::false_color,
    info as image_info, metrics, read, write,
};
use serde_json::json;

use crate::args::{self, Convert, Depth, Diff, Info, Metric};
use crate::console::say;
use crate::failure::{Failure, about_file};
use crate::inspect::{FileInfo, Pixel};
use crate::output;

fn open(path: &Path) -> Result<Image, Failure> {
    decode(&std::fs::read(path).map_err(|error| about_file(path, error))?, path)
}

fn decode(bytes: &[u8], path: &Path) -> Result<Image, Failure> {
    read(bytes, &path.to_string_lossy(), &Default::default()).map_err(|error| about_file(path, error))
}

/// Shows what a picture file holds, or the values of one of its pixels.
pub fn info(arguments: &Info) -> Result<(), Failure> {
    let path = &arguments.file;
    let bytes = std::fs::read(path).map_err(|error| about_file(path, error))?;
    match arguments.pixel {
        Some(pixel) => {
            let image = decode(&bytes, path)?;
            let pixel = Pixel::new(&image, pixel).map_err(|problem| about_file(path, problem))?;
            Ok(if arguments.json { say(pixel.to_json(path)) } else { say(pixel) }?)
        }
        None => {
            let info =
                image_info(&bytes, &path.to_string_lossy()).map_err(|error| about_file(path, error))?;
            let header = FileInfo { path, bytes: bytes.len() as u64, info };
            Ok(if arguments.json { say(header.to_json()) } else { say(header) }?)
        }
    }
}

/// Measures the difference of two pictures.
pub fn diff(arguments: &Diff) -> Result<(), Failure> {
    if let Some(path) = &arguments.output {
        output::check(path).map_err(Failure::Usage)?;
    }
    let (a, b) = (open(&arguments.a)?, open(&arguments.b)?);
    let wrong = |error: ImageError| Failure::Input(error.to_string());
    let difference = metrics::compare(&a, &b).map_err(wrong)?;
    let flip = hdr_flip(&a, &b, PIXELS_PER_DEGREE).map_err(wrong)?;
    if let Some(path) = &arguments.output {
        let picture = match arguments.metric {
            Metric::Flip => false_color(&flip.map, 1.0),
            Metric::Mse | Metric::Relmse => {
                let relative = arguments.metric == Metric::Relmse;
                let map = metrics::squared_error_map(&a, &b, relative).map_err(wrong)?;
                let largest =
                    map.values().filter(|value| value.is_finite()).fold(f32::MIN_POSITIVE, f32::max);
                false_color(&map, largest)
            }
        };
        let picture = picture.map_err(wrong)?;
        write(&picture, path, &WriteOptions::default()).map_err(|error| about_file(path, error))?;
    }
    if arguments.json {
        return Ok(say(json!({
            "status": "done",
            "mse": difference.mse,
            "relmse": difference.rel_mse,
            "flip": flip.mean,
            "max_error": difference.max_error,
            "mean_a": difference.reference_mean,
            "mean_b": difference.test_mean,
            "non_finite": difference.non_finite,
            "output": arguments.output.as_ref().map(|path| path.display().to_string()),
        }))?);
    }
    let means = |mean: [f64; 3]| mean.map(|channel| format!("{channel:.6}")).join("  ");
    let mut lines = vec![
        format!("MSE        {:.6e}", difference.mse),
        format!("relMSE     {:.6e}", difference.rel_mse),
        format!("FLIP       {:.6}", flip.mean),
        format!("max error  {:.6}", difference.max_error),
        format!("mean of A  {}", means(difference.reference_mean)),
        format!("mean of B  {}", means(difference.test_mean)),
    ];
    if difference.non_finite > 0 {
        lines.push(format!("{} values are not finite and left out", difference.non_finite));
    }
    lines.extend(arguments.output.as_ref().map(|path| format!("error picture in {}", path.display())));
    Ok(say(lines.join("\n"))?)
}

/// Writes a picture in another format.
pub fn convert(arguments: &Convert) -> Result<(), Failure> {
    output::check(&arguments.output).map_err(Failure::Usage)?;
    let outputs = std::slice::from_ref(&arguments.output);
    let display = output::display(&arguments.display, outputs).map_err(Failure::Usage)?;
    let mut image = open(&arguments.input)?;
    if let Some(projection) = arguments.projection {
        let projection = match projection {
            args::Projection::EqualArea => Projection::EqualArea,
            args::Projection::LatitudeLongitude => Projection::LatitudeLongitude,
        };
        image = image.reproject(projection).map_err(|error| about_file(&arguments.input, error))?;
    }
    let depth = match arguments.depth {
        Depth::Natural => SampleDepth::Natural,
        Depth::U8 => SampleDepth::U8,
        Depth::U16 => SampleDepth::U16,
        Depth::F16 => SampleDepth::F16,
        Depth::F32 => SampleDepth::F32,
    };
    let format = Format::from_name(&arguments.output.to_string_lossy());
    let shown = format.filter(|format| format.is_for_display());
    let shown = shown.map(|format| InSrgb::new(&image, format, &display));
    let picture = shown.as_ref().map_or(&image as &dyn PixelSource, |shown| shown);
    write(picture, &arguments.output, &WriteOptions { depth })
        .map_err(|error| about_file(&arguments.output, error))?;
    if arguments.json {
        say(json!({
            "status": "done",
            "output": arguments.output.display().to_string(),
            "width": image.width(),
            "height": image.height(),
            "channels": image.channels(),
        }))?;
    }
    Ok(())
}
