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
//! assert!(numbers.rmse > 0.0 && numbers.ssim < 1.0);
//! let map = pair.map(&Comparison::default()).expect("codes are always known");
//! assert_eq!(map.len(), 64 * 36 * 3);
//! ```

mod canvas;
mod channel;
mod colours;
mod filter;
mod flip;
mod layout;
mod legend;
mod map;
mod metrics;
mod pair;
mod power;
mod shown;
mod ssim;

pub use channel::with_legends;
pub use flip::PIXELS_PER_DEGREE;
pub use layout::{Cell, cells, compose, edge, size_around};
pub use legend::{fitting_amplification, short};
pub use metrics::{Measured, Metrics};
pub use pair::{Differences, Largest, Pair, Unequal};
pub use shown::{Shown, WrongSize};
