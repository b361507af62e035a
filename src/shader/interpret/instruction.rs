//! The instructions of a program, on words of 32 bits.

use std::f32::consts::PI;

use super::{STEPS, StepLimit};

/// The number of registers, for variables, intermediate values and constants.
pub(super) const REGISTERS: usize = 1 << 16;

/// The registers of a running program. They are floats since most instructions calculate with floats: moving
/// values between the processor's integer and float registers would take longer than the calculation. Other
/// words are stored as bits.
pub(super) type Registers = [f32; REGISTERS];

/// A type of 32 bits.
trait Bits: Copy {
    fn read(word: f32) -> Self;
    fn write(self) -> f32;
}

macro_rules! bits {
    ($($Type:ident: |$word:ident| $read:expr, |$value:ident| $write:expr;)*) => {
        $(impl Bits for $Type {
            #[inline(always)]
            fn read($word: f32) -> Self {
                $read
            }
            #[inline(always)]
            fn write(self) -> f32 {
                let $value = self;
                $write
            }
        })*
    };
}

bits! {
    u32: |word| word.to_bits(), |bits| f32::from_bits(bits);
    i32: |word| word.to_bits().cast_signed(), |number| f32::from_bits(number.cast_unsigned());
    f32: |word| word, |number| number;
    bool: |word| word.to_bits() != 0, |flag| f32::from_bits(u32::from(flag));
}

/// A function of one to three words without side effects.
trait Pure<Types> {
    const ARITY: usize;
    /// The value, from words fetched by index.
    fn apply(self, word: impl Fn(usize) -> f32) -> f32;
}

macro_rules! pure {
    ($($arity:literal: $($Argument:ident $index:literal)*;)*) => {
        $(impl<$($Argument: Bits,)* R: Bits, F: Fn($($Argument),*) -> R> Pure<($($Argument,)* R)> for F {
            const ARITY: usize = $arity;
            #[inline(always)]
            fn apply(self, word: impl Fn(usize) -> f32) -> f32 {
                self($($Argument::read(word($index))),*).write()
            }
        })*
    };
}

pure! {
    1: A 0;
    2: A 0 B 1;
    3: A 0 B 1 C 2;
}

fn arity<Types, F: Pure<Types>>(_: F) -> usize {
    F::ARITY
}

