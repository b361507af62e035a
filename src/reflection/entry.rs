//! A registered model.

use std::{
    collections::HashMap,
    hash::{DefaultHasher, Hash as _, Hasher as _},
    sync::{
        Arc, Mutex, OnceLock,
        atomic::{AtomicU64, Ordering},
    },
};

use glam::{Vec3, Vec4};

use super::{
    ReflectionModel,
    declaration::{Ambient, Declaration},
    group::Group,
    model::OnPages,
    passage::Passage,
    preset::{self, Measured},
    surface::{Instance, Surface},
};
use crate::{
    caught::lock,
    declared::entry,
    optics::{
        Frame,
        albedo::{AlbedoCurve, LobeAlbedo, NODES, NamedCurve},
        colour::Encoding,
        interior::Interior,
    },
    parameter::{Parameter, Table, Value, Values, pack},
    shader::Source,
    text::{listed, nearest},
};

/// A registered model, in the form used by the rest of the program.
#[derive(Clone)]
pub struct ModelEntry {
    /// Name, source, laws, equation, shader.
    pub declaration: &'static Declaration,
    /// Parameters of the model.
    pub parameters: &'static [Parameter],
    /// See [`ReflectionModel::GROUPS`].
    pub groups: &'static [Group],
    /// See [`ReflectionModel::preset`].
    pub preset: fn(&Measured) -> Vec<(&'static str, Value)>,
    lobe: Lobe,
    curves: &'static [NamedCurve],
    /// See [`ReflectionModel::PASSAGE`].
    passage: Option<fn(&Values) -> Passage>,
    pub(super) instantiate: Instantiate,
    on_pages: Option<OnPages>,
    interior_on_pages: Option<&'static str>,
    on_cpu: Option<Arc<dyn Interpreted>>,
    identity: Identity,
    /// Surfaces with curves, by their packed parameters: objects of one material share one.
    kept: Arc<Mutex<HashMap<Vec<u8>, Arc<dyn Surface>>>>,
}

/// Values that distinguish entries with the same id.
#[derive(Clone)]
struct Identity {
    /// See [`ModelEntry::version`].
    version: u64,
    /// See [`ModelEntry::declared`]. Calculated when it is first asked for: a start of the program would wait for that of
    /// every model, and a command asks for none.
    declared: Arc<OnceLock<u64>>,
}

impl Identity {
    fn new() -> Self {
        static VERSIONS: AtomicU64 = AtomicU64::new(1);
        Self { version: VERSIONS.fetch_add(1, Ordering::Relaxed), declared: Arc::default() }
    }
}

/// The state of a model whose WGSL the CPU interprets.
pub(crate) trait Interpreted: Send + Sync {
    /// The reason why the CPU cannot run the model, if the last attempt failed.
    fn trouble(&self) -> Option<String>;
    /// True if a function ran too long.
    fn runs_too_long(&self) -> bool;
    /// Clears the record of a function that ran too long: with other parameters it may not.
    fn run_again(&self);
}

/// Creates a surface from parameters.
pub(crate) type Instantiate = Arc<dyn Fn(&Values, Encoding) -> Arc<dyn Surface> + Send + Sync>;

/// The specular lobe with the albedo that a model's shader reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lobe {
    /// No lobe.
    None,
    /// The lobe of the model itself.
    Own,
    /// The lobe of a built-in model, by id.
    Of(&'static str),
}

/// Number of surfaces with curves to keep.
const KEPT: usize = 1024;
/// The same of surfaces that hold the numbers of a file: as many files as a scene may reasonably show.
const KEPT_WITH_FILE: usize = 24;

impl ModelEntry {
    /// The entry of a model type.
    #[must_use]
    pub fn of<M: ReflectionModel>() -> Self {
        let lobe = if M::LOBE || !M::CURVES.is_empty() { Lobe::Own } else { Lobe::None };
        let instantiate = Arc::new(|values: &Values, encoding| {
            Arc::new(Instance { model: M::from_values(values, encoding), curve: OnceLock::new() })
                as Arc<dyn Surface>
        });
        Self {
            groups: M::GROUPS,
            preset: M::preset,
            passage: M::PASSAGE,
            on_pages: M::ON_PAGES,
            interior_on_pages: M::INTERIOR_ON_PAGES,
            ..Self::custom(const { &M::DECLARATION }, M::PARAMETERS, lobe, M::CURVES, instantiate, None)
        }
    }

