//! Reads Radiance and OpenEXR pictures with the crates `image` and `exr`, limiting size, memory and time.
//!
//! In addition to the [`Limits`] of the reader and of the file size: an OpenEXR file has at most [`MAX_LAYERS`]
//! layers and at most [`MAX_BLOCKS`] blocks (tiles, or lines compressed together) of at most [`MAX_BLOCK_BYTES`]
//! bytes. Besides the file and the [`Pixels`], reading takes 12 bytes for each pixel of a Radiance file, and a block
//! of an OpenEXR file both compressed and decompressed, the latter at most 64 times as large.

use std::io::{Cursor, Read as _};

use exr::{
    meta::{
        attribute::{ChannelDescription, EnvironmentMap},
        header::Header,
    },
    prelude::{ReadChannels as _, ReadLayers as _, ReadSpecificChannel as _, Vec2},
};
use glam::DVec3;
use image::{ImageDecoder as _, ImageError, codecs::hdr::HdrDecoder};

use super::{RADIANCE_USUAL, REC_709};
use crate::{
    caught, files,
    text::{plural, shortened},
};

const RADIANCE: [&[u8]; 2] = [b"#?RADIANCE", b"#?RGBE"];

/// The key of the chromaticities in the header of a Radiance picture.
const PRIMARIES: &str = "PRIMARIES";

const MAX_LAYERS: usize = 64;
const MAX_BLOCK_BYTES: usize = 16 << 20;
const MAX_BLOCKS: usize = 1 << 18;

/// The limits of a reader, and the kind of its pictures.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Maximum size of the header of a Radiance file, in bytes.
    pub head: usize,
    /// Maximum number of channels of a layer of an OpenEXR file.
    pub channels: usize,
    /// Maximum number of columns and of rows of a layer of an OpenEXR file.
    pub size: [usize; 2],
    /// True for pictures of surroundings in cd/m²: `whiteLuminance` counts, and there must be no cube map.
    pub surroundings: bool,
}

/// Receives the pixels of a file, in any order.
pub trait Pixels: Sized {
    /// Checks the width and height.
    ///
    /// # Errors
    /// Returns the rule that the size breaks.
    fn check(width: usize, height: usize) -> Result<(), String>;

    /// A picture of a checked size without pixels. Numbers of the file times `scale` are light.
    fn new(width: usize, height: usize, scale: DVec3) -> Self;

    /// Adds a pixel: red, green, blue, and its opacity, which is not a number where the file has none.
    fn add(&mut self, column: usize, row: usize, pixel: [f32; 4]);
}

/// Reads a picture, the first layer of an OpenEXR file with the channels R, G and B.
///
/// # Errors
/// Returns the reason why the file is not a picture within the limits.
pub fn read<P: Pixels>(bytes: &[u8], limits: &Limits) -> Result<P, String> {
    // Decoders may panic on unforeseen input.
    let read = caught::catch(|| decode(bytes, limits));
    read.unwrap_or_else(|_| Err("its pixels do not match its header; save it again".to_owned()))
}

fn decode<P: Pixels>(bytes: &[u8], limits: &Limits) -> Result<P, String> {
    if let Some(rest) = RADIANCE.iter().find_map(|begin| bytes.strip_prefix(*begin)) {
        radiance(rest, limits)
    } else if bytes.starts_with(files::EXR.begins) {
        open_exr(bytes, limits)
    } else if bytes.is_empty() {
        Err(files::EMPTY.to_owned())
    } else {
        Err("it does not begin like a Radiance picture (#?RADIANCE) or an OpenEXR picture".to_owned())
    }
}

