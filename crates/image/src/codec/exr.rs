//! OpenEXR, by the block interface of the `exr` crate: every compression that it supports, scan
//! lines and tiles, of mip levels the largest, of several parts the first with colour. Deep and
//! chroma-subsampled pictures are refused.
//!
//! Blocks are unpacked on the calling thread pool rather than by the crate's own threads, as a
//! panic on those would end the process. Sources: [OpenEXR file layout].

use std::io::{BufWriter, Cursor, Read, SeekFrom, Write};

use exr::{
    block::{self, BlockIndex, UncompressedBlock, chunk::Chunk, reader::ChunksReader, writer::ChunksWriter},
    compression::Compression,
    math::Vec2,
    meta::{
        BlockDescription,
        attribute::{self, AttributeValue, ChannelDescription, IntegerBounds, LineOrder, SampleType, Text},
        header::{Header, ImageAttributes, LayerAttributes},
    },
};
use half::f16;
use math::Mat4;
use rayon::prelude::*;

use super::{Output, ReadOptions, WriteOptions};
use crate::{
    depth::SampleDepth,
    error::ImageError,
    image::{Image, Pixels},
    memory::filled,
    metadata::{Attribute, Chromaticities, ImageMetadata, Window},
    source::{Channel, PixelSource},
};

/// The number of blocks that are in memory, packed and unpacked, at a time.
const BATCH: usize = 64;

/// Pictures of half floats alone stay so; all others become single floats. Channels are ordered R,
/// G, B, A, then by name.
pub fn decode(bytes: &[u8], options: &ReadOptions) -> Result<Image, ImageError> {
    let reader = block::read(Cursor::new(bytes), false).map_err(from_library)?;
    let layer = choose_layer(reader.headers())?;
    let header = reader.headers()[layer].clone();
    let (width, height) = (header.layer_size.width(), header.layer_size.height());
    let all_half = header.channels.uniform_sample_type == Some(SampleType::F16);
    let sample_bytes = if all_half { 2 } else { 4 };
    options.check_size(width, height, sample_bytes * header.channels.list.len(), bytes.len())?;

    let chunks = reader
        .filter_chunks(false, |_, _, block| block.layer == layer && block.level == Vec2(0, 0))
        .map_err(from_library)?;
    let (names, slots) = channel_order(&header);
    let count = width * height * names.len();
    let target = Target { width, channels: &slots };
    let pixels = if all_half {
        let mut values = filled(count, f16::ZERO)?;
        read_blocks(chunks, bytes.len(), |block| target.scatter(block, &header, f16::from_f32, &mut values))?;
        Pixels::F16(values)
    } else {
        let mut values = filled(count, 0.0)?;
        read_blocks(chunks, bytes.len(), |block| target.scatter(block, &header, |v| v, &mut values))?;
        Pixels::F32(values)
    };
    let side = |size| u32::try_from(size).map_err(|_| ImageError::Limits(format!("a side of {size} pixels")));
    let mut image = Image::new(side(width)?, side(height)?, names, pixels)?;
    image.metadata = metadata(&header);
    Ok(image)
}

/// The first layer with colour, else the first that is not deep.
fn choose_layer(headers: &[Header]) -> Result<usize, ImageError> {
    let has_color = |header: &Header| {
        header
            .channels
            .list
            .iter()
            .any(|c| c.name.eq("R") || c.name.eq("Y") || c.name.as_slice().ends_with(b".R"))
    };
    let flat = || headers.iter().enumerate().filter(|(_, header)| !header.deep);
    let chosen = flat().find(|(_, header)| has_color(header)).or_else(|| flat().next());
    chosen.map(|(index, _)| index).ok_or_else(|| ImageError::Unsupported("deep EXR".into()))
}

/// The names of the image's channels, and the index in it of each of the file's. Files have them by
/// name; an image has the colours first, and in each layer red, green, blue and alpha in this
/// order.
fn channel_order(header: &Header) -> (Vec<String>, Vec<usize>) {
    let in_file: Vec<String> = header.channels.list.iter().map(|channel| from_text(&channel.name)).collect();
    let rank = |name: &str| {
        ["R", "G", "B", "A"].iter().position(|usual| usual.eq_ignore_ascii_case(name)).unwrap_or(4)
    };
    let place = |name: &str| match name.rsplit_once('.') {
        Some((layer, channel)) => (true, layer.to_owned(), rank(channel)),
        None if rank(name) < 4 => (false, String::new(), rank(name)),
        None => (true, name.to_owned(), 0),
    };
    let mut order: Vec<usize> = (0..in_file.len()).collect();
    order.sort_by_cached_key(|&index| place(&in_file[index]));
    let mut slots = vec![0; in_file.len()];
    for (slot, &index) in order.iter().enumerate() {
        slots[index] = slot;
    }
    (order.into_iter().map(|index| in_file[index].clone()).collect(), slots)
}