    /// The entry of a model from a file; `lobe` is the model whose lobe and curves the shader reads.
    pub(crate) fn custom(
        declaration: &'static Declaration,
        parameters: &'static [Parameter],
        lobe: Lobe,
        curves: &'static [NamedCurve],
        instantiate: Instantiate,
        on_cpu: Option<Arc<dyn Interpreted>>,
    ) -> Self {
        Self {
            declaration,
            parameters,
            groups: &[],
            preset: preset::by_names(parameters),
            lobe,
            curves,
            passage: None,
            instantiate,
            on_pages: None,
            interior_on_pages: None,
            on_cpu,
            identity: Identity::new(),
            kept: Arc::default(),
        }
    }

    /// Puts the parameters into groups.
    pub(crate) fn grouped(self, groups: &'static [Group]) -> Self {
        Self { groups, ..self }
    }

    /// The parameter with a name, which may be spelt as in American English.
    ///
    /// # Errors
    /// Returns the nearest name, or all of them.
    pub fn named(&self, name: &str) -> Result<&'static Parameter, String> {
        let spelling = name.replace("color", "colour");
        self.parameters.iter().find(|p| p.name == spelling).ok_or_else(|| {
            let names: Vec<_> = self.parameters.iter().map(|p| p.name).collect();
            let known = self.parameters.iter().flat_map(|p| [p.name, p.label, p.symbol].map(|s| (s, p.name)));
            let hint = nearest(&spelling, known).map_or_else(
                || format!("it has {}", listed(&names, "and")),
                |n| format!("did you mean {n}?"),
            );
            format!("{} has no parameter {name}; {hint}", self.declaration.id)
        })
    }

    /// A number that changes whenever the file of the model is read again.
    #[must_use]
    pub(crate) fn version(&self) -> u64 {
        self.identity.version
    }

    /// A number that changes when the declaration or the parameters do, and with them the layout of rows.
    #[must_use]
    pub(crate) fn declared(&self) -> u64 {
        *self.identity.declared.get_or_init(|| {
            let mut hasher = DefaultHasher::new();
            // The text of the shader is compared where it is composed. Parameters contain floats, which cannot be
            // hashed.
            let wgsl = Source { text: "", ..self.declaration.wgsl };
            format!("{:?} {:?}", Declaration { wgsl, ..*self.declaration }, self.parameters)
                .hash(&mut hasher);
            hasher.finish()
        })
    }

    /// The reason why the CPU cannot run the model, if any: it interprets the WGSL of custom models, but not
    /// every construct, while the GPU runs them all. An endless function is detected only when it runs.
    #[must_use]
    pub fn not_on_cpu(&self) -> Option<String> {
        self.on_cpu.as_ref().and_then(|on_cpu| on_cpu.trouble())
    }

    /// True if the CPU interprets the model and found an endless function. It would be endless on the GPU
    /// too, which cannot be stopped.
    #[must_use]
    pub fn runs_too_long(&self) -> bool {
        self.on_cpu.as_ref().is_some_and(|on_cpu| on_cpu.runs_too_long())
    }

    /// Allows a function that ran too long to run again, for a scene that may have other parameters.
    pub(crate) fn run_again(&self) {
        if let Some(on_cpu) = &self.on_cpu {
            on_cpu.run_again();
        }
    }

    /// The passage of light through surfaces with these parameters.
    #[must_use]
    pub fn passage(&self, values: &Values) -> Passage {
        self.passage.map_or_else(|| self.declaration.passage(), |of| of(values))
    }

    /// True if light takes one of many ways through bodies with these parameters, by chance.
    #[must_use]
    pub fn leads_by_chance(&self, values: &Values) -> bool {
        let is_rough = |surface: Arc<dyn Surface>| surface.interior().is_some_and(|inside| inside.is_rough());
        self.passage(values).solid && is_rough(self.instantiate(values, Encoding::default()))
    }

