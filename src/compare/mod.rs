//! Comparing pictures: layouts of several views, maps of the difference between two, and numbers for it.
//!
//! ```
//! use lights_camera_models::{
//!     compare::{Pair, Shown},
//!     reference::Settings,
//!     registry::Registry,
//!     scene::{Comparison, Scene, Variant},
//! };
//! let phong = Variant { reflection_model: Some("phong".to_owned()), ..Variant::default() };
//! let scene = Scene { variants: vec![phong], ..Scene::default() };
//! let (registry, settings) = (Registry::builtin(), Settings { width: 64, height: 36, ..Settings::default() });
//! let [a, b] = [0, 1].map(|view| Shown::of_view(&scene, view, &registry, &settings).expect("there is one"));
//! let pair = Pair::new(&a, &b).expect("both have the same size");
//! let numbers = pair.measure().expect("there are pixels").all;
//! assert!(numbers.of("rmse") > Some(0.0) && numbers.of("ssim") < Some(1.0));
//! let map = pair.map(&Comparison::default()).expect("codes are always known");
//! assert_eq!(map.len(), 64 * 36 * 3);
//! ```

mod canvas;
mod channel;
mod colours;
mod drawn;
mod labels;
mod layout;
mod legend;
mod map;
pub mod metric;
mod pair;
mod shown;
mod words;

pub use channel::with_legends;
pub use drawn::{Undrawn, View};
pub use labels::with_row_labels;
pub use layout::{Cell, cells, compose, edge, size_around};
pub use legend::{fitting_amplification, legend_alone, short};
pub use metric::{Measured, Metric, Metrics, PIXELS_PER_DEGREE};
pub use pair::{Differences, Largest, Pair, Unequal};
pub use shown::{Shown, WrongSize};
pub use words::numbers;