/// Unpacks all chunks, some at a time, and hands each to `accept` in the order of the file.
fn read_blocks(
    mut chunks: impl ChunksReader,
    file_length: usize,
    mut accept: impl FnMut(&UncompressedBlock) -> Result<(), ImageError>,
) -> Result<(), ImageError> {
    let meta = chunks.meta_data().clone();
    let mut packed_bytes = 0;
    loop {
        let batch: Vec<Chunk> =
            chunks.by_ref().take(BATCH).collect::<Result<_, _>>().map_err(from_library)?;
        if batch.is_empty() {
            return Ok(());
        }
        packed_bytes += batch.iter().map(packed_size).sum::<usize>();
        if packed_bytes > file_length {
            return Err(ImageError::Invalid("EXR blocks overlap".into()));
        }
        let blocks: Vec<UncompressedBlock> = batch
            .into_par_iter()
            .map(|chunk| UncompressedBlock::decompress_chunk(chunk, &meta, false))
            .collect::<Result<_, _>>()
            .map_err(from_library)?;
        blocks.iter().try_for_each(&mut accept)?;
    }
}

fn packed_size(chunk: &Chunk) -> usize {
    use block::chunk::CompressedBlock::{ScanLine, Tile};
    match &chunk.compressed_block {
        ScanLine(block) => block.compressed_pixels_le.len(),
        Tile(block) => block.compressed_pixels_le.len(),
        _ => 0,
    }
}

/// Where the samples of a block go in an image of interleaved channels.
struct Target<'a> {
    width: usize,
    /// The place of each of the file's channels within a pixel.
    channels: &'a [usize],
}

impl Target<'_> {
    fn scatter<T>(
        &self,
        block: &UncompressedBlock,
        header: &Header,
        convert: impl Fn(f32) -> T,
        values: &mut [T],
    ) -> Result<(), ImageError> {
        for line in block.lines(&header.channels) {
            let Vec2(x, y) = line.location.position;
            let start = (y * self.width + x) * self.channels.len() + self.channels[line.location.channel];
            let places =
                values[start..].iter_mut().step_by(self.channels.len()).take(line.location.sample_count);
            match header.channels.list[line.location.channel].sample_type {
                SampleType::F16 => {
                    fill(places, line.read_samples::<f16>(), |sample| convert(sample.to_f32()))
                }
                SampleType::F32 => fill(places, line.read_samples::<f32>(), &convert),
                SampleType::U32 => fill(places, line.read_samples::<u32>(), |sample| convert(sample as f32)),
            }
            .map_err(from_library)?;
        }
        Ok(())
    }
}

fn fill<'a, S, T: 'a>(
    places: impl Iterator<Item = &'a mut T>,
    samples: impl Iterator<Item = exr::error::Result<S>>,
    convert: impl Fn(S) -> T,
) -> exr::error::UnitResult {
    for (place, sample) in places.zip(samples) {
        *place = convert(sample?);
    }
    Ok(())
}

pub(super) fn metadata(header: &Header) -> ImageMetadata {
    let mut metadata = ImageMetadata {
        chromaticities: header.shared_attributes.chromaticities.map(|c| Chromaticities {
            red: [c.red.0, c.red.1],
            green: [c.green.0, c.green.1],
            blue: [c.blue.0, c.blue.1],
            white: [c.white.0, c.white.1],
        }),
        data_window: Some(from_bounds(header.data_window())),
        display_window: Some(from_bounds(header.shared_attributes.display_window)),
        pixel_aspect: header.shared_attributes.pixel_aspect,
        ..ImageMetadata::default()
    };
    let own = &header.own_attributes;
    for (name, value) in header.shared_attributes.other.iter().chain(&own.other) {
        if let Some(attribute) = from_attribute(value) {
            metadata.set(&from_text(name), attribute);
        }
    }
    let typed = [
        (
            ImageMetadata::WORLD_TO_CAMERA,
            own.world_to_camera.map(|m| Attribute::Matrix(Mat4::from_cols_array(&m))),
        ),
        (
            ImageMetadata::WORLD_TO_NDC,
            own.world_to_normalized_device.map(|m| Attribute::Matrix(Mat4::from_cols_array(&m))),
        ),
        (ImageMetadata::SOFTWARE, own.software_name.as_ref().map(|text| Attribute::Text(from_text(text)))),
        (ImageMetadata::COMMENTS, own.comments.as_ref().map(|text| Attribute::Text(from_text(text)))),
    ];
    for (name, attribute) in typed {
        if let Some(attribute) = attribute {
            metadata.set(name, attribute);
        }
    }
    metadata
}

pub(super) fn from_bounds(bounds: IntegerBounds) -> Window {
    let end = bounds.end();
    Window { min: [bounds.position.0, bounds.position.1], max: [end.0, end.1] }
}

