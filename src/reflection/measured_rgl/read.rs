//! Reads files of the RGL material database.

use glam::{DMat3, DVec3, Vec3};

use super::{
    example,
    table::{Arrays, numbers},
};
use crate::{
    optics::temperature::colour_matching,
    parameter::{FileFormat, FileProblem, Shipped},
    text::shortened,
};

/// The largest absolute value of a number.
const LARGEST: f32 = 1e20;
/// The first bytes of a file.
const MAGIC: &[u8] = b"tensor_file\0";
/// Maximum number of fields.
const MAX_FIELDS: u32 = 64;
/// Maximum size of a grid along each side, and number of directions and wavelengths.
const MAX_SIDE: u64 = 4096;
/// Maximum number of values that the table of a file may have: 64 MiB.
pub const MAX_NUMBERS: usize = 16 << 20;

/// Measured materials of the RGL database (J. Dupuy, W. Jakob 2018): a tensor file of version 1.0, little-endian. Its fields phi_i
/// and theta_i are the directions in radians, ndf and sigma grids, vndf a grid for each direction, rgb one for each direction and
/// colour, or spectra one for each of the wavelengths in nanometres; jacobian is 1 if values are relative to the density of normals.
/// Of a file with both, rgb is read. Spectra become linear sRGB by the CIE 1931 matching functions with the trapezoidal rule,
/// and each channel is divided by that of a flat spectrum, so that one is white. Negative values are read as 0.
pub static FORMAT: FileFormat = FileFormat {
    name: "a file of the RGL material database (.bsdf)",
    extensions: &["bsdf"],
    max_bytes: 256 << 20,
    read,
    shipped: &[(example::NAME, Shipped::Numbers(example::numbers))],
};

fn read(bytes: &[u8]) -> Result<Vec<f32>, FileProblem> {
    arrays(bytes).map(|arrays| numbers(&arrays)).map_err(|message| FileProblem { line: None, message })
}

/// True if a file has spectra and no colours.
#[must_use]
pub fn is_spectral(bytes: &[u8]) -> bool {
    fields(bytes).is_ok_and(|fields| fields.iter().all(|field| field.name != b"rgb"))
}

/// A field of a file.
struct Field<'a> {
    name: &'a [u8],
    shape: Vec<u64>,
    kind: u8,
    data: &'a [u8],
}

/// Takes bytes from the front.
fn take<'a>(rest: &mut &'a [u8], count: usize) -> Result<&'a [u8], String> {
    let (taken, left) = rest.split_at_checked(count).ok_or("it ends within its list of fields")?;
    *rest = left;
    Ok(taken)
}

/// Takes a whole number of up to eight bytes.
fn whole(rest: &mut &[u8], count: usize) -> Result<u64, String> {
    Ok(take(rest, count)?.iter().rev().fold(0, |sum, byte| sum << 8 | u64::from(*byte)))
}

/// The fields of a file, each within it.
fn fields(bytes: &[u8]) -> Result<Vec<Field<'_>>, String> {
    let Some(mut rest) = bytes.strip_prefix(MAGIC) else {
        let start = String::from_utf8_lossy(&bytes[..bytes.len().min(32)]);
        let start = shortened(&start);
        return Err(format!(
            "it begins with \"{start}\"; a file of the RGL database begins with tensor_file"
        ));
    };
    let version = [whole(&mut rest, 1)?, whole(&mut rest, 1)?];
    if version != [1, 0] {
        let [major, minor] = version;
        return Err(format!("it has version {major}.{minor}, but must have 1.0"));
    }
    let count = whole(&mut rest, 4)?;
    if count > u64::from(MAX_FIELDS) {
        return Err(format!("it has {count} fields; at most {MAX_FIELDS} are read"));
    }
    let mut found = Vec::new();
    for _ in 0..count {
        let length = whole(&mut rest, 2)? as usize;
        let name = take(&mut rest, length)?;
        let dimensions = whole(&mut rest, 2)?;
        let kind = whole(&mut rest, 1)? as u8;
        let offset = whole(&mut rest, 8)?;
        let called = shortened(&String::from_utf8_lossy(name)).to_string();
        if dimensions > 8 {
            return Err(format!("the field {called} has {dimensions} dimensions; at most 8 are read"));
        }
        let shape = (0..dimensions).map(|_| whole(&mut rest, 8)).collect::<Result<Vec<_>, _>>()?;
        let size = match kind {
            1 | 2 => 1,
            3 | 4 | 9 => 2,
            5 | 6 | 10 => 4,
            7 | 8 | 11 => 8,
            _ => return Err(format!("the field {called} has numbers of an unknown type, {kind}")),
        };
        let length = shape.iter().try_fold(size, |all: u64, n| all.checked_mul(*n));
        let end = length.and_then(|length| length.checked_add(offset));
        let data = end.and_then(|end| bytes.get(usize::try_from(offset).ok()?..usize::try_from(end).ok()?));
        let Some(data) = data else {
            return Err(format!("the field {called} goes beyond the end of the file, {} bytes", bytes.len()));
        };
        found.push(Field { name, shape, kind, data });
    }
    Ok(found)
}

