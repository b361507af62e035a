//! `pack < PROGRAM > PACKED` packs the program of a site.

use std::io::{self, BufWriter};

fn main() -> io::Result<()> {
    unpack::pack(io::stdin().lock(), BufWriter::new(io::stdout().lock()))
}
