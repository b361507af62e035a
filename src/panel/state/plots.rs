//! Display options of the plots. They belong to the session and are not stored in scene files.

use std::path::PathBuf;

use super::{Session, Severity};
use crate::{
    curves::{Channel, Kind, Style, draw::Line},
    declared::with_defaults,
    document::Selection,
    files::Shown as _,
    optics::colour::Encoding,
    parameter::Values,
    scene::{Object, Scene},
};

/// Maximum angle of the light, in degrees: at 90° it would graze the surface.
pub const MOST_LIGHT: f64 = 89.0;

/// A curve of the plots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Slot {
    /// The current curve of the selected object.
    Live,
    /// A pinned or added curve, by its number.
    Pin(u64),
}

/// The subject of a pinned curve.
#[derive(Clone, Debug, PartialEq)]
pub enum Of {
    /// A model with its parameters.
    Model {
        /// Id of the model.
        id: String,
        /// Values of the parameters.
        values: Values,
        /// Encoding of colours.
        encoding: Encoding,
    },
    /// Measured data, by name.
    Measured(String),
}

/// A pinned or added curve.
#[derive(Clone, Debug, PartialEq)]
pub struct PinnedCurve {
    /// Unique number of the curve.
    pub number: u64,
    /// Subject of the curve.
    pub of: Of,
    /// False if the curve only appears in the list.
    pub shown: bool,
    /// Colour and dash pattern.
    pub style: Style,
}

with_defaults! {
    /// Display options of the plots.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Plots {
        /// The plotted quantity.
        pub kind: Kind = Kind::Polar,
        /// Angle between light and normal, in degrees.
        pub theta_i: f64 = 45.0,
        /// Azimuth of the plane from the tangent, in degrees.
        pub phi_i: f64 = 0.0,
        /// The channel; `None` for luminance in curves and for colour in slices.
        pub channel: Option<Channel> = None,
        /// True for a logarithmic axis.
        pub log: bool = false,
        /// True if the curve of the selected object is shown.
        pub live: bool = true,
        /// Colour and dash pattern of that curve.
        pub live_style: Style = Style::nth(0),
        /// Pinned and added curves.
        pub pins: Vec<PinnedCurve> = Vec::new(),
        next: u64 = 0,
    }
}

impl Plots {
    fn add(&mut self, of: Of) {
        let used: Vec<_> = self.pins.iter().map(|pin| pin.style).chain([self.live_style]).map(pair).collect();
        let free = (0..24).map(Style::nth).find(|style| !used.contains(&pair(*style)));
        let style = free.unwrap_or_else(|| Style::nth(self.pins.len() + 1));
        self.pins.push(PinnedCurve { number: self.next, of, shown: true, style });
        self.next += 1;
    }

    fn pin(&mut self, slot: Slot) -> Option<&mut PinnedCurve> {
        self.pins.iter_mut().find(|pin| Slot::Pin(pin.number) == slot)
    }
}

fn pair(style: Style) -> (usize, &'static [f64]) {
    (style.colour, Line::dash(style.line))
}

/// A command for the plots.
#[derive(Clone, Debug, PartialEq)]
pub enum PlotCommand {
    /// See [`Plots::kind`].
    Kind(Kind),
    /// See [`Plots::theta_i`]; clamped to its range.
    Light(f64),
    /// See [`Plots::phi_i`].
    Azimuth(f64),
    /// See [`Plots::channel`].
    Channel(Option<Channel>),
    /// See [`Plots::log`].
    Log(bool),
    /// Show or hide a curve.
    Show(Slot, bool),
    /// Set the colour and dash pattern of a curve.
    Style(Slot, Style),
    /// Pin the current curve of the selected object.
    Pin,
    /// Add a curve.
    Add(Of),
    /// Remove a pinned or added curve.
    Remove(u64),
}

impl Session {
    /// The object whose model is plotted, in the active view: the selected one, or the first visible one.
    #[must_use]
    pub fn plotted(&self) -> Option<(&Scene, &Object)> {
        let scene = self.scene();
        let selected = match self.selection {
            Selection::Object(i) => scene.objects.get(i),
            _ => None,
        };
        selected.or_else(|| scene.shown().next()).map(|object| (scene, object))
    }

    /// The model of the plotted object, with its parameters.
    #[must_use]
    pub fn plotted_model(&self) -> Option<Of> {
        let (scene, object) = self.plotted()?;
        Some(Of::Model {
            id: scene.model_of(object).to_owned(),
            values: object.material.clone(),
            encoding: scene.display.encoding,
        })
    }

    pub(super) fn plot(&mut self, command: PlotCommand) {
        let plots = &mut self.plots;
        match command {
            PlotCommand::Kind(kind) => plots.kind = kind,
            PlotCommand::Light(angle) if angle.is_finite() => plots.theta_i = angle.clamp(0.0, MOST_LIGHT),
            PlotCommand::Azimuth(angle) if angle.is_finite() => plots.phi_i = angle,
            PlotCommand::Light(_) | PlotCommand::Azimuth(_) => {}
            PlotCommand::Channel(channel) => plots.channel = channel,
            PlotCommand::Log(log) => plots.log = log,
            PlotCommand::Show(Slot::Live, shown) => plots.live = shown,
            PlotCommand::Show(slot, shown) => plots.pin(slot).into_iter().for_each(|pin| pin.shown = shown),
            PlotCommand::Style(Slot::Live, style) => plots.live_style = style,
            PlotCommand::Style(slot, style) => plots.pin(slot).into_iter().for_each(|pin| pin.style = style),
            PlotCommand::Pin => match self.plotted_model() {
                Some(of) => self.plots.add(of),
                None => self.say(Severity::Info, "There is no object whose curve could be pinned."),
            },
            PlotCommand::Add(of) => plots.add(of),
            PlotCommand::Remove(number) => plots.pins.retain(|pin| pin.number != number),
        }
    }

    /// Reports the result of saving a plot: its notes, or why it failed.
    pub fn plot_written(&mut self, path: PathBuf, outcome: Result<Vec<String>, String>) {
        match outcome {
            Ok(notes) => {
                self.note_written(notes, format!("The plot was written to {}.", path.shown()), &path);
            }
            Err(why) => self.say(Severity::Error, format!("The plot was not written: {why}.")),
        }
    }
}