macro_rules! operations {
    // In a pair, the second applies the first to three words.
    ($($name:ident $($triple:ident)? = $function:expr;)*) => {
        /// The operation of an instruction. Pure ones write a function of registers `a`, `b`, `c` to `d`.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(u8)]
        pub(super) enum Operation {
            $($name,)*
            $($($triple,)?)*
            /// Multiplies three words from `a` on by three from `b` on, and writes the sum to `d`.
            Dot,
            /// Jumps to the target.
            Jump,
            /// Jumps to the target unless `a` is true.
            JumpUnless,
            /// Jumps to the target if `a` and `d` are the same word.
            JumpIfEqual,
            /// Jumps back to the target, and counts.
            Repeat,
            /// Jumps back to the target unless `a` is true, and counts.
            RepeatUnless,
            /// Copies register number `b` + content of `a` to `d`.
            LoadAt,
            /// Copies `a` to register number `d` + content of `b`.
            StoreAt,
        }

        impl Operation {
            /// The number of registers read by a pure operation; 0 for others.
            pub(super) fn arity(self) -> usize {
                match self {
                    $(Self::$name => arity($function),)*
                    _ => 0,
                }
            }

            /// The operation that applies this one to three words.
            pub(super) fn triple(self) -> Option<Self> {
                match self {
                    $($(Self::$name => Some(Self::$triple),)?)*
                    _ => None,
                }
            }

            /// The value of a pure operation; 0 for others.
            pub(super) fn evaluate(self, words: [u32; 3]) -> u32 {
                let word = |i: usize| f32::from_bits(words[i]);
                let value = match self {
                    $(Self::$name => Pure::apply($function, word),)*
                    _ => 0.0,
                };
                value.to_bits()
            }
        }

        /// Runs instructions until they end. There are as many registers as 16-bit numbers, so register
        /// numbers need no check.
        pub(super) fn execute(code: &[Instruction], registers: &mut Registers) -> Result<(), StepLimit> {
            let mut at = 0;
            let mut steps = 0;
            while let Some(i) = code.get(at) {
                at += 1;
                let (a, d) = (usize::from(i.a), usize::from(i.d));
                match i.operation {
                    $(Operation::$name => {
                        let value = Pure::apply($function, |k| registers[usize::from([i.a, i.b, i.c][k])]);
                        registers[d] = value;
                    })*
                    $($(Operation::$triple => for k in 0..3 {
                        let value = Pure::apply($function, |n| registers[usize::from(i.word(n, k))]);
                        registers[usize::from(i.d.wrapping_add(k))] = value;
                    })?)*
                    Operation::Dot => {
                        let product = |k: u16| {
                            registers[usize::from(i.a.wrapping_add(k))] * registers[usize::from(i.b.wrapping_add(k))]
                        };
                        registers[d] = product(0) + product(1) + product(2);
                    }
                    Operation::Jump => at = i.target(),
                    Operation::JumpUnless => {
                        if !bool::read(registers[a]) {
                            at = i.target();
                        }
                    }
                    Operation::JumpIfEqual => {
                        if registers[a].to_bits() == registers[d].to_bits() {
                            at = i.target();
                        }
                    }
                    Operation::Repeat | Operation::RepeatUnless => {
                        if i.operation == Operation::RepeatUnless && bool::read(registers[a]) {
                            continue;
                        }
                        steps += at - i.target();
                        if steps > STEPS {
                            return Err(StepLimit);
                        }
                        at = i.target();
                    }
                    Operation::LoadAt => {
                        let place = i.b.wrapping_add(registers[a].to_bits() as u16);
                        registers[d] = registers[usize::from(place)];
                    }
                    Operation::StoreAt => {
                        let place = i.d.wrapping_add(registers[usize::from(i.b)].to_bits() as u16);
                        registers[usize::from(place)] = registers[a];
                    }
                }
            }
            Ok(())
        }
    };
}

