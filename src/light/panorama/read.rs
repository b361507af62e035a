//! Reads Radiance and OpenEXR pictures with the crates `image` and `exr`, limiting size, memory and time.
//!
//! In addition to the limits of [`Average::new`] and of the file size: the header of a Radiance file has at
//! most [`MAX_HEAD`] bytes; an OpenEXR file has at most [`MAX_LAYERS`] layers with at most [`MAX_CHANNELS`]
//! channels each, and at most [`MAX_BLOCKS`] blocks (tiles, or lines compressed together) of at most
//! [`MAX_BLOCK_BYTES`] bytes. Besides the file and the numbers, reading takes 12 bytes for each pixel of a
//! Radiance file, and a block of an OpenEXR file both compressed and decompressed, the latter at most 64
//! times as large.

use std::io::{Cursor, Read as _};

use exr::{
    meta::{
        attribute::{ChannelDescription, EnvironmentMap},
        header::Header,
    },
    prelude::{ReadChannels as _, ReadLayers as _},
};
use glam::DVec3;
use image::{ImageDecoder as _, ImageError, codecs::hdr::HdrDecoder};

use super::average::{Average, MAX_FILE_COLUMNS};
use crate::{
    caught,
    parameter::FileProblem,
    text::{plural, shortened},
};

const RADIANCE: [&[u8]; 2] = [b"#?RADIANCE", b"#?RGBE"];
const OPEN_EXR: &[u8] = &[0x76, 0x2f, 0x31, 0x01];

/// Maximum size of the header of a Radiance file, in bytes.
const MAX_HEAD: usize = 64 << 10;
const MAX_LAYERS: usize = 64;
const MAX_CHANNELS: usize = 16;
const MAX_BLOCK_BYTES: usize = 16 << 20;
const MAX_BLOCKS: usize = 1 << 18;

/// Red, green, blue and white of Rec. 709 as in OpenEXR, x and y.
const REC_709: [[f32; 2]; 4] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], [0.3127, 0.3290]];

pub(super) fn read(bytes: &[u8]) -> Result<Vec<f32>, FileProblem> {
    // Decoders may panic on unforeseen input.
    let read = caught::catch(|| decode(bytes)?.numbers());
    let read = read.unwrap_or_else(|_| Err("its pixels do not match its header; save it again".to_owned()));
    read.map_err(|message| FileProblem { line: None, message })
}

fn decode(bytes: &[u8]) -> Result<Average, String> {
    if let Some(rest) = RADIANCE.iter().find_map(|begin| bytes.strip_prefix(*begin)) {
        radiance(rest)
    } else if bytes.starts_with(OPEN_EXR) {
        open_exr(bytes)
    } else {
        Err("it does not begin like a Radiance picture (#?RADIANCE) or an OpenEXR picture".to_owned())
    }
}

/// Reads a Radiance picture after its first word.
fn radiance(rest: &[u8]) -> Result<Average, String> {
    let head = &rest[..rest.len().min(MAX_HEAD)];
    let end = head.windows(2).position(|two| two == b"\n\n").map(|at| at + 2);
    let size = end.and_then(|end| head[end..].split_inclusive(|byte| *byte == b'\n').next());
    let Some(size) = size.filter(|size| size.ends_with(b"\n")) else {
        return Err(format!(
            "the header of a Radiance picture must end with an empty line and a line such as “-Y 512 +X \
             1024” within {MAX_HEAD} bytes"
        ));
    };
    let size = String::from_utf8_lossy(size);
    let words: Vec<_> = size.split_whitespace().collect();
    let [width, height] = match words[..] {
        ["-Y", height, "+X", width] => [width, height].map(|word| word.parse().ok()),
        _ => [None; 2],
    };
    let (Some(width), Some(height)) = (width, height) else {
        return Err(format!(
            "the size of a Radiance picture must be given as “-Y height +X width”, not “{}”",
            shortened(size.trim())
        ));
    };
    let blank = Average::new(width, height)?;
    let decoder = HdrDecoder::new(RADIANCE[0].chain(rest)).map_err(|error| match error {
        ImageError::Unsupported(_) => "its FORMAT must be 32-bit_rle_rgbe".to_owned(),
        error => format!("the header of the Radiance picture cannot be read: {error}"),
    })?;
    let meta = decoder.metadata();
    let exposure = meta.exposure.unwrap_or(1.0);
    let factors = meta.color_correction.map_or([exposure; 3], |(r, g, b)| [r, g, b].map(|c| c * exposure));
    if factors.iter().any(|factor| !factor.is_normal() || *factor < 0.0) {
        return Err("EXPOSURE and COLORCORR must be greater than 0".to_owned());
    }
    let mut pixels = vec![0; 12 * width * height];
    decoder.read_image(&mut pixels).map_err(|error| match error {
        ImageError::IoError(_) => "the file ends before its last pixel".to_owned(),
        error => format!("the pixels of the Radiance picture cannot be read: {error}"),
    })?;
    // The values of the file were multiplied by these factors.
    let mut average = blank.scaled(DVec3::from_array(factors.map(f64::from)).recip());
    for (i, pixel) in pixels.chunks_exact(12).enumerate() {
        let value = |at: usize| f32::from_ne_bytes([pixel[at], pixel[at + 1], pixel[at + 2], pixel[at + 3]]);
        average.add(i % width, i / width, [0, 4, 8].map(value));
    }
    Ok(average)
}