/// The fields of a file by name.
struct Fields<'a>(Vec<Field<'a>>);

impl Fields<'_> {
    fn find(&self, name: &str) -> Option<&Field<'_>> {
        self.0.iter().find(|field| field.name == name.as_bytes())
    }

    /// The shape of a field of 32-bit floats with a number of dimensions, and its numbers, each within [`LARGEST`].
    fn floats<const N: usize>(&self, name: &str) -> Result<([usize; N], Vec<f32>), String> {
        let field = self.find(name).ok_or_else(|| format!("it has no field {name}"))?;
        let Some(shape) = <[u64; N]>::try_from(field.shape.as_slice()).ok().filter(|_| field.kind == 10)
        else {
            return Err(format!("the field {name} must have 32-bit floats in {N} dimensions"));
        };
        if let Some(side) = shape.iter().find(|side| !(1..=MAX_SIDE).contains(side)) {
            return Err(format!("a side of the field {name} is {side}, but must be from 1 to {MAX_SIDE}"));
        }
        let chunks = field.data.as_chunks::<4>().0;
        if chunks.len() > 4 * MAX_NUMBERS {
            return Err(format!("the field {name} has {} numbers, too many", chunks.len()));
        }
        let numbers: Vec<f32> = chunks.iter().map(|all| f32::from_le_bytes(*all)).collect();
        if let Some(i) = numbers.iter().position(|x| x.is_nan() || x.abs() > LARGEST) {
            return Err(format!(
                "number {i} of the field {name} is {:?}, but must be from {:e} to {LARGEST:e}",
                numbers[i], -LARGEST
            ));
        }
        Ok((shape.map(|side| side as usize), numbers))
    }

    /// A field of ascending numbers.
    fn ascending(&self, name: &str) -> Result<Vec<f32>, String> {
        let (_, numbers) = self.floats::<1>(name)?;
        if numbers.windows(2).any(|pair| pair[0] >= pair[1]) {
            return Err(format!("the field {name} must ascend"));
        }
        Ok(numbers)
    }
}

/// The numbers from 0 on.
fn from_zero(numbers: Vec<f32>) -> Vec<f32> {
    numbers.into_iter().map(|x| x.max(0.0)).collect()
}

/// What each number stands for in linear sRGB: a flat spectrum is white.
fn weights(nm: &[f32]) -> Vec<DVec3> {
    // IEC 61966-2-1; rows as published.
    const TO_RGB: [f64; 9] = [3.2406, -1.5372, -0.4986, -0.9689, 1.8758, 0.0415, 0.0557, -0.2040, 1.0570];
    let to_rgb = DMat3::from_cols_array(&TO_RGB).transpose();
    let at = |i: usize| f64::from(nm[i.min(nm.len() - 1)]);
    let part = |i: usize| 0.5 * (at(i + 1) - at(i.saturating_sub(1)));
    let all: Vec<_> = (0..nm.len()).map(|i| part(i) * (to_rgb * colour_matching(at(i)))).collect();
    let white: DVec3 = all.iter().sum();
    all.into_iter().map(|weight| weight / white).collect()
}

