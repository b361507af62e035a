//! Searches for the closest values.
//!
//! The search descends from the present values. Then it searches each parameter alone, and the best of them
//! together with those that promise most, one more at a time. Then it descends from the best point so far, and from the
//! nearest of points spread over the ranges of small sets of parameters, such as two of the coat, and of all. It keeps the best
//! point seen, so more free parameters never give a worse result than a subset that was tried. Finally it simplifies the
//! result: parameters that hardly matter keep their values, and insignificant digits are dropped. Nothing is random, and
//! it ends by the number of evaluations, so that the result is the same on every computer.

use std::time::Duration;

use web_time::Instant;

use super::{
    Ended,
    axis::Axis,
    descent::{self, descend},
    least_squares::{Limits, Residuals, Stop},
};
use crate::{
    parameter::{Parameter, Value},
    progress::{Cancelled, Progress},
};

/// Number of points spread over the ranges of some parameters.
const SPREAD: usize = 24;
/// Number of those from which the search descends.
const DESCENTS: usize = 3;
/// A descent with few parameters goes on with all if its error is at most this many times the least so far.
const PROMISING: f64 = 10.0;
/// Termination conditions of each descent.
const LIMITS: Limits = Limits { steps: 25, least_gain: 1e-7, least_move: 1e-6, first_step: 0.5 };
/// Termination conditions of a short descent, which only shows which parameters are promising.
const SHORT: Limits = Limits { steps: 6, ..LIMITS };
/// Least and greatest number of values tried for one parameter, in addition to the present one, and the part of all evaluations
/// that those of all parameters may take in between.
const SCANNED: [usize; 2] = [6, 24];
const SCANS: f64 = 0.1;
/// Parts of the evaluations after which the descent from the present values and the growth of subsets end.
const SHARES: [f64; 2] = [0.12, 0.35];
/// Maximum number of parameters that are searched together before all are.
const GROWN: usize = 5;
/// Number of parameters that are tried beside those of a subset, and number of subsets that are kept for that.
const TRIED: usize = 2;
const BEAMS: usize = 4;
/// Part of the error that must be left for one more parameter to help.
const HELPS: f64 = 0.99;
/// Maximum duration of a search, far beyond what its evaluations should take; the best result until then counts.
const LONGEST: Duration = Duration::from_secs(600);
/// A parameter keeps its value, and digits are dropped, if the error grows by at most this fraction of
/// itself, or of the initial error.
const GIVEN_UP: [f64; 2] = [1e-3, 1e-6];
/// Factor of inflation, the diagonal of [`descent::inverse`], from which a parameter is ambiguous: a hundredth of what it changes is left
/// when the others undo it.
const AMBIGUOUS: f64 = 1e4;
/// The factor where a fifth is left. From there on a parameter is ambiguous too if it can move by this part of its range, while the others follow and the
/// error grows by less than [`HELPS`] counts.
const FOLLOWED: f64 = 25.0;
const LOOSE: f64 = 0.05;
/// Part of what the only ambiguous parameter changes from which another one that undoes it is named too.
const UNDOES: f64 = 0.1;
/// Part of the effect of the parameter that changes most, below which the effect of another is rounding.
const FELT: f64 = 1e-4;
/// Errors below this count as zero: the models calculate in 32 bits.
const NONE: f64 = 1e-6;

/// Values of parameters.
pub(super) type Given = Vec<(&'static str, Value)>;

/// A picture or a lobe to compare with another.
pub(super) trait Target {
    /// Number of differences.
    fn count(&self) -> usize;

    /// The differences with these parameter values; other parameters are unchanged.
    fn differences(&mut self, values: &Given, to: &mut [f64]);
}

/// Coordinates, differences and their derivatives.
type Slopes = (Vec<f64>, Vec<f64>, Vec<Vec<f64>>);

/// A free parameter.
pub(super) struct Free {
    pub(super) parameter: &'static Parameter,
    pub(super) axes: Vec<Axis>,
    /// Present value.
    pub(super) now: Value,
    /// Title of the group of parameters in the model.
    pub(super) group: Option<&'static str>,
}

/// The result of a search.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Found {
    pub(super) values: Given,
    pub(super) before: f64,
    pub(super) after: f64,
    /// Parameters of which no value that was tried made a difference.
    pub(super) without_effect: Vec<&'static str>,
    /// Parameters that others can replace: see [`Search::ambiguous`].
    pub(super) ambiguous: Vec<&'static str>,
    pub(super) evaluations: usize,
    pub(super) ended: Ended,
}

/// A point: a number on each axis.
#[derive(Clone, Debug, PartialEq)]
struct Point {
    numbers: Vec<f64>,
    /// True for each parameter that is set.
    on: Vec<bool>,
}

pub(super) struct Search<'a, T> {
    target: &'a mut T,
    free: &'a [Free],
    progress: &'a Progress<'a>,
    /// Maximum number of evaluations.
    most: usize,
    evaluations: usize,
    /// Number of evaluations after which the present stage ends.
    until: usize,
    begun: Instant,
    /// True for the final evaluations, which are always made.
    last: bool,
    cancelled: bool,
    best: (f64, Option<Point>),
    /// For each parameter the difference that its value made, with the others at their present values.
    influence: Vec<f64>,
    /// The same, or more where the others of its group are in the middle of their ranges.
    reach: Vec<f64>,
    /// For each parameter whether values of it were tried, and whether one of them made a difference.
    effect: Vec<(bool, bool)>,
    ended: Ended,
    step: String,
}