fn from_attribute(value: &AttributeValue) -> Option<Attribute> {
    Some(match value {
        AttributeValue::Text(text) => Attribute::Text(from_text(text)),
        AttributeValue::TextVector(texts) => Attribute::TextList(texts.iter().map(from_text).collect()),
        AttributeValue::I32(number) => Attribute::Integer(*number),
        AttributeValue::F32(number) => Attribute::Float(*number),
        AttributeValue::F64(number) => Attribute::Float(*number as f32),
        AttributeValue::FloatVec2(v) => Attribute::Vector(vec![v.0, v.1]),
        AttributeValue::FloatVec3(v) => Attribute::Vector(vec![v.0, v.1, v.2]),
        AttributeValue::Matrix4x4(m) => Attribute::Matrix(Mat4::from_cols_array(m)),
        _ => return None,
    })
}

/// Writes scan lines packed by ZIP, sixteen at a time.
pub fn encode(
    picture: &dyn PixelSource,
    options: &WriteOptions,
    output: &mut dyn Output,
) -> Result<(), ImageError> {
    let sample_type = |depth| match (options.depth, depth) {
        (SampleDepth::Natural, SampleDepth::F32) | (SampleDepth::F32, _) => Ok(SampleType::F32),
        (SampleDepth::Natural, _) | (SampleDepth::F16, _) => Ok(SampleType::F16),
        (depth, _) => Err(ImageError::Unsupported(format!("EXR does not hold samples of depth {depth:?}"))),
    };
    let channels = picture.channels();
    let mut order: Vec<usize> = (0..channels.len()).collect();
    order.sort_by_key(|&c| channels[c].name.as_bytes());
    let descriptions = order
        .iter()
        .map(|&c| {
            let Channel { name, depth } = &channels[c];
            Ok(ChannelDescription::named(to_text(name), sample_type(*depth)?))
        })
        .collect::<Result<_, ImageError>>()?;

    let size = Vec2(picture.width() as usize, picture.height() as usize);
    let (shared, own) = attributes(picture)?;
    let header = Header::new(Text::default(), size, descriptions)
        .with_encoding(Compression::ZIP16, BlockDescription::ScanLines, LineOrder::Increasing)
        .with_attributes(own)
        .with_shared_attributes(shared);
    let headers = exr::meta::Headers::from_iter([header]);
    let start = output.stream_position()?;
    let mut buffered = BufWriter::new(&mut *output);
    block::write(&mut buffered, headers, true, |meta, writer| {
        let mut blocks = block::enumerate_ordered_header_block_indices(&meta.headers);
        loop {
            let batch: Vec<_> = blocks.by_ref().take(BATCH).collect();
            if batch.is_empty() {
                return Ok(());
            }
            let chunks = batch
                .into_par_iter()
                .map(|(index, block)| {
                    let block = pack(picture, &order, &meta.headers[0], block);
                    Ok((index, block.compress_to_chunk(&meta.headers)?))
                })
                .collect::<exr::error::Result<Vec<_>>>()?;
            chunks.into_iter().try_for_each(|(index, chunk)| writer.write_chunk(index, chunk))?;
        }
    })
    .map_err(from_library)?;
    buffered.flush()?;
    drop(buffered);
    sort_attributes(output, start)
}

/// Sorts the attributes of a file's header by name, so that the same picture gives the same bytes:
/// the library's order is random. Nothing after the header moves.
fn sort_attributes(file: &mut dyn Output, start: u64) -> Result<(), ImageError> {
    /// The magic number and the version.
    const BEFORE: u64 = 8;
    file.seek(SeekFrom::Start(start + BEFORE))?;
    let (mut header, mut attributes, mut end) = (Vec::new(), Vec::new(), 0);
    loop {
        let more = (&mut *file).take(1 << 16).read_to_end(&mut header)?;
        while let Some(length) = attribute_length(&header[end..]) {
            attributes.push(end..end + length);
            end += length;
        }
        if more == 0 || header.get(end) == Some(&0) {
            break;
        }
    }
    // With its terminating zero, no name is a prefix of another.
    attributes.sort_unstable_by_key(|range| &header[range.clone()]);
    let sorted: Vec<u8> = attributes.into_iter().flat_map(|range| header[range].iter().copied()).collect();
    file.seek(SeekFrom::Start(start + BEFORE))?;
    file.write_all(&sorted)?;
    file.seek(SeekFrom::End(0))?;
    Ok(())
}

/// The length of the first attribute of a header: name and type, each with a terminating zero, the
/// value's length, the value. `None` at the header's end.
fn attribute_length(header: &[u8]) -> Option<usize> {
    let name = header.iter().position(|&byte| byte == 0).filter(|&length| length > 0)?;
    let kind = header[name + 1..].iter().position(|&byte| byte == 0)?;
    let value = name + kind + 2;
    let length = header.get(value..value + 4)?.try_into().ok()?;
    Some(value + 4 + u32::from_le_bytes(length) as usize).filter(|&length| length <= header.len())
}