/// Largest angle of a viewer in radians: 90°, and what rounding adds.
const STEEPEST: f32 = 1.571;

fn arrays(bytes: &[u8]) -> Result<Arrays, String> {
    let fields = Fields(fields(bytes)?);
    let (phi, theta) = (fields.ascending("phi_i")?, fields.ascending("theta_i")?);
    if let Some(angle) = theta.iter().find(|angle| !(0.0..=STEEPEST).contains(*angle)) {
        return Err(format!("theta_i has {angle}, but must be from 0 to π/2 in radians"));
    }
    let grid = |name: &str| {
        let ([rows, columns], all) = fields.floats::<2>(name)?;
        if all.iter().all(|number| *number <= 0.0) {
            return Err(format!("{name} is nowhere above 0"));
        }
        Ok::<_, String>(([columns, rows], from_zero(all)))
    };
    let ((ndf_size, ndf), (sigma_size, sigma)) = (grid("ndf")?, grid("sigma")?);
    let ([a, b, rows, columns], vndf) = fields.floats::<4>("vndf")?;
    let wavelengths =
        if fields.find("rgb").is_some() { None } else { Some(fields.ascending("wavelengths")?) };
    let name = if wavelengths.is_some() { "spectra" } else { "rgb" };
    let ([c, d, channels, high, wide], raw) = fields.floats::<5>(name)?;
    let counts = [phi.len(), theta.len()];
    let expected = wavelengths.as_ref().map_or(3, Vec::len);
    if [a, b] != counts || [c, d] != counts || channels != expected {
        return Err(format!(
            "vndf is for {a} × {b} directions and {name} for {c} × {d} with {channels} channels, but there are {} phi_i, {} theta_i and {expected} channels",
            counts[0], counts[1]
        ));
    }
    let sizes = [[columns, rows], [wide, high], ndf_size, sigma_size];
    if sizes.iter().flatten().any(|side| *side < 2) {
        return Err("its grids must have at least 2 × 2 numbers".to_owned());
    }
    let values = wide * high;
    let total = 3 * a * b * values + 2 * vndf.len() + a * b * rows + ndf.len() + sigma.len();
    if total > MAX_NUMBERS {
        return Err(format!("its table would have {total} numbers; at most {MAX_NUMBERS} are read"));
    }
    let weights = match &wavelengths {
        None => vec![DVec3::X, DVec3::Y, DVec3::Z],
        Some(nm) if nm.len() < 2 || nm[0] > 480.0 || nm[nm.len() - 1] < 600.0 => {
            return Err("its wavelengths must reach from 480 nm or less to 600 nm or more".to_owned());
        }
        Some(nm) => weights(nm),
    };
    let colour = |slice: &[f32], i: usize| {
        let sum: DVec3 =
            weights.iter().enumerate().map(|(k, weight)| f64::from(slice[k * values + i]) * *weight).sum();
        sum.as_vec3().max(Vec3::ZERO)
    };
    let values_of = |slice| (0..values).map(move |i| colour(slice, i));
    let colours = raw.chunks_exact(channels * values).flat_map(values_of).collect();
    let jacobian =
        fields.find("jacobian").and_then(|field| field.data.first()).is_some_and(|byte| *byte != 0);
    // Two azimuths may stand for one, at both ends of the turn.
    let reduction = if phi.len() <= 2 {
        0
    } else {
        let turns = std::f32::consts::TAU / (phi[phi.len() - 1] - phi[0]);
        match turns.round() {
            1.0 => 1,
            2.0 => 2,
            4.0 => 4,
            _ => return Err("its azimuths must cover a turn, half of one or a quarter".to_owned()),
        }
    };
    Ok(Arrays { phi, theta, sizes, reduction, jacobian, ndf, sigma, vndf: from_zero(vndf), values: colours })
}