operations! {
    Copy Copy3 = |a: u32| a;
    // The offset of an element: indices beyond the end refer to the last element, as on the GPU.
    Index = |i: u32, last: u32, stride: u32| i.min(last).wrapping_mul(stride);
    Select Select3 = |condition: bool, a: u32, b: u32| if condition { a } else { b };

    AddF AddF3 = |a: f32, b: f32| a + b;
    SubF SubF3 = |a: f32, b: f32| a - b;
    MulF MulF3 = |a: f32, b: f32| a * b;
    DivF DivF3 = |a: f32, b: f32| a / b;
    RemF = |a: f32, b: f32| a % b;
    NegF = |a: f32| -a;
    // Rounded twice, as by separate instructions.
    MulAddF MulAddF3 = |a: f32, b: f32, c: f32| a * b + c;
    EqualF = |a: f32, b: f32| a == b;
    NotEqualF = |a: f32, b: f32| a != b;
    LessF = |a: f32, b: f32| a < b;
    LessEqualF = |a: f32, b: f32| a <= b;

    AddI = u32::wrapping_add;
    SubI = u32::wrapping_sub;
    MulI = u32::wrapping_mul;
    NegI = u32::wrapping_neg;
    // Division by zero returns the dividend, and the remainder 0.
    DivS = |a: i32, b: i32| if b == 0 { a } else { a.wrapping_div(b) };
    DivU = |a: u32, b: u32| a.checked_div(b).unwrap_or(a);
    RemS = |a: i32, b: i32| if b == 0 { 0 } else { a.wrapping_rem(b) };
    RemU = |a: u32, b: u32| a.checked_rem(b).unwrap_or(0);
    And = |a: u32, b: u32| a & b;
    Or = |a: u32, b: u32| a | b;
    Xor = |a: u32, b: u32| a ^ b;
    Complement = |a: u32| !a;
    Not = |a: bool| !a;
    ShiftLeft = u32::wrapping_shl;
    ShiftRightS = i32::wrapping_shr;
    ShiftRightU = u32::wrapping_shr;
    EqualI = |a: u32, b: u32| a == b;
    NotEqualI = |a: u32, b: u32| a != b;
    LessS = |a: i32, b: i32| a < b;
    LessEqualS = |a: i32, b: i32| a <= b;
    LessU = |a: u32, b: u32| a < b;
    LessEqualU = |a: u32, b: u32| a <= b;

    FloatToS = |a: f32| a as i32;
    FloatToU = |a: f32| a as u32;
    SToFloat = |a: i32| a as f32;
    UToFloat = |a: u32| a as f32;
    BoolToFloat = |a: bool| if a { 1.0f32 } else { 0.0 };
    FloatToBool = |a: f32| a != 0.0;
    IntToBool = |a: u32| a != 0;

    AbsF = f32::abs;
    SignF = |a: f32| if a > 0.0 { 1.0f32 } else if a < 0.0 { -1.0 } else { 0.0 };
    MinF = f32::min;
    MaxF MaxF3 = f32::max;
    ClampF ClampF3 = clamp;
    Ceil = f32::ceil;
    Floor = f32::floor;
    Round = f32::round_ties_even;
    Fract = |a: f32| a - a.floor();
    Trunc = f32::trunc;
    Sqrt = f32::sqrt;
    InverseSqrt = |a: f32| 1.0 / a.sqrt();
    Exp = f32::exp;
    Exp2 = f32::exp2;
    Log = f32::ln;
    Log2 = f32::log2;
    Pow = f32::powf;
    Sin = f32::sin;
    Cos = f32::cos;
    Tan = f32::tan;
    Asin = f32::asin;
    Acos = f32::acos;
    Atan = f32::atan;
    Atan2 = f32::atan2;
    Sinh = f32::sinh;
    Cosh = f32::cosh;
    Tanh = f32::tanh;
    Asinh = f32::asinh;
    Acosh = f32::acosh;
    Atanh = f32::atanh;
    Radians = |a: f32| a * (PI / 180.0);
    Degrees = |a: f32| a * (180.0 / PI);
    Step = |edge: f32, x: f32| if edge <= x { 1.0f32 } else { 0.0 };
    Mix Mix3 = |a: f32, b: f32, t: f32| a * (1.0 - t) + b * t;
    SmoothStep = smooth_step;
    Ldexp = |a: f32, e: i32| (f64::from(a) * f64::from(e.clamp(-300, 300)).exp2()) as f32;
    FrexpFraction = |a: f32| frexp(a).0;
    FrexpExponent = |a: f32| frexp(a).1;

    AbsS = i32::wrapping_abs;
    SignS = i32::signum;
    MinS = |a: i32, b: i32| a.min(b);
    MaxS = |a: i32, b: i32| a.max(b);
    MinU = |a: u32, b: u32| a.min(b);
    MaxU = |a: u32, b: u32| a.max(b);
    CountOnes = u32::count_ones;
    TrailingZeros = u32::trailing_zeros;
    LeadingZeros = u32::leading_zeros;
    ReverseBits = u32::reverse_bits;
    // The position of a bit; −1 if it does not exist.
    FirstTrailing = |a: u32| if a == 0 { u32::MAX } else { a.trailing_zeros() };
    FirstLeadingU = first_leading;
    FirstLeadingS = |a: i32| first_leading((if a < 0 { !a } else { a }).cast_unsigned());
    ExtractU = |a: u32, offset: u32, count: u32| match field(offset, count) {
        (_, 0) => 0,
        (offset, count) => a << (32 - count - offset) >> (32 - count),
    };
    ExtractS = |a: i32, offset: u32, count: u32| match field(offset, count) {
        (_, 0) => 0,
        (offset, count) => a << (32 - count - offset) >> (32 - count),
    };
    FieldMask = |offset: u32, count: u32| match field(offset, count) {
        (_, 0) => 0,
        (offset, count) => u32::MAX >> (32 - count) << offset,
    };
}