fn pack(picture: &dyn PixelSource, order: &[usize], header: &Header, block: BlockIndex) -> UncompressedBlock {
    let count = order.len();
    let mut row = vec![0.0; picture.width() as usize * count];
    let mut in_row = None;
    UncompressedBlock::from_lines(&header.channels, block, |line| {
        let Vec2(x0, y) = line.location.position;
        if in_row != Some(y) {
            picture.row(y as u32, &mut row);
            in_row = Some(y);
        }
        let channel = line.location.channel;
        let samples = row[x0 * count + order[channel]..].iter().step_by(count);
        if header.channels.list[channel].sample_type == SampleType::F16 {
            for (bytes, &sample) in line.value.chunks_exact_mut(2).zip(samples) {
                bytes.copy_from_slice(&f16::from_f32(sample).to_ne_bytes());
            }
        } else {
            for (bytes, &sample) in line.value.chunks_exact_mut(4).zip(samples) {
                bytes.copy_from_slice(&sample.to_ne_bytes());
            }
        }
    })
}

fn attributes(image: &dyn PixelSource) -> Result<(ImageAttributes, LayerAttributes), ImageError> {
    let metadata = image.metadata();
    let data = image.data_window();
    if (data.width(), data.height()) != (image.width(), image.height()) {
        return Err(ImageError::Invalid(format!("{data:?} is not the size of the image")));
    }
    let display = image.display_window();
    let size = Vec2(display.width() as usize, display.height() as usize);
    let mut shared = ImageAttributes::new(IntegerBounds::new(Vec2(display.min[0], display.min[1]), size));
    shared.pixel_aspect = metadata.pixel_aspect;
    shared.chromaticities = metadata.chromaticities.map(|c| attribute::Chromaticities {
        red: Vec2(c.red[0], c.red[1]),
        green: Vec2(c.green[0], c.green[1]),
        blue: Vec2(c.blue[0], c.blue[1]),
        white: Vec2(c.white[0], c.white[1]),
    });
    let mut own = LayerAttributes::default().with_position(Vec2(data.min[0], data.min[1]));
    for (name, value) in &metadata.attributes {
        match (name.as_str(), value) {
            (ImageMetadata::WORLD_TO_CAMERA, Attribute::Matrix(m)) => {
                own.world_to_camera = Some(m.to_cols_array())
            }
            (ImageMetadata::WORLD_TO_NDC, Attribute::Matrix(m)) => {
                own.world_to_normalized_device = Some(m.to_cols_array())
            }
            (ImageMetadata::SOFTWARE, Attribute::Text(text)) => own.software_name = Some(to_text(text)),
            (ImageMetadata::COMMENTS, Attribute::Text(text)) => own.comments = Some(to_text(text)),
            _ => {
                own.other.insert(to_text(name), to_attribute(name, value)?);
            }
        }
    }
    Ok((shared, own))
}

fn to_attribute(name: &str, value: &Attribute) -> Result<AttributeValue, ImageError> {
    Ok(match value {
        Attribute::Text(text) => AttributeValue::Text(to_text(text)),
        Attribute::TextList(texts) => {
            AttributeValue::TextVector(texts.iter().map(|text| to_text(text)).collect())
        }
        Attribute::Integer(number) => AttributeValue::I32(*number),
        Attribute::Float(number) => AttributeValue::F32(*number),
        Attribute::Matrix(m) => AttributeValue::Matrix4x4(m.to_cols_array()),
        Attribute::Vector(v) => match v[..] {
            [x, y] => AttributeValue::FloatVec2(Vec2(x, y)),
            [x, y, z] => AttributeValue::FloatVec3((x, y, z)),
            _ => {
                return Err(ImageError::Unsupported(format!(
                    "attribute {name} is a vector of {} numbers",
                    v.len()
                )));
            }
        },
    })
}

/// Texts and names of a file are UTF-8.
fn to_text(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}

/// What is no UTF-8 is read as Latin-1, as some programs write it.
pub(super) fn from_text(text: &Text) -> String {
    std::str::from_utf8(text.as_slice()).map_or_else(|_| text.to_string(), str::to_owned)
}

pub(super) fn from_library(error: exr::error::Error) -> ImageError {
    use exr::error::Error;
    match error {
        Error::Io(error) => ImageError::Io(error),
        Error::NotSupported(text) => ImageError::Unsupported(format!("EXR: {text}")),
        Error::Invalid(text) => ImageError::Invalid(format!("EXR: {text}")),
        Error::Aborted => ImageError::Invalid("EXR: aborted".into()),
    }
}
