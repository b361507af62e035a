//! Minimises a sum of squares within ranges: the method of K. Levenberg (1944) and D. Marquardt (1963), *An Algorithm
//! for Least-Squares Estimation of Nonlinear Parameters*, in which coordinates at the ends of their ranges are fixed.
//!
//! Our own, since MINPACK's descendants, [`rmpfit`](super::least_squares) among them, shorten the whole step where one coordinate
//! meets the end of its range. Of the twenty numbers of a layered model, half begin at an end, and the descent stands still. Here
//! only that coordinate stays, and the others are solved for again. The numbers of a search are few and its terms
//! many, so the normal equations do.

use super::least_squares::{Limits, Residuals, Stop};

/// The least, the first and the greatest damping, as fractions of the curvatures.
const DAMPING: [f64; 3] = [1e-10, 1e-2, 1e8];
/// Factors of the damping after a step that helped, and after one that did not.
const SOFTER: f64 = 5.0;
const HARDER: f64 = 6.0;
/// Part of the greatest curvature that is added to all, so that a coordinate that hardly matters hardly moves.
const FLOOR: f64 = 1e-6;
/// Part of the greatest curvature that keeps the equations solvable where coordinates do the same.
const ROUNDING: f64 = 1e-12;
/// Maximum number of attempts at one step, each shorter than the one before.
const ATTEMPTS: usize = 8;

