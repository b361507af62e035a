//! Requests of the plots: the curves, each with everything that is needed to calculate it.

use crate::{
    curves::{
        Channel, Curve, CurveError, Detail, Form, Kind, Setup, Sheet, Slice, Style, Subject, curve, slice,
        subjects_with,
    },
    optics::colour::Encoding,
    panel::{
        prelude::*,
        state::{Of, Slot},
    },
    parameter::{NamedFile, Value, Values},
    progress::Progress,
    reflection::ModelEntry,
    text::listed,
};

/// The plot that is wanted.
#[derive(Clone)]
pub struct Request {
    /// The quantity and the angles.
    pub setup: Setup,
    /// The channel.
    pub channel: Option<Channel>,
    /// True for a logarithmic axis.
    pub log: bool,
    /// The curves in the order of the list, also those that are hidden.
    pub entries: Vec<Entry>,
}

/// A curve of a plot.
#[derive(Clone)]
pub struct Entry {
    /// The place in the list.
    pub slot: Slot,
    /// False if it is in the list only.
    pub shown: bool,
    /// The colour and its dash.
    pub style: Style,
    /// Equal keys have equal curves.
    pub key: Key,
    /// The source of its values.
    pub recipe: Recipe,
}

/// The inputs of a curve besides quantity and angles.
#[derive(Clone, Debug, PartialEq)]
pub struct Key {
    of: Of,
    /// The version of its model.
    version: Option<u64>,
}

/// The source of the values of a curve.
#[derive(Clone)]
pub enum Recipe {
    /// A model with its parameters.
    Model(ModelEntry, Values, Encoding),
    /// Measured data, by name.
    Measured(String),
    /// A model that nobody knows, by its id.
    Unknown(String),
}

/// A curve or a slice.
#[derive(Clone, Debug, PartialEq)]
pub enum Drawn {
    /// A curve.
    Curve(Curve),
    /// A slice.
    Slice(Slice),
}

impl Drawn {
    /// The name in the legend.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Curve(curve) => &curve.name,
            Self::Slice(slice) => &slice.name,
        }
    }
}

/// The reason why there is no curve.
#[derive(Clone, Debug, PartialEq)]
pub enum NoCurve {
    /// The request was cancelled.
    Cancelled,
    /// A sentence without its point.
    Because(String),
}

impl Recipe {
    /// The name of what it is of, as far as it is known before anything is calculated.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Model(entry, ..) => entry.declaration.name.to_owned(),
            Self::Measured(id) | Self::Unknown(id) => id.replace(['_', '-'], " "),
        }
    }

    /// Calculates it. `registry` knows the models that have what this one lacks.
    ///
    /// # Errors
    /// Returns an error if the curve does not exist, or if nobody wants it any more.
    pub fn draw(
        &self,
        setup: &Setup,
        detail: Detail,
        registry: Option<&Registry>,
        progress: &Progress,
    ) -> Result<Drawn, NoCurve> {
        let subject = match self {
            Self::Model(entry, values, encoding) => Subject::model(entry, values, *encoding),
            Self::Measured(id) => Subject::measured(id).map_err(NoCurve::Because)?,
            Self::Unknown(id) => {
                return Err(NoCurve::Because(format!("There is no reflection model “{id}”")));
            }
        };
        let made = match setup.kind.declaration().form {
            Form::Slices => slice(&subject, setup, detail, progress).map(Drawn::Slice),
            Form::Plot | Form::Polar => curve(&subject, setup, detail, progress).map(Drawn::Curve),
        };
        made.map_err(|error| match error {
            CurveError::Cancelled(_) => NoCurve::Cancelled,
            CurveError::NoFactor { .. } => {
                let known = registry.map(|registry| with(setup.kind, registry)).unwrap_or_default();
                NoCurve::Because(format!("{error}{known}"))
            }
            error => NoCurve::Because(error.to_string()),
        })
    }
}

/// The models that have curves of a kind, in words.
fn with(kind: Kind, registry: &Registry) -> String {
    /// The most that are named.
    const NAMED: usize = 6;
    let ids = subjects_with(kind, registry);
    let names = ids.iter().filter_map(|id| registry.model(id)).map(|model| model.declaration.name);
    let mut names: Vec<_> = names.take(NAMED).map(str::to_owned).collect();
    if ids.len() > names.len() {
        names.push(format!("{} others", ids.len() - names.len()));
    }
    if names.is_empty() { String::new() } else { format!(". Models with one: {}", listed(&names, "and")) }
}

impl Entry {
    fn new(slot: Slot, of: &Of, shown: bool, style: Style, registry: &Registry) -> Self {
        let recipe = match of {
            Of::Measured(id) => Recipe::Measured(id.clone()),
            Of::Model { id, values, encoding } => match registry.model(id) {
                Some(entry) => Recipe::Model(entry.clone(), values.clone(), *encoding),
                None => Recipe::Unknown(id.clone()),
            },
        };
        let version = match &recipe {
            Recipe::Model(entry, ..) => Some(entry.version()),
            _ => None,
        };
        Self { slot, shown, style, key: Key { of: of.clone(), version }, recipe }
    }
}

impl Request {
    /// The plot that the session asks for.
    #[must_use]
    pub fn of(session: &Session, registry: &Registry) -> Self {
        let plots = &session.plots;
        let live = session.plotted_model();
        let live = live.iter().map(|of| Entry::new(Slot::Live, of, plots.live, plots.live_style, registry));
        let pins = plots
            .pins
            .iter()
            .map(|pin| Entry::new(Slot::Pin(pin.number), &pin.of, pin.shown, pin.style, registry));
        Self {
            // The session keeps the angles legal.
            setup: Setup { kind: plots.kind, theta_i: plots.theta_i, phi_i: plots.phi_i },
            channel: plots.channel,
            log: plots.log,
            entries: live.chain(pins).collect(),
        }
    }

    /// The angles that matter to the quantity: curves that differ in others are the same.
    #[must_use]
    pub fn calculated(&self) -> Setup {
        let Setup { kind, theta_i, phi_i } = self.setup;
        Setup {
            kind,
            theta_i: if kind.declaration().has_light { theta_i } else { 0.0 },
            phi_i: if kind.declaration().has_azimuth { phi_i } else { 0.0 },
        }
    }

    /// The file with the subject of a curve.
    #[must_use]
    pub fn file(&self, slot: Slot) -> Option<NamedFile> {
        let entry = self.entries.iter().find(|entry| entry.slot == slot)?;
        let Recipe::Model(model, values, _) = &entry.recipe else { return None };
        match values.get(model.file()?) {
            Value::File(file) => Some(file),
            _ => None,
        }
    }

    /// The plot with these curves.
    #[must_use]
    pub fn sheet<'a>(&self, drawn: impl IntoIterator<Item = (Style, &'a Drawn)>) -> Sheet {
        let mut sheet = Sheet { channel: self.channel, log: self.log, ..Sheet::new(self.setup) };
        for (style, drawn) in drawn {
            match drawn {
                Drawn::Curve(curve) => {
                    sheet.curves.push(curve.clone());
                    sheet.styles.push(style);
                }
                Drawn::Slice(slice) => sheet.slices.push(slice.clone()),
            }
        }
        sheet
    }
}
