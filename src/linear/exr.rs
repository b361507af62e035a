//! Writes OpenEXR pictures with the crate `exr`: a single part of scan lines, whose layers are prefixes of the names
//! of channels, as every program reads them.
//!
//! Lines are compressed by run lengths, on all threads: deflating takes about ten times as long, and saves little of
//! 32-bit floats, half of whose bits are noise. The result does not depend on the number of threads.

use std::io::{self, Cursor};

use exr::{
    block::{self, BlockIndex, UncompressedBlock, writer::ChunksWriter as _},
    meta::{BlockDescription, attribute::Chromaticities, header::Header},
    prelude::{AttributeValue, ChannelDescription, Compression, LineOrder, SampleType, Text, Vec2},
};
use rayon::prelude::*;

use super::{Channels, Notes, REC_709};

/// Number of lines that are compressed before they are written.
const AT_ONCE: usize = 64;

pub(super) fn encode(channels: &Channels, notes: &Notes) -> io::Result<Vec<u8>> {
    let [width, height] = [channels.width, channels.height].map(|side| side as usize);
    // Files have their channels in alphabetical order.
    let mut list: Vec<_> = channels.list.iter().collect();
    list.sort_unstable_by(|(a, _), (b, _)| a.as_bytes().cmp(b.as_bytes()));
    let line = |y: usize| {
        let mut data = vec![0; 4 * width * list.len()];
        for ((_, numbers), bytes) in list.iter().zip(data.chunks_exact_mut(4 * width)) {
            let numbers = &numbers[y * width..][..width];
            bytes.as_chunks_mut().0.iter_mut().zip(numbers).for_each(|(to, n)| *to = n.to_ne_bytes());
        }
        let index = BlockIndex {
            layer: 0,
            pixel_position: Vec2(0, y),
            pixel_size: Vec2(width, 1),
            level: Vec2(0, 0),
        };
        UncompressedBlock { index, data }
    };
    let names = list.iter().map(|(name, _)| name.as_str());
    let headers = std::iter::once(header([width, height], names, notes)).collect();
    let mut bytes = Cursor::new(Vec::new());
    let written = block::write(&mut bytes, headers, true, |meta, writer| {
        for first in (0..height).step_by(AT_ONCE) {
            let lines = (first..height.min(first + AT_ONCE)).into_par_iter();
            let chunks: Vec<_> = lines.map(|y| line(y).compress_to_chunk(&meta.headers)).collect();
            for (y, chunk) in (first..).zip(chunks) {
                writer.write_chunk(y, chunk?)?;
            }
        }
        Ok(())
    });
    written.map_err(|error| match error {
        exr::error::Error::Io(error) => error,
        error => io::Error::new(io::ErrorKind::InvalidInput, error.to_string()),
    })?;
    Ok(bytes.into_inner())
}

fn header<'a>(size: [usize; 2], names: impl Iterator<Item = &'a str>, notes: &Notes) -> Header {
    // Texts of any language are UTF-8.
    let text = |text: &str| Text::from_slice_unchecked(text.as_bytes());
    let channel = |name: &str| ChannelDescription::new(text(name), SampleType::F32, false);
    let mut header = Header::new(Text::default(), Vec2(size[0], size[1]), names.map(channel).collect())
        .with_encoding(Compression::RLE, BlockDescription::ScanLines, LineOrder::Increasing);
    let [red, green, blue, white] = REC_709.map(|[x, y]| Vec2(x, y));
    header.shared_attributes.chromaticities = Some(Chromaticities { red, green, blue, white });
    let own = &mut header.own_attributes;
    own.layer_name = None;
    own.software_name = Some(text(&notes.software)).filter(|_| !notes.software.is_empty());
    own.comments = Some(text(&notes.comments)).filter(|_| !notes.comments.is_empty());
    // The only one: several would be written in an order that changes from run to run.
    own.other.extend(notes.scene.map(|(name, scene)| (text(name), AttributeValue::Text(text(scene)))));
    header
}

#[cfg(test)]
mod tests {
    use exr::prelude::{ReadChannels as _, ReadLayers as _};
    use glam::Vec4;

    use super::{super::Format, *};

    /// A number that differs from pixel to pixel and from channel to channel.
    fn number(i: usize, channel: usize) -> f32 {
        (0.37 * i as f32 + channel as f32).sin() * 10.0f32.powi((i % 80) as i32 - 40)
    }