/// Moves a point downhill, within ranges, to a nearby minimum of the sum of squares. The first step of the limits
/// does not count.
///
/// # Errors
/// Returns [`Stop`] if the residuals end the search; the point is then the best so far.
pub(super) fn descend(
    residuals: &mut impl Residuals,
    point: &mut [f64],
    ranges: &[(f64, f64)],
    limits: Limits,
) -> Result<(), Stop> {
    for (x, (low, high)) in point.iter_mut().zip(ranges) {
        *x = x.clamp(*low, *high);
    }
    let all: Vec<usize> = (0..point.len()).collect();
    let mut here = vec![0.0; residuals.count()];
    let mut there = here.clone();
    let mut columns = vec![here.clone(); point.len()];
    let mut damping = DAMPING[1];
    for _ in 0..limits.steps {
        residuals.derivatives(point, &mut here, &mut columns)?;
        let before = dot(&here, &here);
        let slope = Slope::of(&columns, &here);
        let mut gain = 0.0;
        for _ in 0..ATTEMPTS {
            let step = slope.step(&all, point, ranges, damping);
            if step.iter().all(|d| d.abs() <= limits.least_move) {
                break;
            }
            let next: Vec<f64> = point.iter().zip(&step).map(|(x, d)| x + d).collect();
            residuals.at(&next, &mut there)?;
            gain = 1.0 - dot(&there, &there) / before;
            if gain > 0.0 {
                point.copy_from_slice(&next);
                damping = (damping / SOFTER).max(DAMPING[0]);
                break;
            }
            damping = (damping * HARDER).min(DAMPING[2]);
        }
        if gain.is_nan() || gain <= limits.least_gain {
            break;
        }
    }
    Ok(())
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A sum of squares near a point: its slope and its curvature along each coordinate.
pub(super) struct Slope {
    /// Half the derivatives of the sum.
    down: Vec<f64>,
    /// The lower half of the matrix of the normal equations.
    curvature: Vec<Vec<f64>>,
}

impl Slope {
    /// From the terms and their derivatives.
    pub(super) fn of(columns: &[Vec<f64>], terms: &[f64]) -> Self {
        let products =
            |(i, column): (usize, &Vec<f64>)| columns[..=i].iter().map(|other| dot(column, other)).collect();
        Self {
            down: columns.iter().map(|column| dot(column, terms)).collect(),
            curvature: columns.iter().enumerate().map(products).collect(),
        }
    }

    fn curvature(&self, i: usize, j: usize) -> f64 {
        self.curvature[i.max(j)][i.min(j)]
    }

    /// The step of all coordinates, damped and within the ranges; only those of `free` move.
    fn step(&self, free: &[usize], point: &[f64], ranges: &[(f64, f64)], damping: f64) -> Vec<f64> {
        let mut step = vec![0.0; point.len()];
        // A coordinate without effect stays, as does one at an end that would leave its range.
        let moves = |i: &usize| {
            let (i, (low, high)) = (*i, ranges[*i]);
            let leaves = point[i] <= low && self.down[i] >= 0.0 || point[i] >= high && self.down[i] <= 0.0;
            self.curvature(i, i) > 0.0 && !leaves
        };
        let mut free: Vec<usize> = free.iter().copied().filter(moves).collect();
        let largest = free.iter().map(|i| self.curvature(*i, *i)).fold(0.0, f64::max);
        let mut ended: Vec<usize> = Vec::new();
        while !free.is_empty() {
            let row = |(k, i): (usize, &usize)| {
                let mut row: Vec<f64> = free[..=k].iter().map(|j| self.curvature(*i, *j)).collect();
                row[k] += damping * (row[k] + FLOOR * largest) + ROUNDING * largest;
                row
            };
            let matrix = free.iter().enumerate().map(row).collect();
            let fixed = |i: usize| ended.iter().map(|j| self.curvature(i, *j) * step[*j]).sum::<f64>();
            let right = free.iter().map(|i| -self.down[*i] - fixed(*i)).collect();
            let solved = solve(matrix, right);
            let before = ended.len();
            for (i, d) in free.iter().copied().zip(solved) {
                let inside = (point[i] + d).clamp(ranges[i].0, ranges[i].1);
                step[i] = inside - point[i];
                if inside != point[i] + d {
                    ended.push(i);
                }
            }
            if ended.len() == before {
                break;
            }
            free.retain(|i| !ended.contains(i));
        }
        step
    }

    /// The amount by which the sum falls at most if these coordinates move, as far as the slope tells.
    pub(super) fn promise(&self, free: &[usize], point: &[f64], ranges: &[(f64, f64)]) -> f64 {
        let step = self.step(free, point, ranges, DAMPING[1]);
        let bend = |i: &usize| step[*i] * free.iter().map(|j| self.curvature(*i, *j) * step[*j]).sum::<f64>();
        -free.iter().map(|i| 2.0 * self.down[*i] * step[*i] + bend(i)).sum::<f64>()
    }
}

/// The inverse of the matrix of the normal equations of some columns of length 1. Its diagonal is for each the part of it, squared, that no sum of the
/// others reaches, inverted: how much less is known of its number since the others vary too, the variance inflation factor
/// (D. Belsley, E. Kuh, R. Welsch 1980, *Regression Diagnostics*). The rest of its row, divided by it, is how much of each other makes up that sum.
pub(super) fn inverse(columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
    /// Keeps the equations solvable where columns do the same: the largest factors are about its inverse.
    const LEAST: f64 = 1e-9;
    let row = |i: usize| {
        let mut row: Vec<f64> = columns[..=i].iter().map(|other| dot(&columns[i], other)).collect();
        row[i] += LEAST;
        row
    };
    let matrix: Vec<Vec<f64>> = (0..columns.len()).map(row).collect();
    let row = |i: usize| {
        let mut unit = vec![0.0; columns.len()];
        unit[i] = 1.0;
        solve(matrix.clone(), unit)
    };
    (0..columns.len()).map(row).collect()
}

/// Solves symmetric equations by A.-L. Cholesky's method. `matrix` is the lower half.
fn solve(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    let size = right.len();
    for i in 0..size {
        for j in 0..=i {
            let rest = matrix[i][j] - dot(&matrix[i][..j], &matrix[j][..j]);
            matrix[i][j] = if i == j { rest.max(f64::MIN_POSITIVE).sqrt() } else { rest / matrix[j][j] };
        }
        right[i] = (right[i] - dot(&matrix[i][..i], &right[..i])) / matrix[i][i];
    }
    for i in (0..size).rev() {
        right[i] /= matrix[i][i];
        for j in 0..i {
            right[j] -= matrix[i][j] * right[i];
        }
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits { steps: 100, least_gain: 1e-12, least_move: 1e-9, first_step: 1.0 };

    /// Numbers that are wanted, all of them through one sum too, which makes them depend on each other.
    struct Wanted {
        wanted: Vec<f64>,
        asked: usize,
    }

    impl Residuals for Wanted {
        fn count(&self) -> usize {
            self.wanted.len() + 1
        }

        fn at(&mut self, x: &[f64], residuals: &mut [f64]) -> Result<(), Stop> {
            self.asked += 1;
            let (sum, own) = residuals.split_last_mut().ok_or(Stop)?;
            *sum = x.iter().sum::<f64>().powi(2) - self.wanted.iter().sum::<f64>().powi(2);
            own.iter_mut().zip(x).zip(&self.wanted).for_each(|((to, x), wanted)| *to = x - wanted);
            Ok(())
        }

        fn derivatives(
            &mut self,
            x: &[f64],
            residuals: &mut [f64],
            columns: &mut [Vec<f64>],
        ) -> Result<(), Stop> {
            for (i, column) in columns.iter_mut().enumerate() {
                column.fill(0.0);
                column[i] = 1.0;
                column[self.wanted.len()] = 2.0 * x.iter().sum::<f64>();
            }
            self.at(x, residuals)
        }
    }

    #[test]
    fn coordinates_that_meet_an_end_do_not_hold_the_others_back() {
        // Half of them begin at an end, and some are wanted beyond it.
        let wanted: Vec<f64> = (0..20).map(|i| if i % 4 == 0 { -0.2 } else { 0.04 * f64::from(i) }).collect();
        let mut target = Wanted { wanted, asked: 0 };
        let mut at: Vec<f64> = (0..20).map(|i| if i % 2 == 0 { 0.0 } else { 1.0 }).collect();
        assert_eq!(descend(&mut target, &mut at, &[(0.0, 1.0); 20], LIMITS), Ok(()));
        assert!(at.iter().all(|x| (0.0..=1.0).contains(x)), "{at:?}");
        assert!(target.asked < 60, "{}", target.asked);
        // At the minimum the slope is zero, or leads out of the range.
        let mut here = vec![0.0; 21];
        let mut columns = vec![here.clone(); 20];
        target.derivatives(&at, &mut here, &mut columns).expect("it does not end");
        for (x, column) in at.iter().zip(&columns) {
            let down = dot(column, &here);
            let ends = (*x == 0.0 && down > 0.0) || (*x == 1.0 && down < 0.0);
            assert!(ends || down.abs() < 1e-4, "{x}: {down}");
        }
    }

    #[test]
    fn equations_are_solved_as_they_are_by_hand() {
        // 4 x + 2 y = 8, 2 x + 3 y = 8.
        let solved = solve(vec![vec![4.0], vec![2.0, 3.0]], vec![8.0, 8.0]);
        assert!((solved[0] - 1.0).abs() < 1e-12 && (solved[1] - 2.0).abs() < 1e-12, "{solved:?}");
    }

    #[test]
    fn columns_that_others_make_up_are_told_from_those_that_stand_alone() {
        let half = 0.5f64.sqrt();
        let columns = [vec![1.0, 0.0, 0.0], vec![0.0, 1.0, 0.0], vec![half, half, 0.0], vec![0.0, 0.6, 0.8]];
        let found = inverse(&columns);
        assert!((0..3).all(|i| found[i][i] > 1e8), "{found:?}");
        // Of the last, 0.8² is its own.
        assert!((found[3][3] - 1.0 / 0.64).abs() < 1e-6, "{found:?}");
        // The third is made up of the first two, and of nothing of the last.
        let parts: Vec<f64> = found[2].iter().map(|number| -number / found[2][2]).collect();
        let expected = [half, half, -1.0, 0.0];
        assert!(parts.iter().zip(expected).all(|(own, wanted)| (own - wanted).abs() < 1e-6), "{parts:?}");
        assert!(inverse(&[]).is_empty());
    }

    #[test]
    fn the_promise_of_coordinates_is_the_fall_of_the_sum() {
        // The terms 3 − x and 4 − y, from (0, 0): the first falls by 9, both by 25.
        let slope = Slope::of(&[vec![-1.0, 0.0], vec![0.0, -1.0]], &[3.0, 4.0]);
        let promise = |free: &[usize]| slope.promise(free, &[0.0; 2], &[(0.0, 9.0); 2]);
        assert!((promise(&[0]) - 9.0).abs() < 0.01 && (promise(&[0, 1]) - 25.0).abs() < 0.02);
    }
}
