//! Films of several pictures, as animated GIF. (Animated PNG is written like [any other PNG file](crate::picture::png).)

use std::io;

use gif::{Encoder, EncodingError, Frame, Repeat};
use rayon::prelude::*;

use crate::files::Signature;

/// GIF pictures.
pub const GIF: Signature = Signature { what: "a GIF file", begins: b"GIF89a" };
/// Maximum number of pictures per second: the delay between them is at least two hundredths of a second, below which
/// browsers slow a film down.
pub const MAX_RATE: u32 = 50;
/// One pixel of so many is looked at for choosing the 256 colours of a picture, if it has more.
const SPEED: i32 = 4;

/// A film that goes on for ever, with `rate` pictures per second, as the bytes of a GIF file. Each picture has the 256
/// colours that suit it best, after A. Dekker (1994), *Kohonen Neural Networks for Optimal Colour Quantization*.
///
/// # Errors
/// Returns an error if a side is longer than 65535 pixels, or a picture has another size.
pub fn gif(pictures: &[Vec<u8>], [width, height]: [u32; 2], rate: u32) -> io::Result<Vec<u8>> {
    let wrong = |what: &str| io::Error::new(io::ErrorKind::InvalidInput, what.to_owned());
    let side = |side: u32| u16::try_from(side).map_err(|_| wrong("a GIF has at most 65535 pixels on a side"));
    let (w, h) = (side(width)?, side(height)?);
    if pictures.iter().any(|rgb8| rgb8.len() != 3 * width as usize * height as usize) {
        return Err(wrong("a picture has another size than the film"));
    }
    // In hundredths of a second.
    let delay = (100.0 / f64::from(rate.clamp(1, MAX_RATE))).round() as u16;
    let frames: Vec<Frame> = pictures
        .par_iter()
        .map(|rgb8| {
            let mut frame = Frame::from_rgb_speed(w, h, rgb8, SPEED);
            frame.delay = delay;
            frame.make_lzw_pre_encoded();
            frame
        })
        .collect();
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, w, h, &[]).map_err(plain)?;
    encoder.set_repeat(Repeat::Infinite).map_err(plain)?;
    for frame in &frames {
        encoder.write_lzw_pre_encoded_frame(frame).map_err(plain)?;
    }
    drop(encoder);
    Ok(bytes)
}

fn plain(error: EncodingError) -> io::Error {
    match error {
        EncodingError::Io(error) => error,
        error => io::Error::other(error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_film_has_its_pictures_in_order_at_its_rate() {
        let size = [16, 8];
        let pictures: Vec<Vec<u8>> =
            [[200, 0, 0], [0, 200, 0], [0, 0, 200]].map(|c: [u8; 3]| c.repeat(128)).into();
        let bytes = gif(&pictures, size, 25).expect("encoded");
        assert!(bytes.starts_with(GIF.begins) && bytes == gif(&pictures, size, 25).expect("encoded"));
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(bytes.as_slice()).expect("a GIF");
        for picture in &pictures {
            let frame = decoder.read_next_frame().expect("whole").expect("three pictures");
            assert_eq!((frame.delay, frame.width, frame.height), (4, 16, 8));
            assert_eq!(frame.buffer[..3], picture[..3]);
        }
        assert!(decoder.read_next_frame().expect("whole").is_none());
        assert!(gif(&[vec![0; 5]], size, 25).is_err() && gif(&[], [70_000, 1], 25).is_err());
    }

    #[test]
    fn many_colours_become_the_nearest() {
        let picture: Vec<u8> =
            (0..64 * 64).flat_map(|i| [(i % 64 * 4) as u8, (i / 64 * 4) as u8, 90]).collect();
        let bytes = gif(std::slice::from_ref(&picture), [64, 64], 10).expect("encoded");
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(bytes.as_slice()).expect("a GIF");
        let frame = decoder.read_next_frame().expect("whole").expect("a picture");
        let far = |(a, b): (&[u8; 4], &[u8; 3])| (0..3).map(|c| a[c].abs_diff(b[c])).max().unwrap_or(0);
        let all = frame.buffer.as_chunks::<4>().0.iter().zip(picture.as_chunks::<3>().0).map(far);
        let mean = all.map(f64::from).sum::<f64>() / 4096.0;
        assert!(mean < 12.0, "{mean}");
    }
}
