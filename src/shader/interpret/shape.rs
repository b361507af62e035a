//! The layout of values: the number of their words, and the position of each.

use naga::{ArraySize, Handle, Module, Scalar, ScalarKind, Type, TypeInner};

use super::{Result, Unsupported, unsupported};

/// The positions of the words of a composite value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layout {
    /// One after the other.
    Packed,
    /// As in a buffer, with padding.
    Buffer,
}

/// The most words of one value.
const LARGEST: usize = super::instruction::REGISTERS;

fn too_large() -> Unsupported {
    Unsupported { what: "it has a value that is too large".to_owned() }
}

/// Refuses numbers without 32 bits.
fn check(scalar: Scalar) -> Result<()> {
    match (scalar.kind, scalar.width) {
        (ScalarKind::Bool, _) | (ScalarKind::AbstractInt | ScalarKind::AbstractFloat, _) | (_, 4) => Ok(()),
        (_, width) => unsupported(format!("it uses numbers of {} bits", 8 * u32::from(width))),
    }
}

/// The number of elements of an array; 1 for runtime-sized arrays in buffers.
fn length(size: ArraySize) -> Result<usize> {
    match size {
        ArraySize::Constant(n) => Ok(n.get() as usize),
        ArraySize::Dynamic => Ok(1),
        ArraySize::Pending(_) => unsupported("it has an array of overridable length"),
    }
}

/// Elements of one type, accessed by an index.
#[derive(Clone, Copy, Debug)]
pub(super) struct Elements {
    pub(super) count: usize,
    /// Number of words in an element.
    pub(super) words: usize,
    /// Number of words from one element to the next.
    pub(super) stride: usize,
}

/// The elements of a vector, matrix or array.
pub(super) fn elements(module: &Module, inner: &TypeInner, layout: Layout) -> Result<Elements> {
    match *inner {
        TypeInner::Vector { size, scalar } | TypeInner::ValuePointer { size: Some(size), scalar, .. } => {
            check(scalar)?;
            Ok(Elements { count: size as usize, words: 1, stride: 1 })
        }
        TypeInner::Matrix { columns, rows, scalar } => {
            check(scalar)?;
            let words = rows as usize;
            let stride = if layout == Layout::Buffer && words == 3 { 4 } else { words };
            Ok(Elements { count: columns as usize, words, stride })
        }
        TypeInner::Array { base, size, stride } => {
            let words = words(module, &module.types[base].inner)?;
            let stride = if layout == Layout::Buffer { stride as usize / 4 } else { words };
            Ok(Elements { count: length(size)?, words, stride })
        }
        _ => unsupported("it indexes a value without elements"),
    }
}

/// The offset of a member of a struct.
pub(super) fn member(module: &Module, inner: &TypeInner, index: usize, layout: Layout) -> Result<usize> {
    let TypeInner::Struct { members, .. } = inner else {
        let elements = elements(module, inner, layout)?;
        return Ok(index.min(elements.count.saturating_sub(1)) * elements.stride);
    };
    if layout == Layout::Buffer {
        return Ok(members.get(index).map_or(0, |m| m.offset as usize / 4));
    }
    members.iter().take(index).map(|m| words(module, &module.types[m.ty].inner)).sum()
}

/// The number of words of a value.
pub(super) fn words(module: &Module, inner: &TypeInner) -> Result<usize> {
    // With padding, a value takes at most a few times its words.
    if inner.size(module.to_ctx()) as usize > 16 * LARGEST {
        return Err(too_large());
    }
    let of = |ty: Handle<Type>| words(module, &module.types[ty].inner);
    let count = match *inner {
        TypeInner::Scalar(scalar) | TypeInner::ValuePointer { size: None, scalar, .. } => {
            check(scalar)?;
            1
        }
        TypeInner::Vector { size, scalar } | TypeInner::ValuePointer { size: Some(size), scalar, .. } => {
            check(scalar)?;
            size as usize
        }
        TypeInner::Matrix { columns, rows, scalar } => {
            check(scalar)?;
            columns as usize * rows as usize
        }
        TypeInner::Array { base, size, .. } => of(base)?.checked_mul(length(size)?).ok_or_else(too_large)?,
        TypeInner::Struct { ref members, .. } => {
            let mut sum = 0usize;
            for m in members {
                sum += of(m.ty)?;
            }
            sum
        }
        TypeInner::Pointer { base, .. } => of(base)?,
        TypeInner::Atomic(_) => return unsupported("it uses atomics"),
        TypeInner::Image { .. } | TypeInner::Sampler { .. } | TypeInner::BindingArray { .. } => {
            return unsupported("it uses a texture or a sampler");
        }
        TypeInner::AccelerationStructure { .. } | TypeInner::RayQuery { .. } => {
            return unsupported("it traces rays");
        }
        TypeInner::CooperativeMatrix { .. } => return unsupported("it uses cooperative matrices"),
    };
    if count > LARGEST { Err(too_large()) } else { Ok(count) }
}

/// The offset of each word of a value.
pub(super) fn offsets(module: &Module, inner: &TypeInner, layout: Layout) -> Result<Vec<usize>> {
    let count = words(module, inner)?;
    if layout == Layout::Packed {
        return Ok((0..count).collect());
    }
    let mut offsets = Vec::with_capacity(count);
    place(module, inner, 0, &mut offsets)?;
    Ok(offsets)
}

fn place(module: &Module, inner: &TypeInner, base: usize, offsets: &mut Vec<usize>) -> Result<()> {
    match inner {
        TypeInner::Pointer { base: ty, .. } => place(module, &module.types[*ty].inner, base, offsets)?,
        TypeInner::Struct { members, .. } => {
            for m in members {
                place(module, &module.types[m.ty].inner, base + m.offset as usize / 4, offsets)?;
            }
        }
        TypeInner::Array { base: ty, .. } => {
            let elements = elements(module, inner, Layout::Buffer)?;
            for i in 0..elements.count {
                place(module, &module.types[*ty].inner, base + i * elements.stride, offsets)?;
            }
        }
        TypeInner::Matrix { .. } => {
            let elements = elements(module, inner, Layout::Buffer)?;
            for i in 0..elements.count {
                offsets.extend((0..elements.words).map(|k| base + i * elements.stride + k));
            }
        }
        scalars => offsets.extend((0..words(module, scalars)?).map(|k| base + k)),
    }
    Ok(())
}

/// The number of words of a value in a buffer, including padding.
pub(super) fn span(module: &Module, inner: &TypeInner) -> usize {
    match inner {
        TypeInner::Array { stride, size, .. } => length(*size).map_or(0, |n| n * *stride as usize / 4),
        other => other.size(module.to_ctx()) as usize / 4,
    }
}
