//! The numbers for the difference between two pictures: each is declared in a file of its own, and named in [`ALL`].

mod filter;
mod flip;
mod largest;
mod light_rmse;
mod measure;
mod power;
mod psnr;
mod rmse;
mod ssim;

use super::pair::Largest;

pub use filter::{TILE, Tile};
pub use flip::PIXELS_PER_DEGREE;
pub use measure::{Measured, Metrics, Place};

/// Every metric, in the order of presentation.
pub static ALL: [&Metric; 6] =
    [&rmse::METRIC, &psnr::METRIC, &ssim::METRIC, &flip::METRIC, &largest::METRIC, &light_rmse::METRIC];

/// A number for the difference between two pictures.
#[derive(Debug)]
#[non_exhaustive]
pub struct Metric {
    /// The name in limits of the command line and in its JSON.
    pub id: &'static str,
    /// True if it is larger where pictures are more alike.
    pub of_likeness: bool,
    /// The source of the number.
    pub way: Way,
    /// The way in which the window shows it; `None` if it does not, or shows more than the number.
    pub shown: Option<InWindow>,
    /// The row of the documents' table: what it is, its range, and that of equal pictures; `None` for none.
    pub row: Option<[&'static str; 3]>,
}

/// The source of a metric.
#[derive(Debug)]
pub enum Way {
    /// A number of each pixel: the function makes the metric from their sum and the number of pixels.
    Pixels(&'static Pixels, fn(f64, f64) -> f64),
    /// The largest difference in the channel and the values of a comparison, over all pixels.
    Largest(fn(&Largest) -> f64),
}

/// A number of each pixel, on which metrics rest.
#[derive(Debug)]
pub struct Pixels {
    /// The numbers where the display codes are equal, with everything around that filters reach. `None` if they rest on
    /// light: then there is no metric where a picture has none. The others have none where a picture has no codes.
    pub where_equal: Option<f32>,
    /// A function with the memory that it needs; there is one for each thread.
    pub measure: fn() -> Measure,
}

/// Calculates the numbers of a tile's pixels. Beyond the picture they do not matter.
pub type Measure = Box<dyn FnMut(&Place<'_>, &mut Tile) + Send>;

/// A metric as the window shows it, over the pixels that objects cover.
#[derive(Debug)]
pub struct InWindow {
    /// The rank of the metric: in a narrow space, metrics with the largest places are omitted.
    pub place: usize,
    /// The display name.
    pub name: &'static str,
    /// The number for people.
    pub text: fn(f64) -> String,
    /// The tooltip, from the letter of the view compared with A and the number over all pixels.
    pub help: fn(&str, f64) -> String,
}

impl Metric {
    /// A metric of another crate: [`Pair::measure_by`](super::Pair::measure_by) calculates it.
    #[must_use]
    pub const fn new(id: &'static str, way: Way) -> Self {
        Self { id, of_likeness: false, way, shown: None, row: None }
    }

    /// The metric with an id.
    #[must_use]
    pub fn from_id(id: &str) -> Option<&'static Self> {
        ALL.into_iter().find(|metric| metric.id == id)
    }

    /// The ids of those that are larger where pictures are more alike, or of the others.
    pub fn ids(of_likeness: bool) -> impl Iterator<Item = &'static str> {
        ALL.into_iter().filter(move |metric| metric.of_likeness == of_likeness).map(|metric| metric.id)
    }
}

/// The metrics that the window shows, each with its id, in the order in which it shows them.
#[must_use]
pub fn in_window() -> Vec<(&'static str, &'static InWindow)> {
    let mut known: Vec<_> = ALL.iter().filter_map(|m| Some((m.id, m.shown.as_ref()?))).collect();
    known.sort_by_key(|(_, metric)| metric.place);
    known
}

/// The names of those metrics.
#[must_use]
pub fn names_in_window() -> Vec<&'static str> {
    in_window().into_iter().map(|(_, metric)| metric.name).collect()
}

/// A number with three digits after the point.
fn in_thousandths(number: f64) -> String {
    format!("{number:.3}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_and_places_tell_metrics_apart() {
        for (i, metric) in ALL.into_iter().enumerate() {
            assert!(std::ptr::eq(metric, Metric::from_id(metric.id).expect("it is known")));
            let place = metric.shown.as_ref().map(|shown| shown.place);
            let others = || ALL[..i].iter().filter_map(|other| other.shown.as_ref());
            assert!(others().all(|other| Some(other.place) != place), "{}", metric.id);
        }
        assert!(Metric::from_id("rms").is_none());
    }
}