/// A number within bounds; the upper bound if they are swapped; the lower bound for NaN.
fn clamp(a: f32, low: f32, high: f32) -> f32 {
    a.max(low).min(high)
}

/// Hermite's cubic between two edges.
fn smooth_step(low: f32, high: f32, x: f32) -> f32 {
    let t = clamp((x - low) / (high - low), 0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Fraction in [0.5, 1) and exponent of a number; zero, infinities and NaN have the exponent 0.
fn frexp(a: f32) -> (f32, i32) {
    if a == 0.0 || !a.is_finite() {
        return (a, 0);
    }
    // Every 32-bit number is a normal 64-bit one.
    let bits = f64::from(a).to_bits();
    let exponent = (bits >> 52 & 0x7ff) as i32 - 1022;
    (f64::from_bits(bits & !(0x7ff << 52) | 1022 << 52) as f32, exponent)
}

fn first_leading(a: u32) -> u32 {
    if a == 0 { u32::MAX } else { 31 - a.leading_zeros() }
}

/// Offset and count of bits that lie within a word.
fn field(offset: u32, count: u32) -> (u32, u32) {
    let offset = offset.min(32);
    (offset, count.min(32 - offset))
}

/// An instruction: an operation, the register that it writes, and those that it reads. Jumps store their
/// target in `b` and `c`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Instruction {
    pub(super) operation: Operation,
    /// For operations on three words: bits 0 to 2 are set if `a`, `b`, `c` advance from word to word.
    pub(super) strides: u8,
    pub(super) d: u16,
    pub(super) a: u16,
    pub(super) b: u16,
    pub(super) c: u16,
}

impl Instruction {
    pub(super) fn new(operation: Operation, d: u16, [a, b, c]: [u16; 3]) -> Self {
        Self { operation, strides: 0, d, a, b, c }
    }

    /// Operand n of word k of an operation on three words.
    #[inline(always)]
    pub(super) fn word(&self, n: usize, k: u16) -> u16 {
        [self.a, self.b, self.c][n].wrapping_add(k * u16::from(self.strides >> n & 1))
    }

    /// The target of a jump.
    #[inline(always)]
    pub(super) fn target(self) -> usize {
        usize::from(self.b) << 16 | usize::from(self.c)
    }

    /// Sets the target of a jump.
    pub(super) fn aim(&mut self, target: usize) {
        self.b = (target >> 16) as u16;
        self.c = target as u16;
    }

    /// True for a jump.
    pub(super) fn jumps(self) -> bool {
        use Operation::{Jump, JumpIfEqual, JumpUnless, Repeat, RepeatUnless};
        matches!(self.operation, Jump | JumpUnless | JumpIfEqual | Repeat | RepeatUnless)
    }

    /// The registers read by the instruction, if their numbers are known.
    pub(super) fn reads(self) -> impl Iterator<Item = u16> {
        use Operation as O;
        let (words, count, length) = match self.operation {
            O::Jump | O::Repeat => ([0; 3], 0, 1),
            O::JumpUnless | O::RepeatUnless | O::LoadAt => ([self.a, 0, 0], 1, 1),
            O::JumpIfEqual => ([self.a, self.d, 0], 2, 1),
            O::StoreAt => ([self.a, self.b, 0], 2, 1),
            O::Dot => ([self.a, self.b, 0], 2, 3),
            single => ([self.a, self.b, self.c], single.arity(), 1),
        };
        words.into_iter().take(count).flat_map(move |word| (0..length).map(move |k| word.wrapping_add(k)))
    }

    /// The register written by the instruction, if any, and if its number is known.
    pub(super) fn writes(self) -> Option<u16> {
        (!self.jumps() && self.operation != Operation::StoreAt).then_some(self.d)
    }
}