fn open_exr(bytes: &[u8]) -> Result<Average, String> {
    let reader = exr::block::read(Cursor::new(bytes), false).map_err(|error| broken(&error))?;
    let blank = within_limits(reader.headers())?;
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |_, _| blank.clone(),
            |average: &mut Average, at, (r, g, b): (f32, f32, f32)| average.add(at.x(), at.y(), [r, g, b]),
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_chunks(reader)
        .map_err(|error| broken(&error))?;
    Ok(image.layer_data.channel_data.pixels)
}

fn broken(error: &exr::error::Error) -> String {
    match error {
        exr::error::Error::NotSupported(what) => format!(
            "this kind of OpenEXR picture is not supported ({}); it must have flat pixels, uncompressed or \
             compressed with RLE, ZIP, PIZ, PXR24 or B44",
            shortened(what)
        ),
        error => {
            format!("the OpenEXR picture is incomplete or broken ({})", shortened(&error.to_string()))
        }
    }
}

/// The average for the layer that is read, the first one with red, green and blue, if the file respects the
/// limits.
fn within_limits(layers: &[Header]) -> Result<Average, String> {
    if layers.len() > MAX_LAYERS {
        let count = plural(layers.len(), "layer");
        return Err(format!("the OpenEXR file has {count}; at most {MAX_LAYERS} are read"));
    }
    for layer in layers {
        let channels = layer.channels.list.len();
        if channels > MAX_CHANNELS {
            return Err(format!("a layer has {channels} channels; at most {MAX_CHANNELS} are read"));
        }
        let [width, height] = [layer.layer_size.x(), layer.layer_size.y()];
        if width > MAX_FILE_COLUMNS || height > MAX_FILE_COLUMNS / 2 {
            let most = [MAX_FILE_COLUMNS, MAX_FILE_COLUMNS / 2];
            return Err(format!(
                "a layer has {width} × {height} pixels; at most {} × {} are read",
                most[0], most[1]
            ));
        }
        let block = layer.max_block_pixel_size();
        let bytes = block.x().saturating_mul(block.y()).saturating_mul(layer.channels.bytes_per_pixel);
        if bytes > MAX_BLOCK_BYTES || layer.chunk_count > MAX_BLOCKS {
            return Err(format!(
                "its tiles have up to {} × {} pixels, and there are {}; at most {MAX_BLOCK_BYTES} bytes per tile and {MAX_BLOCKS} tiles are read",
                block.x(),
                block.y(),
                layer.chunk_count
            ));
        }
    }
    let colours =
        |layer: &Header| ["R", "G", "B"].map(|name| layer.channels.list.iter().any(|c| c.name == *name));
    let Some(layer) = layers.iter().find(|layer| !layer.deep && colours(layer) == [true; 3]) else {
        let names: Vec<_> = layers
            .iter()
            .flat_map(|layer| &layer.channels.list)
            .map(|channel| channel.name.to_string())
            .collect();
        return Err(format!(
            "no layer has the channels R, G and B; the channels are {}",
            shortened(&names.join(", "))
        ));
    };
    let is_thin = |channel: &ChannelDescription| channel.sampling.x() != 1 || channel.sampling.y() != 1;
    if let Some(channel) = layer.channels.list.iter().find(|channel| is_thin(channel)) {
        let name = shortened(&channel.name.to_string());
        return Err(format!(
            "the channel {name} has fewer pixels than the picture; all channels must have the same number"
        ));
    }
    let (own, shared) = (&layer.own_attributes, &layer.shared_attributes);
    if own.environment_map == Some(EnvironmentMap::Cube) {
        return Err("it is a cube map, but must be equirectangular (latitude and longitude)".to_owned());
    }
    let [shown, there] = [shared.display_window.size, layer.layer_size];
    if shown != there {
        return Err(format!(
            "only {} × {} of {} × {} pixels are present (data window and display window); all must be",
            there.x(),
            there.y(),
            shown.x(),
            shown.y()
        ));
    }
    if let Some(primaries) = &shared.chromaticities {
        let found =
            [primaries.red, primaries.green, primaries.blue, primaries.white].map(|at| [at.x(), at.y()]);
        let near = |(a, b): (&f32, &f32)| (a - b).abs() < 2e-3;
        if !found.as_flattened().iter().zip(REC_709.as_flattened()).all(near) {
            let [x, y] = found[0];
            return Err(format!(
                "its colours must be linear Rec. 709, but its chromaticities differ (red at {x}, {y}, not 0.64, 0.33)"
            ));
        }
    }
    let white = own.white_luminance.unwrap_or(1.0);
    if !white.is_normal() || white < 0.0 {
        return Err(format!("its whiteLuminance must be greater than 0, not {white}"));
    }
    Ok(Average::new(layer.layer_size.x(), layer.layer_size.y())?.scaled(DVec3::splat(f64::from(white))))
}
