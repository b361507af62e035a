//! Minimises a sum of squares: the method of K. Levenberg (1944), *A Method for the Solution of Certain
//! Non-Linear Problems in Least Squares*, as in MINPACK and C. Markwardt's MPFIT, implemented in Rust by the
//! crate `rmpfit`.

use rmpfit::{MPConfig, MPError, MPFitter, MPMaxFev, MPPar, MPResult, MPSide};

/// Signals that a search should end early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stop;

/// A sum of squares: its terms and their derivatives.
pub trait Residuals {
    /// Number of terms.
    fn count(&self) -> usize;

    /// The terms at a point.
    ///
    /// # Errors
    /// Returns [`Stop`] if the search should end.
    fn at(&mut self, point: &[f64], residuals: &mut [f64]) -> Result<(), Stop>;

    /// The terms at a point, and their derivatives with respect to its coordinates.
    ///
    /// # Errors
    /// Returns [`Stop`] if the search should end.
    fn derivatives(
        &mut self,
        point: &[f64],
        residuals: &mut [f64],
        columns: &mut [Vec<f64>],
    ) -> Result<(), Stop>;
}

/// The termination conditions of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Maximum number of steps.
    pub steps: usize,
    /// A step that lowers the sum by a smaller fraction is the last.
    pub least_gain: f64,
    /// A step that moves the point by a smaller fraction is the last.
    pub least_move: f64,
    /// Length of the first step, as a multiple of the point's distance from zero.
    pub first_step: f64,
}

/// Moves a point downhill, within ranges, to a nearby minimum of the sum of squares. It stays unchanged if
/// there are fewer terms than coordinates, or numbers that are not finite.
///
/// # Errors
/// Returns [`Stop`] if the residuals end the search; the point is then unchanged.
pub fn descend(
    residuals: &mut impl Residuals,
    point: &mut [f64],
    ranges: &[(f64, f64)],
    limits: Limits,
) -> Result<(), Stop> {
    for (x, (low, high)) in point.iter_mut().zip(ranges) {
        *x = x.clamp(*low, *high);
    }
    let parameters = ranges
        .iter()
        .map(|(low, high)| MPPar {
            limited_low: true,
            limited_up: true,
            limit_low: *low,
            limit_up: *high,
            side: MPSide::User,
            ..MPPar::new()
        })
        .collect();
    let config = MPConfig {
        ftol: limits.least_gain,
        xtol: limits.least_move,
        step_factor: limits.first_step,
        max_iter: limits.steps,
        // A step is repeated, shorter each time, but seldom more often than this.
        max_fev: MPMaxFev::Limited(20 * limits.steps.max(1)),
        ..MPConfig::new()
    };
    match (Fitter { residuals, parameters, config }).mpfit(point) {
        Err(MPError::Eval) => Err(Stop),
        Ok(_) | Err(_) => Ok(()),
    }
}

struct Fitter<'a, R> {
    residuals: &'a mut R,
    parameters: Vec<MPPar>,
    config: MPConfig,
}

impl<R: Residuals> MPFitter for Fitter<'_, R> {
    fn eval(&mut self, point: &[f64], deviates: &mut [f64]) -> MPResult<()> {
        self.residuals.at(point, deviates).map_err(|_| MPError::Eval)
    }

    fn number_of_points(&self) -> usize {
        self.residuals.count()
    }

    fn config(&self) -> &MPConfig {
        &self.config
    }

    fn parameters(&self) -> &[MPPar] {
        &self.parameters
    }

    fn jacobian(
        &mut self,
        point: &[f64],
        deviates: &mut [f64],
        columns: &mut [Option<Vec<f64>>],
    ) -> MPResult<()> {
        // All derivatives are requested: no parameter is fixed, and none is derived numerically.
        let mut all: Vec<_> = columns.iter_mut().map(|column| column.take().unwrap_or_default()).collect();
        let done = self.residuals.derivatives(point, deviates, &mut all);
        columns.iter_mut().zip(all).for_each(|(column, found)| *column = Some(found));
        done.map_err(|_| MPError::Eval)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits { steps: 100, least_gain: 1e-12, least_move: 1e-9, first_step: 1.0 };

    /// H. H. Rosenbrock's valley (1960): its minimum is at (1, 1).
    struct Valley {
        asked: usize,
        most: usize,
    }

    impl Residuals for Valley {
        fn count(&self) -> usize {
            2
        }

        fn at(&mut self, x: &[f64], residuals: &mut [f64]) -> Result<(), Stop> {
            self.asked += 1;
            residuals.copy_from_slice(&[10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]]);
            if self.asked > self.most { Err(Stop) } else { Ok(()) }
        }

        fn derivatives(
            &mut self,
            x: &[f64],
            residuals: &mut [f64],
            columns: &mut [Vec<f64>],
        ) -> Result<(), Stop> {
            columns[0].copy_from_slice(&[-20.0 * x[0], -1.0]);
            columns[1].copy_from_slice(&[10.0, 0.0]);
            self.at(x, residuals)
        }
    }

    #[test]
    fn the_bottom_of_a_valley_is_found_and_bounds_are_kept() {
        let mut valley = Valley { asked: 0, most: 1000 };
        let mut at = [-1.2, 1.0];
        assert_eq!(descend(&mut valley, &mut at, &[(-5.0, 5.0); 2], LIMITS), Ok(()));
        assert!((at[0] - 1.0).abs() < 1e-6 && (at[1] - 1.0).abs() < 1e-6, "{at:?}");
        assert!(valley.asked < 200, "{}", valley.asked);
        // If x must not exceed a half, the best y is its square.
        let mut at = [-1.2, 1.0];
        assert_eq!(descend(&mut valley, &mut at, &[(-5.0, 0.5), (-5.0, 5.0)], LIMITS), Ok(()));
        assert!((at[0] - 0.5).abs() < 1e-6 && (at[1] - 0.25).abs() < 1e-4, "{at:?}");
    }

    #[test]
    fn a_search_ends_when_it_is_told_to() {
        let mut valley = Valley { asked: 0, most: 3 };
        let mut at = [-1.2, 1.0];
        assert_eq!(descend(&mut valley, &mut at, &[(-5.0, 5.0); 2], LIMITS), Err(Stop));
        assert_eq!((at, valley.asked), ([-1.2, 1.0], 4));
    }
}