    /// True if the light of surfaces with these parameters is a mean of samples under light with extent: false for smooth
    /// glass without dispersion, which shows that light as it is.
    #[must_use]
    pub fn is_by_chance(&self, values: &Values) -> bool {
        self.not_spreading_all(values).is_none_or(|surface| {
            let disperses = |inside: Interior| inside.is_rough() || inside.cauchy_b != 0.0;
            surface.spreads() || surface.interior().is_some_and(disperses)
        })
    }

    /// True if light passes through surfaces with these parameters without spreading, as through smooth glass: lights without
    /// extent are then not seen through them.
    #[must_use]
    pub fn is_clear(&self, values: &Values) -> bool {
        self.not_spreading_all(values).is_some_and(|surface| match surface.interior() {
            Some(inside) => !inside.is_rough(),
            None => surface.sharp(Vec3::Z, &Frame::LOCAL).iter().any(|sharp| sharp.transmitted),
        })
    }

    /// The surface with these parameters, unless the model spreads all light whatever they are: most models do, and some
    /// take long to prepare.
    fn not_spreading_all(&self, values: &Values) -> Option<Arc<dyn Surface>> {
        let Passage { sharp, solid, .. } = self.passage(values);
        (sharp || solid).then(|| self.instantiate(values, Encoding::default()))
    }

    /// True if the parameters decide how light passes.
    #[must_use]
    pub fn passage_varies(&self) -> bool {
        self.passage.is_some()
    }

    /// All ways in which light passes through surfaces of the model.
    #[must_use]
    pub fn passages(&self) -> Vec<Passage> {
        match self.passage {
            Some(_) => vec![Passage::NONE, Passage::SHEET, Passage::BODY],
            None => vec![self.declaration.passage()],
        }
    }

    /// True if the CPU interprets the WGSL of the model.
    #[must_use]
    pub fn is_interpreted(&self) -> bool {
        self.on_cpu.is_some()
    }

    /// True if the model has a specular lobe with an albedo that its shader reads, or other curves.
    #[must_use]
    pub fn has_lobe(&self) -> bool {
        self.lobe == Lobe::Own
    }

    /// The id of the model whose lobe albedo and curves the shader reads.
    #[must_use]
    pub fn lobe_of(&self) -> Option<&'static str> {
        match self.lobe {
            Lobe::None => None,
            Lobe::Own => Some(self.declaration.id),
            Lobe::Of(id) => Some(id),
        }
    }

    /// The parameter that names a file, of a model that has one.
    #[must_use]
    pub fn file(&self) -> Option<&'static Parameter> {
        self.parameters.iter().find(|p| p.kind.format().is_some())
    }

    /// The file of a surface, with its numbers.
    #[must_use]
    pub fn table(&self, values: &Values) -> Option<Table> {
        values.table(self.file()?)
    }

    /// The model with the parameters of one object.
    #[must_use]
    pub fn instantiate(&self, values: &Values, encoding: Encoding) -> Arc<dyn Surface> {
        if !self.has_curve() {
            return (self.instantiate)(values, encoding);
        }
        let mut key = pack(self.parameters, values, encoding);
        let file = self.table(values).and_then(|table| table.file);
        let most = if file.is_some() { KEPT_WITH_FILE } else { KEPT };
        key.extend(file.map_or(0, |file| file.version()).to_le_bytes());
        let kept = || lock(&self.kept);
        if let Some(surface) = kept().get(&key) {
            return surface.clone();
        }
        let surface = (self.instantiate)(values, encoding);
        let mut kept = kept();
        if kept.len() >= most {
            kept.clear();
        }
        kept.entry(key).or_insert(surface).clone()
    }

    /// True if the row of an object contains a curve in addition to the parameters.
    #[must_use]
    pub fn has_curve(&self) -> bool {
        self.lobe != Lobe::None || !self.curves.is_empty() || self.declaration.ambient == Ambient::Albedo
    }

    /// The number of harmonics of the azimuth in a curve.
    #[must_use]
    pub fn harmonics(&self) -> usize {
        if self.declaration.anisotropic { 3 } else { 1 }
    }

    /// The additional curves that the shader reads; see [`ReflectionModel::CURVES`].
    #[must_use]
    pub fn curves(&self) -> &'static [NamedCurve] {
        self.curves
    }

    /// The curves as JavaScript for web pages.
    #[must_use]
    pub fn on_pages(&self) -> Option<OnPages> {
        self.on_pages
    }

    /// See [`ReflectionModel::INTERIOR_ON_PAGES`].
    #[must_use]
    pub fn interior_on_pages(&self) -> Option<&'static str> {
        self.interior_on_pages
    }

    /// The number of quadruples in the curves of a row: the harmonics of the albedo, then the additional
    /// curves.
    #[must_use]
    pub fn curve_length(&self) -> usize {
        self.harmonics() * NODES + self.curves.iter().map(NamedCurve::length).sum::<usize>()
    }

    /// The row of an object in the shader's table, with the layout of the WGSL struct `Row` (see
    /// [`row_struct`](crate::registry::compose::row_struct)): the parameters, and the curve for models that
    /// have one. The colours of the curve are zero unless the scene has `uniform_light`.
    #[must_use]
    pub fn row(&self, values: &Values, encoding: Encoding, uniform_light: bool) -> Vec<u8> {
        let mut row = pack(self.parameters, values, encoding);
        if self.has_curve() {
            let surface = self.instantiate(values, encoding);
            let curve = if uniform_light { surface.curve() } else { None };
            append_curve(&mut row, self.harmonics(), curve, surface.lobe(), &self.curves_of(&*surface));
        }
        row
    }

    /// The values of a surface's additional curves; zeros for a surface without any, such as a fallback.
    pub(crate) fn curves_of(&self, surface: &dyn Surface) -> Vec<Vec4> {
        let mut values = surface.curves();
        values.resize(self.curve_length() - self.harmonics() * NODES, Vec4::ZERO);
        values
    }
}

