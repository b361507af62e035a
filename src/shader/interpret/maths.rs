//! The mathematical functions of WGSL.

use std::rc::Rc;

use naga::{MathFunction as M, ScalarKind, TypeInner};

use super::{Result, builder::Operand, instruction::Operation as O, lower::Lowering, unsupported};

type Words = Rc<[Operand]>;

fn number(value: f32) -> Operand {
    Operand::Constant(value.to_bits())
}

/// Componentwise functions of floats.
fn of_floats(fun: M) -> Option<O> {
    macro_rules! operation {
        ($($same:ident)*) => {
            match fun {
                $(M::$same => O::$same,)*
                M::Abs => O::AbsF,
                M::Min => O::MinF,
                M::Max => O::MaxF,
                M::Clamp => O::ClampF,
                M::Sign => O::SignF,
                M::Fma => O::MulAddF,
                _ => return None,
            }
        };
    }
    Some(operation! {
        Cos Cosh Sin Sinh Tan Tanh Acos Asin Atan Atan2 Asinh Acosh Atanh Radians Degrees Ceil
        Floor Round Fract Trunc Ldexp Exp Exp2 Log Log2 Pow Mix Step SmoothStep Sqrt InverseSqrt
    })
}

/// Componentwise functions of integers.
fn of_integers(fun: M, signed: bool) -> Option<O> {
    Some(match (fun, signed) {
        (M::Abs, true) => O::AbsS,
        (M::Abs, false) => O::Copy,
        (M::Min, true) => O::MinS,
        (M::Min, false) => O::MinU,
        (M::Max, true) => O::MaxS,
        (M::Max, false) => O::MaxU,
        (M::Sign, true) => O::SignS,
        (M::CountTrailingZeros, _) => O::TrailingZeros,
        (M::CountLeadingZeros, _) => O::LeadingZeros,
        (M::CountOneBits, _) => O::CountOnes,
        (M::ReverseBits, _) => O::ReverseBits,
        (M::FirstTrailingBit, _) => O::FirstTrailing,
        (M::FirstLeadingBit, true) => O::FirstLeadingS,
        (M::FirstLeadingBit, false) => O::FirstLeadingU,
        (M::ExtractBits, true) => O::ExtractS,
        (M::ExtractBits, false) => O::ExtractU,
        _ => return None,
    })
}