/// The nearest point that was found with some of the parameters.
#[derive(Clone)]
struct Subset {
    error: f64,
    chosen: Vec<usize>,
    point: Point,
}

impl<'a, T: Target> Search<'a, T> {
    pub(super) fn new(target: &'a mut T, free: &'a [Free], most: usize, progress: &'a Progress<'a>) -> Self {
        Self {
            target,
            free,
            progress,
            most,
            evaluations: 0,
            until: most,
            begun: Instant::now(),
            last: false,
            cancelled: false,
            best: (f64::INFINITY, None),
            influence: vec![0.0; free.len()],
            reach: vec![0.0; free.len()],
            effect: vec![(false, false); free.len()],
            ended: Ended::Itself,
            step: String::new(),
        }
    }

    /// Runs the search.
    ///
    /// # Errors
    /// Returns [`Cancelled`] if the user cancels before anything was compared. Later, the best so far is the result as it is.
    pub(super) fn run(mut self) -> Result<Found, Cancelled> {
        "comparing the views".clone_into(&mut self.step);
        let none = Point { numbers: self.present(), on: vec![false; self.free.len()] };
        let before = self.error(&none).map_err(|Stop| Cancelled)?;
        if before > NONE && !self.free.is_empty() {
            // The end of the evaluations ends the search, and what was found counts.
            let _ = self.find();
        }
        let (error, best) = std::mem::take(&mut self.best);
        self.last = true;
        let Some(best) = best.filter(|_| error < before) else {
            // The present values may be one choice of many.
            let judged = before > NONE && !self.free.is_empty();
            let ambiguous =
                if judged { self.ambiguous(&none, before).unwrap_or_default() } else { Vec::new() };
            return Ok(self.found(Vec::new(), ambiguous, [before; 2]));
        };
        let good = (1.0 + GIVEN_UP[0]) * error + GIVEN_UP[1] * before;
        let (best, after) = self.simplified(best.clone(), good, error).unwrap_or((best, error));
        let ambiguous = self.ambiguous(&best, after).unwrap_or_default();
        let values = self.values(&best);
        Ok(self.found(values, ambiguous, [before, after]))
    }

    fn found(self, values: Given, ambiguous: Vec<&'static str>, [before, after]: [f64; 2]) -> Found {
        let without = self.free.iter().zip(&self.effect).filter(|(_, effect)| **effect == (true, false));
        let without_effect = without.map(|(free, _)| free.parameter.name).collect();
        let ended = if self.cancelled { Ended::Interrupted } else { self.ended };
        let evaluations = self.evaluations;
        Found { values, before, after, without_effect, ambiguous, evaluations, ended }
    }