    fn picture(width: u32, height: u32) -> Channels {
        let pixels: Vec<_> = (0..(width * height) as usize)
            .map(|i| Vec4::from_array(std::array::from_fn(|channel| number(i, channel))))
            .collect();
        let mut channels = Channels::new(width, height);
        channels.add("", &["R", "G", "B", "A"], &pixels);
        channels.add("depth", &["Z"], &pixels);
        channels.add("a_light", &["R", "G", "B"], &pixels);
        channels
    }

    #[test]
    fn every_bit_of_every_channel_is_read_back_and_the_metadata_too() {
        let notes = Notes {
            software: "lab 1".into(),
            comments: "Title: größe\nb".into(),
            scene: Some(("the scene", "{\"name\": \"größe\"}")),
        };
        for [width, height] in [[1, 1], [3, 200], [257, 5]] {
            let picture = picture(width, height);
            let bytes = picture.encode(Format::Exr, &notes).expect("written");
            assert!(bytes.starts_with(Format::Exr.signature().begins));
            let read = exr::prelude::read()
                .no_deep_data()
                .largest_resolution_level()
                .all_channels()
                .all_layers()
                .all_attributes()
                .from_buffered(Cursor::new(&bytes))
                .expect("an OpenEXR file");
            let [layer] = &read.layer_data[..] else { panic!("one part") };
            let names: Vec<_> = layer.channel_data.list.iter().map(|c| c.name.to_string()).collect();
            assert_eq!(names, ["A", "B", "G", "R", "a_light.B", "a_light.G", "a_light.R", "depth.Z"]);
            for channel in &layer.channel_data.list {
                let numbers: Vec<_> = channel.sample_data.values_as_f32().collect();
                let right = picture.get(&channel.name.to_string()).expect("it was written");
                assert!(
                    numbers.iter().zip(right).all(|(a, b)| a.to_bits() == b.to_bits()),
                    "{}",
                    channel.name
                );
                assert_eq!(numbers.len(), right.len());
            }
            let own = &layer.attributes;
            let text = |text: &Text| String::from_utf8(text.as_slice().to_vec()).expect("UTF-8");
            assert_eq!(own.software_name.as_ref().map(text).as_deref(), Some("lab 1"));
            assert_eq!(own.comments.as_ref().map(text).as_deref(), Some("Title: größe\nb"));
            let scene = &own.other[&Text::from("the scene")];
            assert_eq!(text(scene.to_text().expect("a text")), "{\"name\": \"größe\"}");
            assert!(read.attributes.chromaticities.is_some() && own.layer_name.is_none());
            assert_eq!(picture.encode(Format::Exr, &notes).expect("written"), bytes, "the same bytes again");
        }
    }

    #[test]
    fn wrong_pictures_are_errors() {
        let said = |channels: &Channels| {
            channels.encode(Format::Exr, &Notes::default()).expect_err("it is wrong").to_string()
        };
        assert_eq!(said(&Channels::new(0, 5)), "it has 0 pixels, but must have 1 to 67108864");
        assert!(said(&Channels::new(1 << 14, 1 << 14)).starts_with("it has 268435456 pixels"));
        let mut twice = picture(2, 1);
        twice.add("", &["R"], &[Vec4::ONE; 2]);
        assert_eq!(said(&twice), "two channels are called R");
        let mut short = picture(2, 1);
        short.add("x", &["R"], &[Vec4::ONE]);
        assert_eq!(said(&short), "x.R has 1 numbers for 2 pixels");
        let mut depth = Channels::new(1, 1);
        depth.add("depth", &["Z"], &[Vec4::ONE]);
        let said = depth.encode(Format::Hdr, &Notes::default()).expect_err("no colours").to_string();
        assert_eq!(said, "a Radiance picture needs the channels R, G and B");
    }

    #[test]
    fn runs_are_compressed_and_the_bytes_are_those_of_any_number_of_threads() {
        // More lines than are compressed at once, and a last part with fewer.
        let (width, height) = (64, 2 * AT_ONCE as u32 + 3);
        let size = |pixel: fn(usize) -> Vec4| {
            let pixels: Vec<_> = (0..(width * height) as usize).map(pixel).collect();
            let mut channels = Channels::new(width, height);
            for i in 0..10 {
                channels.add(&format!("light_{i}"), &["R", "G", "B"], &pixels);
            }
            let on = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
                pool.install(|| channels.encode(Format::Exr, &Notes::default()).expect("written"))
            };
            let bytes = on(1);
            assert!(bytes == on(3));
            bytes.len()
        };
        let raw = (4 * 3 * 10 * width * height) as usize;
        let (dark, noisy) = (size(|_| Vec4::ZERO), size(|i| Vec4::splat(number(i, 0))));
        assert!(dark < raw / 10 && noisy > raw / 2, "{dark} and {noisy} of {raw}");
    }
}