/// Reads a Radiance picture after its first word.
fn radiance<P: Pixels>(rest: &[u8], limits: &Limits) -> Result<P, String> {
    let head = &rest[..rest.len().min(limits.head)];
    let end = head.windows(2).position(|two| two == b"\n\n").map(|at| at + 2);
    let size = end.and_then(|end| head[end..].split_inclusive(|byte| *byte == b'\n').next());
    let Some(size) = size.filter(|size| size.ends_with(b"\n")) else {
        return Err(format!(
            "the header of a Radiance picture must end with an empty line and a line such as “-Y 512 +X \
             1024” within {} bytes",
            limits.head
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
    P::check(width, height)?;
    let decoder = HdrDecoder::new(RADIANCE[0].chain(rest)).map_err(|error| match error {
        ImageError::Unsupported(_) => "its FORMAT must be 32-bit_rle_rgbe".to_owned(),
        _ => bad_line(head),
    })?;
    let meta = decoder.metadata();
    for (_, numbers) in meta.custom_attributes.iter().filter(|(key, _)| key == PRIMARIES) {
        let numbers: Result<Vec<f32>, _> = numbers.split_whitespace().map(str::parse).collect();
        let found = numbers.ok().filter(|all| all.len() == 8).ok_or_else(|| bad_line(head))?;
        of_rec_709(found.as_chunks().0, PRIMARIES)?;
    }
    let exposure = meta.exposure.unwrap_or(1.0);
    let factors = meta.color_correction.map_or([exposure; 3], |(r, g, b)| [r, g, b].map(|c| c * exposure));
    if factors.iter().any(|factor| !factor.is_normal() || *factor < 0.0) {
        return Err("EXPOSURE and COLORCORR must be greater than 0".to_owned());
    }
    let mut pixels = vec![0; 12 * width * height];
    decoder.read_image(&mut pixels).map_err(|error| match error {
        ImageError::IoError(_) => "the file ends before its last pixel".to_owned(),
        _ => {
            let what = "its compressed rows of pixels do not have the width that its header gives";
            format!("the Radiance picture is damaged: {what}, {width}; copy it again from its source")
        }
    })?;
    // The values of the file were multiplied by these factors.
    let mut picture = P::new(width, height, DVec3::from_array(factors.map(f64::from)).recip());
    for (i, pixel) in pixels.chunks_exact(12).enumerate() {
        let value = |at: usize| f32::from_ne_bytes([pixel[at], pixel[at + 1], pixel[at + 2], pixel[at + 3]]);
        let [r, g, b] = [0, 4, 8].map(value);
        picture.add(i % width, i / width, [r, g, b, f32::NAN]);
    }
    Ok(picture)
}

/// Fails if the chromaticities of red, green, blue and white are not nearly those of Rec. 709.
fn of_rec_709(found: &[[f32; 2]], key: &str) -> Result<(), String> {
    let near = |a: &[f32; 2], b: &[f32; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 2e-3);
    let other = |known: &[[f32; 2]; 4]| found.iter().zip(known).position(|(a, b)| !near(a, b));
    let Some(i) = other(&REC_709).filter(|_| other(&RADIANCE_USUAL).is_some()) else { return Ok(()) };
    let ([x, y], [right_x, right_y], which) = (found[i], REC_709[i], ["red", "green", "blue", "white"][i]);
    let differ = format!("its {key} differ ({which} at {x}, {y}, not {right_x}, {right_y})");
    Err(format!("its colours must be linear Rec. 709, but {differ}"))
}

/// The first line of the header of a Radiance picture that has no numbers where it must.
fn bad_line(head: &[u8]) -> String {
    let count = |key: &str| match key {
        "EXPOSURE" | "PIXASPECT" => Some((1, "a number")),
        "COLORCORR" => Some((3, "three numbers")),
        PRIMARIES => Some((8, "eight numbers")),
        _ => None,
    };
    let head = String::from_utf8_lossy(head);
    let wrong = head.lines().enumerate().find_map(|(i, line)| {
        let (key, value) = line.split_once('=')?;
        let (most, what) = count(key.trim())?;
        let numbers: Result<Vec<f32>, _> = value.split_whitespace().map(str::parse).collect();
        let good = numbers.is_ok_and(|all| all.len() == most);
        let said =
            || format!("line {} of its header is “{}”, but {key} must be {what}", i + 1, shortened(line));
        (!good).then(said)
    });
    wrong.unwrap_or_else(|| "the header of the Radiance picture is damaged".to_owned())
}

fn open_exr<P: Pixels>(bytes: &[u8], limits: &Limits) -> Result<P, String> {
    let reader = exr::block::read(Cursor::new(bytes), false).map_err(|error| broken(&error))?;
    let ([width, height], scale) = within_limits(reader.headers(), limits)?;
    P::check(width, height)?;
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .specific_channels()
        .required("R")
        .required("G")
        .required("B")
        .optional("A", f32::NAN)
        .collect_pixels(
            |_, _| P::new(width, height, scale),
            |picture: &mut P, at: Vec2<usize>, (r, g, b, a): (f32, f32, f32, f32)| {
                picture.add(at.x(), at.y(), [r, g, b, a]);
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_chunks(reader)
        .map_err(|error| broken(&error))?;
    Ok(image.layer_data.channel_data.pixels)
}

/// An error in our own words: the decoder's are written for its authors.
fn broken(error: &exr::error::Error) -> String {
    /// Parts of the decoder's messages, which are all that identifies the kind of an error, and ours.
    const KINDS: &[(&str, &str)] = &[
        ("not enough data", "it ends too early"),
        ("reference to missing bytes", "it ends too early"),
        ("missing or invalid", "its header lacks what every picture has, or has it in another form"),
        ("window", "its header gives it no pixels, or too many"),
        ("attribute", "its header is wrong"),
        ("header", "its header is wrong"),
        ("feature flags", "its header is wrong"),
        ("chunk", "its list of blocks is wrong"),
        ("block", "its list of blocks is wrong"),
        ("tile", "its list of tiles is wrong"),
        ("offset table", "its list of blocks is wrong"),
        ("compress", "its compressed pixels cannot be read"),
        ("code", "its compressed pixels cannot be read"),
        ("table", "its compressed pixels cannot be read"),
        ("data", "its compressed pixels cannot be read"),
    ];
    const FORMS: &str =
        "it must have flat pixels, uncompressed or compressed with RLE, ZIP, PIZ, PXR24 or B44";
    let damage = match error {
        exr::error::Error::NotSupported(what) => {
            let kinds = [
                ("deep", "deep pixels"),
                ("compression", "another compression"),
                ("sampling", "channels of several sizes"),
            ];
            let known = kinds.into_iter().find(|(theirs, _)| what.contains(theirs));
            let kind = known.map_or("a newer form of the format", |(_, ours)| ours);
            return format!("OpenEXR pictures with {kind} are not supported; {FORMS}");
        }
        exr::error::Error::Io(_) => "it ends too early",
        error => {
            let said = error.to_string();
            let known = KINDS.iter().find(|(theirs, _)| said.contains(*theirs));
            known.map_or("one of its parts is not valid", |(_, ours)| *ours)
        }
    };
    format!("the OpenEXR picture is damaged: {damage}; copy it again from its source")
}

/// The size and the scale of the layer that is read, the first one with red, green and blue, if the file respects
/// the limits.
fn within_limits(layers: &[Header], limits: &Limits) -> Result<([usize; 2], DVec3), String> {
    if layers.len() > MAX_LAYERS {
        let count = plural(layers.len(), "layer");
        return Err(format!("the OpenEXR file has {count}; at most {MAX_LAYERS} are read"));
    }
    for layer in layers {
        let channels = layer.channels.list.len();
        if channels > limits.channels {
            let most = limits.channels;
            return Err(format!("a layer has {channels} channels; at most {most} are read"));
        }
        let [width, height] = [layer.layer_size.x(), layer.layer_size.y()];
        let [columns, rows] = limits.size;
        if width > columns || height > rows {
            return Err(format!(
                "a layer has {width} × {height} pixels; at most {columns} × {rows} are read"
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
    if limits.surroundings && own.environment_map == Some(EnvironmentMap::Cube) {
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
        of_rec_709(&found, "chromaticities")?;
    }
    let white = own.white_luminance.filter(|_| limits.surroundings).unwrap_or(1.0);
    if !white.is_normal() || white < 0.0 {
        return Err(format!("its whiteLuminance must be greater than 0, not {white}"));
    }
    Ok(([there.x(), there.y()], DVec3::splat(f64::from(white))))
}
