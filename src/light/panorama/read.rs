//! Pictures of surroundings among the linear pictures: their limits, and their pixels as an average.

use glam::DVec3;

use super::average::{Average, MAX_FILE_COLUMNS};
use crate::{
    linear::{self, Limits, Pixels},
    parameter::FileProblem,
};

const LIMITS: Limits = Limits {
    head: 64 << 10,
    channels: 16,
    size: [MAX_FILE_COLUMNS, MAX_FILE_COLUMNS / 2],
    surroundings: true,
};

impl Pixels for Average {
    fn check(width: usize, height: usize) -> Result<(), String> {
        Self::check_size(width, height)
    }

    fn new(width: usize, height: usize, scale: DVec3) -> Self {
        Self::of_size(width, height).scaled(scale)
    }

    fn add(&mut self, column: usize, row: usize, [r, g, b, _]: [f32; 4]) {
        self.add(column, row, [r, g, b]);
    }
}

pub(super) fn read(bytes: &[u8]) -> Result<Vec<f32>, FileProblem> {
    let read = linear::read::<Average>(bytes, &LIMITS).and_then(Average::numbers);
    read.map_err(|message| FileProblem { line: None, message })
}