    /// The parameters of which other values give nearly the same, if others of them change too, such as a weight and the colour
    /// that it scales: what each of their numbers changes, the other numbers undo, but for a hundredth, or but for what does not
    /// count beside the error that remains.
    fn ambiguous(&mut self, best: &Point, error: f64) -> Result<Vec<&'static str>, Stop> {
        let owners = self.owners();
        let columns = self.centred(best)?;
        let lengths: Vec<f64> = columns.iter().map(|c| c.iter().map(|d| d * d).sum::<f64>().sqrt()).collect();
        let longest = lengths.iter().copied().fold(0.0, f64::max);
        let felt: Vec<usize> = (0..columns.len()).filter(|i| lengths[*i] > FELT * longest).collect();
        let unit = |i: &usize| columns[*i].iter().map(|d| d / lengths[*i]).collect();
        let inverse = descent::inverse(&felt.iter().map(unit).collect::<Vec<Vec<f64>>>());
        // The length of a change of all differences that makes the error grow by no more than that.
        let slack = error * (self.target.count() as f64 * (HELPS.powi(-2) - 1.0)).sqrt();
        let is_ambiguous = |k: &usize| {
            let factor = inverse[*k][*k];
            let moves = slack * factor.sqrt() / lengths[felt[*k]];
            factor > AMBIGUOUS || factor > FOLLOWED && moves > LOOSE
        };
        let owner = |k: usize| owners[felt[k]].0;
        let found: Vec<usize> = (0..felt.len()).filter(is_ambiguous).collect();
        let mut named: Vec<usize> = found.iter().map(|k| owner(*k)).collect();
        named.dedup();
        if named.len() == 1 {
            // It does not change alone.
            let undoes = |row: &[f64], k: usize, j: usize| row[j].abs() > UNDOES * row[k];
            for k in found {
                named.extend((0..felt.len()).filter(|j| undoes(&inverse[k], k, *j)).map(owner));
            }
            named.sort_unstable();
            named.dedup();
        }
        Ok(named.into_iter().map(|owner| self.free[owner].parameter.name).collect())
    }

    /// What each number changes at a point, for its whole range: by differences around it, so that neither the rounding of the
    /// models nor a bend hides that others change the same. Parameters that are not set keep their present values.
    fn centred(&mut self, point: &Point) -> Result<Vec<Vec<f64>>, Stop> {
        let owners = self.owners();
        let mut point = point.clone();
        for ((number, now), (owner, _)) in point.numbers.iter_mut().zip(self.present()).zip(&owners) {
            if !point.on[*owner] {
                *number = now;
            }
        }
        point.on.fill(true);
        let mut below = vec![0.0; self.count()];
        let mut columns = vec![below.clone(); owners.len()];
        for (i, ((owner, axis), column)) in owners.into_iter().zip(&mut columns).enumerate() {
            let here = point.numbers[i];
            let ends = axis.around(here);
            let way = axis.coordinate(ends[1]) - axis.coordinate(ends[0]);
            for (end, to) in ends.into_iter().zip([&mut below, &mut *column]) {
                point.numbers[i] = end;
                self.differences(&point, to)?;
            }
            point.numbers[i] = here;
            column.iter_mut().zip(&below).for_each(|(to, from)| *to = (*to - from) / way);
            let effect = &mut self.effect[owner];
            *effect = (true, effect.1 || column.iter().any(|slope| *slope != 0.0));
        }
        Ok(columns)
    }

    /// The coordinates of a point, the differences there, and their derivatives by each number of some parameters.
    fn slopes(&mut self, point: &Point, parameters: &[usize]) -> Result<Slopes, Stop> {
        let mut track = Track::new(self, point, parameters);
        let at = track.coordinates();
        let mut here = vec![0.0; track.count()];
        let mut columns = vec![here.clone(); at.len()];
        track.derivatives(&at, &mut here, &mut columns)?;
        Ok((at, here, columns))
    }

    /// The axes of all parameters.
    fn axes(&self) -> impl Iterator<Item = &'a Axis> + use<'a, T> {
        self.free.iter().flat_map(|free| &free.axes)
    }

    /// The axes of all parameters, each with the index of its parameter.
    fn owners(&self) -> Vec<(usize, &'a Axis)> {
        let of = |(i, free): (usize, &'a Free)| free.axes.iter().map(move |axis| (i, axis));
        self.free.iter().enumerate().flat_map(of).collect()
    }

    /// The present values.
    fn present(&self) -> Vec<f64> {
        let numbers = |free: &'a Free| {
            let now = free.now.numbers();
            free.axes.iter().map(move |axis| axis.legal(now[axis.channel]))
        };
        self.free.iter().flat_map(numbers).collect()
    }

    /// The values at a point.
    fn values(&self, point: &Point) -> Given {
        let mut numbers = point.numbers.iter();
        let mut values = Vec::new();
        for (free, on) in self.free.iter().zip(&point.on) {
            let mut own = [0.0; 3];
            own.iter_mut().zip(numbers.by_ref().take(free.axes.len())).for_each(|(to, from)| *to = *from);
            if *on {
                values.push((free.parameter.name, free.parameter.kind.of_numbers(own)));
            }
        }
        values
    }

    /// The differences at a point, and their root mean square.
    fn differences(&mut self, point: &Point, to: &mut [f64]) -> Result<f64, Stop> {
        self.cancelled |= (self.progress.cancelled)();
        if self.begun.elapsed() > LONGEST && !self.last {
            self.ended = Ended::Time;
        }
        let spent = self.evaluations >= self.until.min(self.most) || self.ended == Ended::Time;
        if self.cancelled || spent && !self.last {
            return Err(Stop);
        }
        if self.evaluations.is_multiple_of(self.most.div_ceil(1000)) {
            self.tell();
        }
        self.evaluations += 1;
        let count = self.target.count();
        let values = self.values(point);
        self.target.differences(&values, &mut to[..count]);
        to[count..].fill(0.0);
        /// Replaces differences that are not finite.
        const FAR: f64 = 1e9;
        to.iter_mut().filter(|d| !d.is_finite()).for_each(|d| *d = FAR);
        Ok((to.iter().map(|d| d * d).sum::<f64>() / count.max(1) as f64).sqrt())
    }

    /// Reports the progress of the search.
    fn tell(&self) {
        let done = (self.evaluations as f32 / self.most as f32).min(1.0);
        (self.progress.tell)(if self.last { 1.0 } else { done }, &self.step);
    }

    fn error(&mut self, point: &Point) -> Result<f64, Stop> {
        let mut scratch = vec![0.0; self.count()];
        self.differences(point, &mut scratch)
    }

    /// The differences at a point; remembers the best point.
    fn noted(&mut self, point: &Point, to: &mut [f64]) -> Result<f64, Stop> {
        let error = self.differences(point, to)?;
        if error < self.best.0 {
            self.best = (error, Some(point.clone()));
        }
        Ok(error)
    }

    /// The number of differences, at least that of the axes: additional ones are always 0.
    fn count(&self) -> usize {
        self.target.count().max(self.axes().count())
    }

    /// Looks for the best, each way with its share of the evaluations; the end of a share is not that of the search.
    fn find(&mut self) -> Result<(), Stop> {
        let all: Vec<usize> = (0..self.free.len()).collect();
        let present = Point { numbers: self.present(), on: vec![true; all.len()] };
        let ways: [(f64, &mut dyn FnMut(&mut Self) -> Result<(), Stop>); 3] = [
            (SHARES[0], &mut |search| {
                "descending from the present values".clone_into(&mut search.step);
                search.descend_from(&present, &all, LIMITS).map(drop)
            }),
            (SHARES[1], &mut |search| if all.len() > 1 { search.grow() } else { Ok(()) }),
            (1.0, &mut |search| search.spread_out(&all)),
        ];
        for (share, way) in ways {
            self.until = (share * self.most as f64).ceil() as usize;
            let ended = way(self);
            if self.cancelled || self.ended == Ended::Time {
                return ended;
            }
            if self.best.0 < NONE {
                break;
            }
            if ended.is_err() && self.until >= self.most {
                self.ended = Ended::Evaluations;
            }
        }
        "trying whole numbers".clone_into(&mut self.step);
        self.try_neighbours()
    }

    /// Searches each parameter alone, then the best of them together with each of the others that promise most, and so
    /// on, as long as one more helps.
    fn grow(&mut self) -> Result<(), Stop> {
        let present = Point { numbers: self.present(), on: vec![false; self.free.len()] };
        let mut alone = Vec::new();
        for (i, free) in self.free.iter().enumerate() {
            self.step = format!("trying {} alone", free.parameter.label);
            let (errors, start) = self.scan(&present, i)?;
            self.influence[i] = errors[1] - errors[0];
            self.effect[i] = (true, self.effect[i].1 || errors[1] != errors[0]);
            alone.push(Subset { error: errors[0], chosen: vec![i], point: start });
        }
        self.reach.clone_from(&self.influence);
        for (i, free) in self.free.iter().enumerate() {
            self.step = format!("trying {} with its group", free.parameter.label);
            let (errors, _) = self.scan(&self.amid(i), i)?;
            self.reach[i] = self.reach[i].max(errors[1] - errors[0]);
            self.effect[i].1 |= errors[1] != errors[0];
        }
        alone.sort_by(|a, b| a.error.total_cmp(&b.error));
        alone.truncate(BEAMS);
        for subset in &mut alone {
            (subset.error, subset.point) = self.descend_from(&subset.point, &subset.chosen, SHORT)?;
        }
        let none = Subset { error: 0.0, chosen: Vec::new(), point: present.clone() };
        let at_first = self.promises(&none)?;
        let mut kept = self.nearest(alone);
        for size in 2..=GROWN.min(self.free.len()) {
            self.step = format!("trying {size} parameters together");
            let mut grown: Vec<Subset> = Vec::new();
            for subset in &kept {
                let here = self.promises(subset)?;
                let new = |more: &&usize| !subset.chosen.contains(more);
                let [here, there] = [&here, &at_first].map(|all| all.iter().filter(new).take(TRIED));
                for more in here.chain(there) {
                    let chosen = [&[*more], &subset.chosen[..]].concat();
                    if grown.iter().any(|known| known.chosen.iter().all(|i| chosen.contains(i))) {
                        continue;
                    }
                    // The present values are often nearer to the valley than the end of a smaller subset.
                    for start in [&subset.point, &present] {
                        let (error, point) = self.descend_from(start, &chosen, SHORT)?;
                        grown.push(Subset { error, chosen: chosen.clone(), point });
                    }
                }
            }
            if grown.is_empty() || self.best.0 < NONE {
                break;
            }
            kept = self.nearest(grown);
        }
        Ok(())
    }

    /// The present values, but the others of a parameter's group in the middle of their ranges: the roughness of a coat shows only
    /// where there is a coat.
    fn amid(&self, parameter: usize) -> Point {
        let mut point = Point { numbers: self.present(), on: vec![false; self.free.len()] };
        let group = self.free[parameter].group;
        for (k, (owner, axis)) in self.owners().into_iter().enumerate() {
            if group.is_some() && owner != parameter && self.free[owner].group == group {
                point.on[owner] = true;
                point.numbers[k] = axis.value(0.5);
            }
        }
        point
    }

    /// The nearest of some subsets, one for each group of the parameter that was added last.
    fn nearest(&self, mut subsets: Vec<Subset>) -> Vec<Subset> {
        subsets.sort_by(|a, b| a.error.total_cmp(&b.error));
        let mut groups = Vec::new();
        subsets.retain(|subset| {
            let group = self.free[subset.chosen[0]].group;
            let is_new = group.is_none() || !groups.contains(&group);
            groups.push(group);
            is_new
        });
        subsets.truncate(BEAMS);
        subsets
    }

    /// All parameters, first those that promise most beside those of a subset, by the slope at its point.
    fn promises(&mut self, subset: &Subset) -> Result<Vec<usize>, Stop> {
        let all: Vec<usize> = (0..self.free.len()).collect();
        let owners = self.owners();
        let (at, here, columns) = self.slopes(&subset.point, &all)?;
        let slope = descent::Slope::of(&columns, &here);
        let ranges = vec![(0.0, 1.0); at.len()];
        let promise = |more: usize| {
            let moves = |owner: usize| owner == more || subset.chosen.contains(&owner);
            let axes: Vec<usize> = (0..at.len()).filter(|axis| moves(owners[*axis].0)).collect();
            slope.promise(&axes, &at, &ranges)
        };
        let mut others: Vec<_> = all.into_iter().map(|i| (promise(i), i)).collect();
        others.sort_by(|a, b| b.0.total_cmp(&a.0));
        Ok(others.into_iter().map(|(_, i)| i).collect())
    }

    /// The least and the greatest error for several values of a parameter, with the others as at `from`, and the point with the least.
    fn scan(&mut self, from: &Point, parameter: usize) -> Result<([f64; 2], Point), Stop> {
        let mut scratch = vec![0.0; self.count()];
        let first: usize = self.free[..parameter].iter().map(|free| free.axes.len()).sum();
        let axes = &self.free[parameter].axes;
        let mut best = ([f64::INFINITY, 0.0], from.clone());
        let [least, most] = SCANNED;
        let scanned = ((SCANS * self.most as f64) as usize / self.free.len()).clamp(least, most);
        for step in 0..=scanned {
            let mut point = from.clone();
            point.on[parameter] = true;
            // The first value is the present one.
            if let Some(step) = step.checked_sub(1) {
                let at = (step as f64 + 0.5) / scanned as f64;
                axes.iter().enumerate().for_each(|(k, axis)| point.numbers[first + k] = axis.value(at));
            }
            let error = self.noted(&point, &mut scratch)?;
            best.0[1] = error.max(best.0[1]);
            if error < best.0[0] {
                best.0[0] = error;
                best.1 = point;
            }
        }
        Ok(best)
    }

    /// Descends from the best so far, then in rounds from points spread over the ranges of small sets of parameters, with
    /// the others at their present values, and over those of all.
    fn spread_out(&mut self, all: &[usize]) -> Result<(), Stop> {
        if let Some(best) = self.best.1.clone() {
            "descending from the best so far".clone_into(&mut self.step);
            self.descend_from(&best, all, LIMITS)?;
        }
        let sets = self.sets();
        for round in 0.. {
            let before = self.best.0;
            for (i, set) in sets.iter().enumerate() {
                let number = round * sets.len() + i;
                self.step = format!("trying start {}", number + 1);
                let (error, point) = self.descend_spread(number, set)?;
                if set.len() < all.len() && error < PROMISING * self.best.0 {
                    let (error, point) = self.descend_from(&point, all, SHORT)?;
                    if error <= self.best.0 {
                        self.descend_from(&point, all, LIMITS)?;
                    }
                }
                if self.best.0 < NONE {
                    return Ok(());
                }
            }
            if self.best.0 >= HELPS * before {
                break;
            }
        }
        Ok(())
    }

    /// Small sets of parameters, and all: two of a group, alone and with the leaders, which are the parameters that change most in the
    /// two groups that change most. Those without effect in all that was tried are left out.
    fn sets(&self) -> Vec<Vec<usize>> {
        let [by_influence, ranked] = [&self.influence, &self.reach].map(|by| {
            let mut all: Vec<usize> =
                (0..self.free.len()).filter(|i| self.effect[*i] != (true, false)).collect();
            all.sort_by(|a, b| by[*b].total_cmp(&by[*a]));
            all
        });
        let group = |i: &usize| self.free[*i].group;
        let first = by_influence.first();
        let other = |i: &&usize| {
            first.is_some_and(|first| group(first) != group(i) || group(i).is_none() && first != *i)
        };
        let second = by_influence.iter().find(other);
        let leaders: Vec<usize> = first.into_iter().chain(second).copied().collect();
        // Each with its place among those of its group: no group waits for all sets of another.
        let mut placed: Vec<(usize, Vec<usize>)> = Vec::new();
        for i in &ranked {
            let mates: Vec<usize> = ranked.iter().copied().filter(|j| group(j) == group(i)).collect();
            let at = mates.iter().position(|j| j == i).unwrap_or(0);
            for (k, j) in mates[..at].iter().enumerate() {
                let place = 2 * (at * (at - 1) / 2 + k);
                // Alone their starts lie denser.
                placed.push((place, vec![*i, *j]));
                placed.push((place + 1, [&[*i, *j], &leaders[..]].concat()));
            }
            if mates.len() == 1 {
                placed.push((0, [&[*i], &leaders[..]].concat()));
            }
        }
        placed.sort_by_key(|(place, _)| *place);
        let mut sets: Vec<Vec<usize>> = placed.into_iter().map(|(_, set)| set).collect();
        sets.push((0..self.free.len()).collect());
        let mut known = std::collections::HashSet::new();
        for set in &mut sets {
            set.sort_unstable();
            set.dedup();
        }
        sets.retain(|set| known.insert(set.clone()));
        sets
    }

    /// Descends with some parameters from the nearest of points spread over their ranges.
    fn descend_spread(&mut self, number: usize, chosen: &[usize]) -> Result<(f64, Point), Stop> {
        let present = Point { numbers: self.present(), on: vec![false; self.free.len()] };
        let owners = self.owners();
        let axes: Vec<_> =
            owners.iter().enumerate().filter(|(_, (owner, _))| chosen.contains(owner)).collect();
        let mut scratch = vec![0.0; self.count()];
        let mut starts = Vec::new();
        for i in 0..SPREAD {
            let mut point = present.clone();
            chosen.iter().for_each(|i| point.on[*i] = true);
            for ((k, (_, axis)), at) in axes.iter().zip(spread(number * SPREAD + i, axes.len())) {
                point.numbers[*k] = axis.value(at);
            }
            starts.push((self.noted(&point, &mut scratch)?, point));
        }
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut best = (f64::INFINITY, present);
        for (_, start) in starts.iter().take(DESCENTS) {
            let found = self.descend_from(start, chosen, SHORT)?;
            if found.0 < best.0 {
                best = found;
            }
        }
        self.descend_from(&best.1, chosen, LIMITS)
    }

    /// Descends from a point, changing only these parameters. Returns the error and the final point.
    fn descend_from(
        &mut self,
        start: &Point,
        parameters: &[usize],
        limits: Limits,
    ) -> Result<(f64, Point), Stop> {
        let mut track = Track::new(self, start, parameters);
        let mut at = track.coordinates();
        let ranges = vec![(0.0, 1.0); at.len()];
        descend(&mut track, &mut at, &ranges, limits)?;
        let (error, point) = track.best;
        Ok((error, point.unwrap_or_else(|| start.clone())))
    }

    /// Moves each integer by one, as long as that helps.
    fn try_neighbours(&mut self) -> Result<(), Stop> {
        /// Maximum number of rounds; more seldom help.
        const ROUNDS: usize = 3;
        let mut scratch = vec![0.0; self.count()];
        let owners = self.owners();
        for _ in 0..ROUNDS {
            let before = self.best.0;
            for (i, (owner, axis)) in owners.iter().enumerate().filter(|(_, (_, axis))| axis.whole) {
                for step in [-1.0, 1.0] {
                    let Some(best) = self.best.1.as_ref().filter(|best| best.on[*owner]) else { continue };
                    let mut point = best.clone();
                    point.numbers[i] = axis.legal(point.numbers[i] + step);
                    if point.numbers != best.numbers {
                        self.noted(&point, &mut scratch)?;
                    }
                }
            }
            if self.best.0 >= before {
                break;
            }
        }
        Ok(())
    }

    /// The point with insignificant values dropped and the rest rounded; the error is at most `good`.
    fn simplified(&mut self, mut point: Point, good: f64, mut error: f64) -> Result<(Point, f64), Stop> {
        for i in 0..self.free.len() {
            let mut without = point.clone();
            without.on[i] = false;
            let there = self.error(&without)?;
            if there <= good {
                (point, error) = (without, there);
            }
        }
        for (at, (owner, axis)) in self.owners().into_iter().enumerate() {
            if axis.whole || !point.on[owner] {
                continue;
            }
            let number = point.numbers[at];
            let end = Some(axis.coordinate(number).round()).filter(|end| {
                // This close to an end of the range, the end itself may be the best value.
                (axis.coordinate(number) - end).abs() < 0.01
            });
            let shorter = (2..=6).map(|digits| axis.legal(rounded(number, digits)));
            for simpler in end.map(|end| axis.value(end)).into_iter().chain(shorter) {
                let mut shorter = point.clone();
                shorter.numbers[at] = simpler;
                let there = self.error(&shorter)?;
                if there <= good {
                    (point, error) = (shorter, there);
                    break;
                }
            }
        }
        Ok((point, error))
    }
}