impl Lowering<'_> {
    /// The value of a function of values of one scalar type.
    pub(super) fn math(
        &mut self,
        fun: M,
        kind: ScalarKind,
        inner: &TypeInner,
        values: &[Words],
    ) -> Result<Words> {
        let float = kind == ScalarKind::Float;
        let values: Vec<&[Operand]> = values.iter().map(|v| &**v).collect();
        let by_word = if float { of_floats(fun) } else { of_integers(fun, kind == ScalarKind::Sint) };
        if let Some(operation) = by_word {
            return self.map(operation, &values);
        }
        match (fun, &values[..]) {
            (M::Saturate, [a]) => self.map(O::ClampF, &[a, &[number(0.0)], &[number(1.0)]]),
            (M::Clamp, [a, low, high]) => {
                let signed = kind == ScalarKind::Sint;
                let at_least = self.map(if signed { O::MaxS } else { O::MaxU }, &[a, low])?;
                self.map(if signed { O::MinS } else { O::MinU }, &[&at_least, high])
            }
            (M::Modf, [a]) => {
                let whole = self.map(O::Trunc, &[a])?;
                let part = self.map(O::SubF, &[a, &whole])?;
                Ok(part.iter().chain(whole.iter()).copied().collect())
            }
            (M::Frexp, [a]) => {
                let fraction = self.map(O::FrexpFraction, &[a])?;
                let exponent = self.map(O::FrexpExponent, &[a])?;
                Ok(fraction.iter().chain(exponent.iter()).copied().collect())
            }
            (M::InsertBits, [a, new, offset, count]) => {
                let mask = self.map(O::FieldMask, &[offset, count])?;
                let others = self.map(O::Complement, &[&mask])?;
                let kept = self.map(O::And, &[a, &others])?;
                let moved = self.map(O::ShiftLeft, &[new, offset])?;
                let put = self.map(O::And, &[&moved, &mask])?;
                self.map(O::Or, &[&kept, &put])
            }
            (M::Dot, [a, b]) => Ok(Rc::new([self.dot(a, b, float)?])),
            (M::Cross, [[ax, ay, az], [bx, by, bz]]) => {
                let x = self.two_products([*ay, *bz], [*az, *by])?;
                let y = self.two_products([*az, *bx], [*ax, *bz])?;
                let z = self.two_products([*ax, *by], [*ay, *bx])?;
                Ok(Rc::new([x, y, z]))
            }
            (M::Length, [a]) => Ok(Rc::new([self.length(a)?])),
            (M::Distance, [a, b]) => {
                let way = self.map(O::SubF, &[a, b])?;
                Ok(Rc::new([self.length(&way)?]))
            }
            (M::Normalize, [a]) => {
                let length = self.length(a)?;
                self.map(O::DivF, &[a, &[length]])
            }
            (M::FaceForward, [a, b, c]) => {
                let cosine = self.dot(b, c, true)?;
                let behind = self.builder.emit(O::LessF, &[cosine, number(0.0)])?;
                let turned = self.map(O::NegF, &[a])?;
                self.map(O::Select, &[&[behind], a, &turned])
            }
            (M::Reflect, [a, normal]) => {
                let cosine = self.dot(normal, a, true)?;
                let twice = self.builder.emit(O::MulF, &[number(2.0), cosine])?;
                let along = self.map(O::MulF, &[&[twice], normal])?;
                self.map(O::SubF, &[a, &along])
            }
            (M::Refract, [a, normal, [eta]]) => self.refract(a, normal, *eta),
            (M::Transpose, [a]) => {
                let TypeInner::Matrix { columns, rows, .. } = inner else {
                    return unsupported("it transposes a value that is not a matrix");
                };
                let (columns, rows) = (*columns as usize, *rows as usize);
                Ok((0..rows)
                    .flat_map(|row| (0..columns).map(move |c| c * rows + row))
                    .map(|i| a[i])
                    .collect())
            }
            (M::Determinant, [a]) => Ok(Rc::new([self.determinant(a)?])),
            _ => unsupported(format!("it calls {}", name(fun))),
        }
    }

    /// The first product minus the second.
    fn two_products(&mut self, [a, b]: [Operand; 2], [c, d]: [Operand; 2]) -> Result<Operand> {
        let first = self.builder.emit(O::MulF, &[a, b])?;
        let second = self.builder.emit(O::MulF, &[c, d])?;
        self.builder.emit(O::SubF, &[first, second])
    }

    fn length(&mut self, a: &[Operand]) -> Result<Operand> {
        if let [a] = a {
            return self.builder.emit(O::AbsF, &[*a]);
        }
        let squared = self.dot(a, a, true)?;
        self.builder.emit(O::Sqrt, &[squared])
    }

    /// Snell's law; zero for total reflection.
    fn refract(&mut self, a: &[Operand], normal: &[Operand], eta: Operand) -> Result<Words> {
        let cosine = self.dot(normal, a, true)?;
        let squared = self.builder.emit(O::MulF, &[cosine, cosine])?;
        let sine2 = self.builder.emit(O::SubF, &[number(1.0), squared])?;
        let eta2 = self.builder.emit(O::MulF, &[eta, eta])?;
        let bent = self.builder.emit(O::MulF, &[eta2, sine2])?;
        let k = self.builder.emit(O::SubF, &[number(1.0), bent])?;
        let root = self.builder.emit(O::Sqrt, &[k])?;
        let factor = self.builder.emit(O::MulAddF, &[eta, cosine, root])?;
        let across = self.map(O::MulF, &[&[eta], a])?;
        let along = self.map(O::MulF, &[&[factor], normal])?;
        let way = self.map(O::SubF, &[&across, &along])?;
        let total = self.builder.emit(O::LessF, &[k, number(0.0)])?;
        self.map(O::Select, &[&[total], &[number(0.0)], &way])
    }

    /// The determinant, expanded along its first column.
    fn determinant(&mut self, a: &[Operand]) -> Result<Operand> {
        let size = match a.len() {
            1 => return Ok(a[0]),
            4 => 2,
            9 => 3,
            _ => 4,
        };
        let mut sum = None;
        for row in 0..size {
            let minor: Vec<_> = (1..size)
                .flat_map(|c| (0..size).filter(move |r| *r != row).map(move |r| a[c * size + r]))
                .collect();
            let minor = self.determinant(&minor)?;
            let part = self.builder.emit(O::MulF, &[a[row], minor])?;
            sum = Some(match sum {
                None => part,
                Some(sum) if row % 2 == 1 => self.builder.emit(O::SubF, &[sum, part])?,
                Some(sum) => self.builder.emit(O::AddF, &[sum, part])?,
            });
        }
        Ok(sum.unwrap_or(number(1.0)))
    }
}

/// The name of a function in WGSL.
fn name(fun: M) -> String {
    let mut name = format!("{fun:?}");
    name.replace_range(..1, &name[..1].to_lowercase());
    name
}
