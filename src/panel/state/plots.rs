//! The choices of the plots. They belong to the session, not to the scene: a file of a scene has none of them.

use std::path::PathBuf;

use super::{Effect, Session, Severity};
use crate::files::Shown as _;
use crate::{
    curves::{Channel, Kind, Style, draw::Line},
    document::Selection,
    files,
    optics::colour::Encoding,
    parameter::Values,
    scene::{Object, Scene},
};

/// The largest angle of the light, degrees: at 90° it is in the surface.
pub const MOST_LIGHT: f64 = 89.0;

/// A curve of the plots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Slot {
    /// That of the selected object, as it is now.
    Live,
    /// One that was pinned or laid over, by its number.
    Pin(u64),
}

/// What a curve that was pinned is of.
#[derive(Clone, Debug, PartialEq)]
pub enum Of {
    /// A model with its parameters.
    Model {
        /// Its id.
        id: String,
        /// Its parameters.
        values: Values,
        /// The meaning of colours.
        encoding: Encoding,
    },
    /// Measured data, by name.
    Measured(String),
}

/// A curve that stays.
#[derive(Clone, Debug, PartialEq)]
pub struct PinnedCurve {
    /// No other has it.
    pub number: u64,
    /// What it is of.
    pub of: Of,
    /// False if it is in the list only.
    pub shown: bool,
    /// Its colour and its dash.
    pub style: Style,
}

/// The choices of the plots.
#[derive(Clone, Debug, PartialEq)]
pub struct Plots {
    /// The quantity.
    pub kind: Kind,
    /// The angle between light and normal, degrees.
    pub theta_i: f64,
    /// The azimuth of the plane from the tangent, degrees.
    pub phi_i: f64,
    /// The channel; for curves luminance and for slices colour if there is none.
    pub channel: Option<Channel>,
    /// True for a logarithmic axis.
    pub log: bool,
    /// True if the curve of the selected object is shown.
    pub live: bool,
    /// Its colour and its dash.
    pub live_style: Style,
    /// The curves that stay.
    pub pins: Vec<PinnedCurve>,
    next: u64,
}

impl Default for Plots {
    fn default() -> Self {
        Self {
            kind: Kind::Polar,
            theta_i: 45.0,
            phi_i: 0.0,
            channel: None,
            log: false,
            live: true,
            live_style: Style::nth(0),
            pins: Vec::new(),
            next: 0,
        }
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

/// A command about the plots.
#[derive(Clone, Debug, PartialEq)]
pub enum PlotCommand {
    /// See [`Plots::kind`].
    Kind(Kind),
    /// See [`Plots::theta_i`]; brought into its range.
    Light(f64),
    /// See [`Plots::phi_i`].
    Azimuth(f64),
    /// See [`Plots::channel`].
    Channel(Option<Channel>),
    /// See [`Plots::log`].
    Log(bool),
    /// Shows a curve or hides it.
    Show(Slot, bool),
    /// Gives a curve a colour and a dash.
    Style(Slot, Style),
    /// Keeps the curve of the selected object as it is now.
    Pin,
    /// Lays a curve over.
    Add(Of),
    /// Removes a curve that stays.
    Remove(u64),
    /// Choose a file for the plot.
    Dialog,
    /// Write the plot to a file.
    To(PathBuf),
}

impl Session {
    /// The object whose model the plots show, in the active view: the selected one, or the first that is visible.
    #[must_use]
    pub fn plotted(&self) -> Option<(&Scene, &Object)> {
        let scene = self.scene();
        let selected = match self.selection {
            Selection::Object(i) => scene.objects.get(i),
            _ => None,
        };
        selected.or_else(|| scene.shown().next()).map(|object| (scene, object))
    }

    /// The model of that object, with its parameters.
    #[must_use]
    pub fn plotted_model(&self) -> Option<Of> {
        let (scene, object) = self.plotted()?;
        Some(Of::Model {
            id: scene.model_of(object).to_owned(),
            values: object.material.clone(),
            encoding: scene.display.encoding,
        })
    }

    pub(super) fn plot(&mut self, command: PlotCommand) -> Vec<Effect> {
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
            PlotCommand::Dialog => return vec![Effect::PickPlot],
            PlotCommand::To(path) => return vec![Effect::WritePlot(path)],
        }
        Vec::new()
    }

    /// Says how writing a plot ended: the notes on it, or why there is no file.
    pub fn plot_written(&mut self, path: PathBuf, outcome: Result<Vec<String>, String>) {
        match outcome {
            Ok(notes) => {
                notes.into_iter().for_each(|note| self.say(Severity::Info, note));
                self.note_file(format!("The plot was written to {}.", path.shown()), files::folder_of(&path));
            }
            Err(why) => self.say(Severity::Error, format!("The plot was not written: {why}.")),
        }
    }
}