/// A descent in which some of the axes vary and the others are fixed.
struct Track<'s, 'a, T> {
    of: &'s mut Search<'a, T>,
    /// The present point, including the fixed values.
    point: Point,
    /// The indices of the varying axes among all, in order.
    axes: Vec<(usize, &'a Axis)>,
    best: (f64, Option<Point>),
}

impl<'s, 'a, T: Target> Track<'s, 'a, T> {
    /// From a point, along the axes of some parameters, which are then set.
    fn new(of: &'s mut Search<'a, T>, start: &Point, parameters: &[usize]) -> Self {
        let varies = |(_, (owner, _)): &(usize, (usize, &Axis))| parameters.contains(owner);
        let axes =
            of.owners().into_iter().enumerate().filter(varies).map(|(i, (_, axis))| (i, axis)).collect();
        let mut point = start.clone();
        parameters.iter().for_each(|i| point.on[*i] = true);
        Self { of, point, axes, best: (f64::INFINITY, None) }
    }

    fn coordinates(&self) -> Vec<f64> {
        self.axes.iter().map(|(i, axis)| axis.coordinate(self.point.numbers[*i])).collect()
    }

    fn noted(&mut self, to: &mut [f64]) -> Result<(), Stop> {
        let error = self.of.noted(&self.point, to)?;
        if error < self.best.0 {
            self.best = (error, Some(self.point.clone()));
        }
        Ok(())
    }