/// Writes a curve after the parameters of a row.
pub(crate) fn append_curve(
    row: &mut Vec<u8>,
    harmonics: usize,
    curve: Option<AlbedoCurve>,
    lobe: Option<LobeAlbedo>,
    curves: &[Vec4],
) {
    let lobe = lobe.unwrap_or_default();
    row.resize(row.len().next_multiple_of(16), 0);
    for harmonic in 0..harmonics {
        for node in 0..NODES {
            let rgb = curve.map_or(Vec3::ZERO, |c| c.harmonics[harmonic][node]);
            let w = if harmonic == 0 { lobe.nodes[node] } else { 0.0 };
            row.extend(rgb.extend(w).to_array().into_iter().flat_map(f32::to_le_bytes));
        }
    }
    row.extend(curves.iter().flat_map(Vec4::to_array).flat_map(f32::to_le_bytes));
    row.extend([lobe.average(), 0.0, 0.0, 0.0].into_iter().flat_map(f32::to_le_bytes));
}

entry!(ModelEntry);

#[cfg(test)]
mod tests {
    use crate::{custom, registry::Registry};

    #[test]
    fn entries_of_one_file_are_told_apart_by_value() {
        let read = |declaration: &str| {
            let text = format!("/* lcm {declaration} */");
            let path = std::path::Path::new("mine.wgsl");
            custom::declare(path, &text, &Registry::builtin()).expect("valid").entry
        };
        let parameter = |default: f32| {
            read(&format!("{{ \"parameters\": [{{ \"name\": \"mine\", \"default\": {default} }}] }}"))
        };
        let (first, again, other) = (parameter(0.5), parameter(0.5), parameter(0.25));
        assert_eq!(first.declared(), again.declared());
        assert_ne!(first.version(), again.version(), "the file was read again");
        assert_eq!(first.version(), first.clone().version());
        assert_ne!(first.declared(), other.declared());
        assert_ne!(first.declared(), read("{ \"name\": \"Other\" }").declared());
        let builtin = |id: &str| Registry::builtin().model(id).expect("built in").declared();
        assert_eq!(builtin("phong"), builtin("phong"));
        assert_ne!(builtin("phong"), builtin("lambert"));
    }
}
