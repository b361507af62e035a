//! The pictures of views.

use thiserror::Error;

use crate::{
    optics::TermSelection,
    reference::{self, Picture, Settings},
    registry::Registry,
    scene::{Display, Scene},
};

/// The picture of a view.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    width: u32,
    height: u32,
    rgb8: Vec<u8>,
    light: Option<Picture>,
    covered: Option<Vec<bool>>,
    outlines: Option<Vec<bool>>,
    /// True if the codes only make light visible, and say nothing of a display.
    is_linear: bool,
}

/// A number of bytes, or of pixels, that does not match the size of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("{found} bytes or pixels do not match a picture of {width} × {height} pixels")]
pub struct WrongSize {
    /// The width, pixels.
    pub width: u32,
    /// The height, pixels.
    pub height: u32,
    /// The number found.
    pub found: usize,
}

impl Shown {
    /// A picture of display codes: red, green, blue, row by row from the top. The light and the coverage by objects are
    /// unknown.
    ///
    /// # Errors
    /// Returns an error if there are not `width · height · 3` codes.
    pub fn of_codes(width: u32, height: u32, rgb8: Vec<u8>) -> Result<Self, WrongSize> {
        let pixels = width as usize * height as usize;
        if rgb8.len() != 3 * pixels {
            return Err(WrongSize { width, height, found: rgb8.len() / 3 });
        }
        Ok(Self::with_codes([width, height], rgb8))
    }

    /// A picture of as many display codes as it has.
    pub(super) fn with_codes([width, height]: [u32; 2], rgb8: Vec<u8>) -> Self {
        Self { width, height, rgb8, light: None, covered: None, outlines: None, is_linear: false }
    }

    /// Adds which pixels are covered by objects.
    ///
    /// # Errors
    /// Returns an error if the number of pixels is wrong.
    pub fn covering(mut self, covered: Vec<bool>) -> Result<Self, WrongSize> {
        if covered.len() * 3 != self.rgb8.len() {
            return Err(WrongSize { width: self.width, height: self.height, found: covered.len() });
        }
        self.covered = Some(covered);
        Ok(self)
    }

    /// Adds which pixels the objects of the scene that it shows cover with this number of samples, unless that is
    /// known: the GPU renderer, for one, does not tell.
    #[must_use]
    pub fn covering_objects(mut self, scene: &Scene, registry: &Registry, samples: u32) -> Self {
        let (width, height) = (self.width, self.height);
        let settings = Settings { width, height, samples, terms: TermSelection::All };
        self.covered.get_or_insert_with(|| reference::covered(scene, registry, &settings));
        self
    }

    /// Adds the pixels that objects cover in a picture of the same size, which shows the same bodies from the same
    /// place, unless they are known.
    #[must_use]
    pub fn covering_like(mut self, other: &Self) -> Self {
        if self.covered.is_none() && self.size() == other.size() {
            self.covered.clone_from(&other.covered);
        }
        self
    }

    /// Adds the light, which also determines the covered pixels.
    ///
    /// # Errors
    /// Returns an error if the light has another size.
    pub fn with_light(mut self, light: Picture) -> Result<Self, WrongSize> {
        if (light.width, light.height) != (self.width, self.height) {
            return Err(WrongSize { width: self.width, height: self.height, found: light.pixels.len() });
        }
        self.covered = Some(light.pixels.iter().map(|pixel| pixel.w > 0.0).collect());
        self.light = Some(light);
        Ok(self)
    }

    /// A picture of light, as displayed.
    #[must_use]
    pub fn of_light(light: Picture, display: &Display) -> Self {
        let (width, height, rgb8) = (light.width, light.height, light.to_rgb8(display));
        let covered = light.pixels.iter().map(|pixel| pixel.w > 0.0).collect();
        let light = Some(light);
        Self { width, height, rgb8, light, covered: Some(covered), outlines: None, is_linear: false }
    }

    /// A picture of light that no display has shown, from a linear file. `covers` is true if its fourth numbers are
    /// coverage. It has no display codes to compare; [`rgb8`](Self::rgb8) shows it at 0 EV without tone mapping.
    #[must_use]
    pub fn linear(light: Picture, covers: bool) -> Self {
        let shown = Self::of_light(light, &Display::default());
        Self { covered: shown.covered.filter(|_| covers), is_linear: true, ..shown }
    }

    /// A linear picture as these settings show it; any other as it is.
    #[must_use]
    pub fn shown_by(mut self, display: &Display) -> Self {
        if let Some(light) = self.light.as_ref().filter(|_| self.is_linear) {
            self.rgb8 = light.to_rgb8(display);
        }
        self
    }

    /// True if the display codes are those of a display, so that they can be compared.
    #[must_use]
    pub fn has_codes(&self) -> bool {
        !self.is_linear
    }

    /// A view of a scene, drawn by the CPU renderer; view 0 is the scene itself. The terms of `settings` are
    /// shown unless all are selected: then those of the view. `None` if the view does not exist.
    #[must_use]
    pub fn of_view(scene: &Scene, view: usize, registry: &Registry, settings: &Settings) -> Option<Self> {
        let (seen, own) = scene.seen(view, registry)?;
        let terms = if settings.terms == TermSelection::All { own } else { settings.terms };
        let light = reference::render(&seen, registry, &Settings { terms, ..*settings });
        Some(Self::of_light(light, &seen.display))
    }

    /// Adds the outlines of the objects in a scene, for a map of differences.
    #[must_use]
    pub fn outlined(mut self, scene: &Scene, registry: &Registry) -> Self {
        self.outlines = Some(reference::outlines(scene, registry, self.size()));
        self
    }

    /// True for each pixel at the edge of an object, if known.
    pub(super) fn outlines(&self) -> Option<&[bool]> {
        self.outlines.as_deref()
    }

    /// The width and height, pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// The display codes: red, green, blue, row by row from the top.
    #[must_use]
    pub fn rgb8(&self) -> &[u8] {
        &self.rgb8
    }

    /// The display codes, consuming the picture.
    #[must_use]
    pub fn into_rgb8(self) -> Vec<u8> {
        self.rgb8
    }

    /// The light, if known: linear, before exposure; 0 for the background.
    #[must_use]
    pub fn light(&self) -> Option<&Picture> {
        self.light.as_ref()
    }

    /// True for each pixel with at least one sample covered by objects, if known.
    #[must_use]
    pub fn covered(&self) -> Option<&[bool]> {
        self.covered.as_deref()
    }
}