    fn move_to(&mut self, point: &[f64]) {
        for ((i, axis), at) in self.axes.iter().zip(point) {
            self.point.numbers[*i] = axis.value(*at);
        }
    }
}

impl<T: Target> Residuals for Track<'_, '_, T> {
    fn count(&self) -> usize {
        self.of.count()
    }

    fn at(&mut self, point: &[f64], residuals: &mut [f64]) -> Result<(), Stop> {
        self.move_to(point);
        self.noted(residuals)
    }

    fn derivatives(
        &mut self,
        point: &[f64],
        residuals: &mut [f64],
        columns: &mut [Vec<f64>],
    ) -> Result<(), Stop> {
        self.move_to(point);
        self.noted(residuals)?;
        let owners = self.of.owners();
        for (k, column) in columns.iter_mut().enumerate() {
            let (i, axis) = self.axes[k];
            let here = self.point.numbers[i];
            self.point.numbers[i] = axis.beside(here);
            // Between legal values: integers are not continuous.
            let way = axis.coordinate(self.point.numbers[i]) - axis.coordinate(here);
            let ended = self.noted(column);
            self.point.numbers[i] = here;
            ended?;
            column.iter_mut().zip(&*residuals).for_each(|(to, from)| *to = (*to - from) / way);
            let effect = &mut self.of.effect[owners[i].0];
            *effect = (true, effect.1 || column.iter().any(|slope| *slope != 0.0));
        }
        Ok(())
    }
}

/// The i-th of a sequence of points spread evenly over a cube: M. Roberts (2018), *The Unreasonable
/// Effectiveness of Quasirandom Sequences*.
fn spread(i: usize, axes: usize) -> impl Iterator<Item = f64> {
    // The root of x^(d+1) = x + 1, by iteration.
    let ratio = (0..40).fold(2.0f64, |x, _| (1.0 + x).powf(1.0 / (axes as f64 + 1.0)));
    (1..=axes).map(move |axis| (0.5 + (i + 1) as f64 / ratio.powi(axis as i32)).fract())
}

/// A number rounded to this many significant digits.
fn rounded(value: f64, digits: i32) -> f64 {
    if value == 0.0 {
        return 0.0;
    }
    let scale = 10f64.powi(digits - 1 - value.abs().log10().floor() as i32);
    (value * scale).round() / scale
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameter::{ALPHA, K_A, K_D, K_S};

    /// A bell with an exponent and a height, above a floor that hides its foot; `k_a` has no effect.
    struct Bell {
        wanted: [f64; 2],
        asked: usize,
    }

    fn bell([alpha, height]: [f64; 2], i: usize) -> f64 {
        height * (0.02 * i as f64).cos().powf(alpha)
    }

    impl Target for Bell {
        fn count(&self) -> usize {
            60
        }

        fn differences(&mut self, values: &Given, to: &mut [f64]) {
            self.asked += 1;
            let get = |name: &str, now: f64| {
                values.iter().find(|(n, _)| *n == name).map_or(now, |(_, value)| value.numbers()[0])
            };
            let found = [get("alpha", 3.0), get("k_s", 0.9)];
            for (i, to) in to.iter_mut().enumerate() {
                *to = bell(found, i) - bell(self.wanted, i);
            }
        }
    }

    fn free(parameter: &'static Parameter, now: Value) -> Free {
        Free { parameter, axes: Axis::of(&[parameter], &now), now, group: None }
    }

    fn frees() -> Vec<Free> {
        vec![free(&K_A, Value::Number(0.1)), free(&K_S, Value::Number(0.9)), free(&ALPHA, Value::Integer(3))]
    }

    #[test]
    fn the_values_that_made_a_curve_are_found_and_others_keep_theirs() {
        for (alpha, height) in [(1, 0.25), (40, 0.7), (700, 0.05), (20_000, 1.0)] {
            let mut bell = Bell { wanted: [f64::from(alpha), height], asked: 0 };
            let found = Search::new(&mut bell, &frees(), 2000, &Progress::NONE).run().expect("not cancelled");
            let expected =
                vec![("k_s", Value::Number(height as f32)), ("alpha", Value::Integer(alpha.into()))];
            assert_eq!(found.values, expected, "{found:?}");
            assert!(found.after < 1e-4 * found.before && found.before > 1e-3, "{found:?}");
            assert!(bell.asked < 500, "{}", bell.asked);
        }
    }

    /// A line whose slope is the product of two parameters, beside one of another shape.
    struct Product;

    impl Target for Product {
        fn count(&self) -> usize {
            20
        }

        fn differences(&mut self, values: &Given, to: &mut [f64]) {
            let get = |name: &str, now: f64| {
                values.iter().find(|(n, _)| *n == name).map_or(now, |(_, value)| value.numbers()[0])
            };
            let (k_a, k_d, k_s) = (get("k_a", 0.1), get("k_d", 0.8), get("k_s", 0.9));
            for (i, to) in to.iter_mut().enumerate() {
                let x = i as f64 / 20.0;
                *to = (k_d * k_s - 0.36) * x + (k_a - 0.5) * x * x;
            }
        }
    }

    #[test]
    fn parameters_that_count_by_their_product_are_ambiguous_and_others_are_not() {
        let all =
            [free(&K_A, Value::Number(0.1)), free(&K_D, Value::Number(0.8)), free(&K_S, Value::Number(0.9))];
        let found = Search::new(&mut Product, &all, 2000, &Progress::NONE).run().expect("not cancelled");
        assert!(found.after < 1e-4, "{found:?}");
        assert_eq!(found.ambiguous, ["k_d", "k_s"], "{found:?}");
        let found = Search::new(&mut Product, &all[..2], 2000, &Progress::NONE).run().expect("not cancelled");
        assert_eq!(found.ambiguous, [""; 0], "{found:?}");
    }

    /// Two lines, one of them bent a little, and a rest that neither of them changes.
    struct Bent {
        rest: f64,
    }

    impl Target for Bent {
        fn count(&self) -> usize {
            20
        }

        fn differences(&mut self, values: &Given, to: &mut [f64]) {
            let get = |name: &str| {
                values.iter().find(|(n, _)| *n == name).map_or(0.5, |(_, value)| value.numbers()[0])
            };
            let [k_d, k_s] = ["k_d", "k_s"].map(get);
            for (i, to) in to.iter_mut().enumerate() {
                let (x, sign) = (i as f64 / 20.0, if i % 2 == 0 { 1.0 } else { -1.0 });
                let rest = if i % 4 < 2 { self.rest } else { -self.rest };
                *to = (k_d - 0.6) * x + (k_s - 0.6) * (x + 0.02 * sign) + rest;
            }
        }
    }

    #[test]
    fn what_the_rest_of_the_error_hides_is_ambiguous() {
        let all = [&K_D, &K_S].map(|parameter| free(parameter, Value::Number(0.5)));
        let ambiguous = |rest: f64| {
            let found = Search::new(&mut Bent { rest }, &all, 2000, &Progress::NONE).run();
            found.expect("not cancelled").ambiguous
        };
        // The bend is a thirtieth of the line.
        assert_eq!(ambiguous(0.0), [""; 0]);
        assert_eq!(ambiguous(0.05), ["k_d", "k_s"]);
    }

    /// Three differences: two parameters change one each, and the third both, and hardly anything of the last.
    struct Both;

    impl Target for Both {
        fn count(&self) -> usize {
            3
        }

        fn differences(&mut self, values: &Given, to: &mut [f64]) {
            let get = |name: &str| {
                values.iter().find(|(n, _)| *n == name).map_or(0.5, |(_, value)| value.numbers()[0])
            };
            let [k_a, k_d, k_s] = ["k_a", "k_d", "k_s"].map(get);
            let half = 0.5f64.sqrt();
            to[0] = k_a - 0.3 + half * (k_s - 0.7);
            // Its range is half as long.
            to[1] = 2.0 * (k_d - 0.8) + half * (k_s - 0.7);
            to[2] = 0.008 * (k_s - 0.7);
        }
    }

    #[test]
    fn no_parameter_is_ambiguous_alone() {
        let all = [&K_A, &K_D, &K_S].map(|parameter| free(parameter, Value::Number(0.5)));
        let found = Search::new(&mut Both, &all, 2000, &Progress::NONE).run().expect("not cancelled");
        // Of k_s less than a hundredth is left, of the others a little more.
        assert_eq!(found.ambiguous, ["k_a", "k_d", "k_s"], "{found:?}");
    }

    /// The same with values of one half, and a difference that none of them changes.
    struct Rest;

    impl Target for Rest {
        fn count(&self) -> usize {
            20
        }

        fn differences(&mut self, values: &Given, to: &mut [f64]) {
            let get = |name: &str| {
                values.iter().find(|(n, _)| *n == name).map_or(0.5, |(_, value)| value.numbers()[0])
            };
            let (k_a, k_d, k_s) = (get("k_a"), get("k_d"), get("k_s"));
            for (i, to) in to.iter_mut().enumerate() {
                let x = i as f64 / 20.0;
                *to = (k_d * k_s - 0.25) * x + (k_a - 0.5) * x * x;
            }
            to[0] = 1.0;
        }
    }

    #[test]
    fn values_that_stay_may_be_ambiguous() {
        let all = [&K_A, &K_D, &K_S].map(|parameter| free(parameter, Value::Number(0.5)));
        let found = Search::new(&mut Rest, &all, 2000, &Progress::NONE).run().expect("not cancelled");
        assert_eq!((&found.values, &found.ambiguous), (&Vec::new(), &vec!["k_d", "k_s"]), "{found:?}");
    }

    #[test]
    fn nothing_changes_where_nothing_comes_nearer() {
        let mut bell = Bell { wanted: [3.0, 0.9], asked: 0 };
        let found = Search::new(&mut bell, &frees(), 2000, &Progress::NONE).run().expect("not cancelled");
        assert_eq!((found.values, found.before, found.after), (Vec::new(), 0.0, 0.0));
        assert_eq!((found.without_effect, found.evaluations), (Vec::new(), 1), "nothing was tried");
        // Only parameters without effect are free.
        let mut bell = Bell { wanted: [30.0, 0.5], asked: 0 };
        let k_a = [free(&K_A, Value::Number(0.1)), free(&K_D, Value::Number(0.8))];
        let found = Search::new(&mut bell, &k_a, 2000, &Progress::NONE).run().expect("not cancelled");
        assert_eq!((found.values, found.before), (Vec::new(), found.after));
        assert_eq!((found.without_effect, found.ended), (vec!["k_a", "k_d"], Ended::Itself));
    }

    #[test]
    fn the_number_of_evaluations_is_bounded_and_the_best_of_them_counts() {
        let mut bell = Bell { wanted: [700.0, 0.05], asked: 0 };
        let found = Search::new(&mut bell, &frees(), 30, &Progress::NONE).run().expect("not cancelled");
        assert!(found.after < found.before, "{found:?}");
        assert!(bell.asked < 60, "{}", bell.asked);
        assert_eq!((found.evaluations, found.ended), (bell.asked, Ended::Evaluations));
        let again = Search::new(&mut Bell { asked: 0, ..bell }, &frees(), 30, &Progress::NONE).run();
        assert_eq!(again.expect("not cancelled"), found, "to the bit");
    }

    #[test]
    fn a_search_cancelled_at_any_step_gives_the_best_so_far() {
        let search = |most: usize| {
            let asked = std::cell::Cell::new(0);
            let cancelled = || {
                asked.set(asked.get() + 1);
                asked.get() > most
            };
            let progress = Progress { tell: &|_, _| (), cancelled: &cancelled };
            let mut bell = Bell { wanted: [700.0, 0.05], asked: 0 };
            let found = Search::new(&mut bell, &frees(), 2000, &progress).run();
            (found, bell.asked)
        };
        assert_eq!(search(0), (Err(Cancelled), 0), "there is nothing yet");
        let (whole, all) = search(usize::MAX);
        let whole = whole.expect("not cancelled");
        assert_ne!(whole.ended, Ended::Interrupted);
        let mut least = f64::INFINITY;
        for most in [1, 10, 40, all - 1] {
            let (found, asked) = search(most);
            let found = found.expect("the best so far");
            assert_eq!((asked, found.ended), (most, Ended::Interrupted), "nothing is tried after that");
            assert_eq!(found.before, whole.before);
            assert!(
                found.after <= least * (1.0 + GIVEN_UP[0]) + GIVEN_UP[1] * found.before,
                "{most}: {found:?}"
            );
            least = found.after;
            // The last ones only tell what is ambiguous.
            let same = (&found.values, found.after) == (&whole.values, whole.after);
            assert_eq!(same, most == all - 1, "{most}: {found:?}");
        }
    }

    #[test]
    fn numbers_are_rounded_to_digits() {
        assert_eq!([rounded(0.0, 2), rounded(0.03468, 2), rounded(123.4, 2)], [0.0, 0.035, 120.0]);
    }
}
