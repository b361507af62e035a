//! The program of a site, packed by LZMA (I. Pavlov 1998) in the format of `.lzma` files: two thirds of what gzip, which
//! browsers unpack themselves, makes of it.

use std::io::{self, Read, Write};

use lzma_rust2::{Action, LzmaOptions, LzmaStream, LzmaWriter, Status};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen::prelude::wasm_bindgen;

/// How far back repetitions are looked for, in bytes. The page needs as much memory for a moment.
const REACH: u32 = 1 << 25;

/// The largest program in bytes, several times that of the site. Tests have a smaller one, which takes no time.
const MOST: usize = if cfg!(test) { 1 << 20 } else { 256 << 20 };

fn too_large() -> String {
    format!("the program is larger than {} MiB", MOST >> 20)
}

/// Packs a program.
///
/// # Errors
/// Returns the errors of reading and writing, and one if the page would refuse the program as too large.
pub fn pack(from: impl Read, to: impl Write) -> io::Result<()> {
    let mut bytes = Vec::new();
    from.take(MOST as u64 + 1).read_to_end(&mut bytes)?;
    if bytes.len() > MOST {
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, too_large()));
    }
    // Instructions of WebAssembly have no alignment, and the longer context suits them.
    let options = LzmaOptions { dict_size: REACH, lc: 4, pb: 0, ..LzmaOptions::with_preset(9) };
    let mut packer = LzmaWriter::new_use_header(to, &options, Some(bytes.len() as u64))?;
    packer.write_all(&bytes)?;
    packer.finish()?.flush()
}

/// Unpacks a program piece by piece.
#[cfg_attr(target_arch = "wasm32", wasm_bindgen)]
pub struct Unpacker {
    stream: LzmaStream,
    /// The number of bytes that may still come out.
    left: usize,
    ended: bool,
}

#[cfg_attr(target_arch = "wasm32", wasm_bindgen)]
impl Unpacker {
    /// Before the first piece.
    #[must_use]
    pub fn new() -> Self {
        // In KiB. What asks for more is not packed by this.
        Self { stream: LzmaStream::new_mem_limit(2 * (REACH >> 10), None), left: MOST, ended: false }
    }

    /// What the next bytes of the packed program become.
    ///
    /// # Errors
    /// Returns an error if the bytes are not those of a packed program, or if it is too large: a few bytes may stand for
    /// thousands of times as many.
    pub fn more(&mut self, mut packed: &[u8]) -> Result<Vec<u8>, String> {
        let (mut out, mut room) = (Vec::new(), vec![0; 1 << 16]);
        while !self.ended {
            let done = self.stream.process(packed, &mut room, Action::Run);
            let done = done.map_err(|why| format!("the program arrived damaged: {why}"))?;
            self.left = self.left.checked_sub(done.bytes_produced).ok_or_else(too_large)?;
            packed = packed.get(done.bytes_consumed..).unwrap_or_default();
            out.extend_from_slice(&room[..done.bytes_produced]);
            self.ended = done.status == Status::StreamEnd;
            if done.bytes_produced == 0 && packed.is_empty() {
                break;
            }
        }
        Ok(out)
    }

    /// True after the last byte.
    #[must_use]
    pub fn ended(&self) -> bool {
        self.ended
    }
}

impl Default for Unpacker {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Something that repeats itself, and something that does not.
    fn program() -> Vec<u8> {
        let mut x = 1u32;
        let mut any = || {
            x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (x >> 24) as u8
        };
        let part: Vec<u8> = (0..1000).map(|_| any()).collect();
        (0..200).flat_map(|_| part.clone()).chain((0..70_000).map(|_| any())).collect()
    }

    fn packed() -> Vec<u8> {
        let mut packed = Vec::new();
        pack(&*program(), &mut packed).expect("packed");
        packed
    }

    #[test]
    fn pieces_of_any_size_give_the_program_again() {
        let packed = packed();
        assert!(packed.len() < 80_000, "{}", packed.len());
        for size in [1, 7, 1000, packed.len()] {
            let mut unpacker = Unpacker::new();
            let pieces = packed.chunks(size).map(|piece| unpacker.more(piece).expect("whole"));
            assert!(pieces.collect::<Vec<_>>().concat() == program(), "{size}");
            assert!(unpacker.ended(), "{size}");
        }
    }

    #[test]
    fn the_largest_program_is_unpacked_and_a_larger_one_refused() {
        let mut largest = Vec::new();
        pack(&*vec![0_u8; MOST], &mut largest).expect("packed");
        let mut unpacker = Unpacker::new();
        assert_eq!(unpacker.more(&largest).map(|out| out.len()), Ok(MOST));
        assert!(unpacker.ended());
        let error = pack(&*vec![0_u8; MOST + 1], io::sink()).expect_err("refused");
        assert_eq!(error.to_string(), "the program is larger than 1 MiB");
        // From elsewhere, and without its length at the beginning.
        let mut packer =
            LzmaWriter::new_use_header(Vec::new(), &LzmaOptions::with_preset(1), None).expect("begun");
        packer.write_all(&vec![0; MOST + 1]).expect("packed");
        let larger = packer.finish().expect("packed");
        assert!(larger.len() < 1000, "{}", larger.len());
        assert_eq!(Unpacker::new().more(&larger), Err("the program is larger than 1 MiB".to_owned()));
    }

    #[test]
    fn what_is_cut_off_is_not_at_its_end() {
        let packed = packed();
        let mut unpacker = Unpacker::new();
        unpacker.more(&packed[..packed.len() / 2]).expect("the beginning is right");
        assert!(!unpacker.ended());
    }

    #[test]
    fn what_is_not_packed_is_refused_and_asks_for_no_memory() {
        // As large a dictionary as the format knows.
        let greedy = [&[93, 255, 255, 255, 255][..], &[255; 8], &[0; 100]].concat();
        for wrong in [&b"<!doctype html><html><body>not found</body></html>"[..], &greedy] {
            let mut unpacker = Unpacker::new();
            let error = unpacker.more(wrong).expect_err("refused");
            assert!(error.starts_with("the program arrived damaged"), "{error}");
        }
    }
}
