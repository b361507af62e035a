//! Tests of the library without a GPU: models to try are adopted directly.

use std::{fs, io};

use tempfile::TempDir;

use super::{Library, assets::built_in_sources};
use crate::registry::{Extent, Registry};

/// A library over folders on disk.
struct Bench {
    library: Library,
    registry: Registry,
    folder: TempDir,
}

const HELP: &str = "fn helped(c: vec3<f32>) -> vec3<f32> { return c; }\n";

/// A model whose second version differs from its first.
fn matt(level: f32) -> String {
    format!(
        "/* lcm {{ \"name\": \"Matt\" }} */\n#import \"help.wgsl\"\nfn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {{\n    \
         return Terms(vec3(0.0), helped(vec3({level:?})), vec3(0.0));\n}}\n"
    )
}

impl Bench {
    fn new() -> io::Result<Self> {
        let folder = tempfile::tempdir()?;
        let mut registry = Registry::builtin();
        for name in ["shaders", "models"] {
            fs::create_dir(folder.path().join(name))?;
        }
        registry.set_shader_folder(&folder.path().join("shaders"));
        registry.set_custom_folder(&folder.path().join("models"));
        Ok(Self { library: Library::default(), registry, folder })
    }

    /// Looks at a file; true if it is to be tried again what is made of it.
    fn reread(&mut self, path: &str) -> bool {
        let file = self.folder.path().join(path);
        self.library.reread(&file, &mut self.registry, |_| true).is_some()
    }

    fn save(&mut self, path: &str, text: &str) -> bool {
        fs::write(self.folder.path().join(path), text).expect("writable");
        self.reread(path)
    }

    fn delete(&mut self, path: &str) -> bool {
        fs::remove_file(self.folder.path().join(path)).expect("it is there");
        self.reread(path)
    }

    /// Adopts the arriving models, and returns their number.
    fn adopt(&mut self) -> usize {
        let arriving = self.library.next_arriving(usize::MAX);
        let count = arriving.len();
        arriving.into_iter().for_each(|model| self.library.adopt(model, &mut self.registry));
        count
    }

    /// The first problem of each unusable file.
    fn problems(&self) -> Vec<String> {
        self.library.unusable().map(|(_, problem)| problem.what[0].to_string()).collect()
    }

    fn text(&self, source: &str) -> Option<&str> {
        self.registry.sources().get(source)
    }
}

fn loop_text() -> &'static str {
    let sources = built_in_sources(&Registry::builtin());
    sources.iter().find(|source| source.path == "loop.wgsl").expect("built in").text
}

#[test]
fn the_text_of_a_shader_goes_into_the_registry_when_it_is_another() -> io::Result<()> {
    let mut bench = Bench::new()?;
    assert!(!bench.save("shaders/loop.wgsl", loop_text()), "it is the built-in text");
    assert_eq!(bench.text("loop.wgsl"), None);
    let edited = format!("{}// edited\n", loop_text());
    assert!(bench.save("shaders/loop.wgsl", &edited));
    assert_eq!(bench.text("loop.wgsl"), Some(edited.as_str()));
    assert!(!bench.reread("shaders/loop.wgsl"), "nothing changed since");
    assert_eq!(bench.library.reloaded().map(|r| r.file).as_deref(), Some("loop.wgsl"));
    assert!(bench.save("shaders/loop.wgsl", loop_text()));
    assert_eq!(bench.text("loop.wgsl"), None, "the built-in text is not held twice");
    for other in ["shaders/notes.txt", "notes.wgsl"] {
        assert!(!bench.save(other, "…"), "{other} is no shader");
    }
    assert_eq!(bench.problems(), [""; 0]);
    Ok(())
}

#[test]
fn a_file_is_missed_only_if_something_was_made_of_it() -> io::Result<()> {
    let mut bench = Bench::new()?;
    bench.save("shaders/loop.wgsl", loop_text());
    bench.delete("shaders/loop.wgsl");
    assert!(bench.library.take_news());
    assert!(bench.problems()[0].contains("the file is missing"), "{:?}", bench.problems());
    bench.reread("shaders/loop.wgsl");
    assert!(!bench.library.take_news(), "it is known");
    assert_eq!(bench.library.gone(&bench.registry).count(), 0, "there is a built-in text");
    bench.save("shaders/loop.wgsl", loop_text());
    assert!(bench.library.take_news());
    assert_eq!(bench.problems(), [""; 0]);
    // A model that was never valid.
    bench.save("models/odd.wgsl", "/* lcm { */");
    assert_eq!(bench.problems().len(), 1);
    bench.delete("models/odd.wgsl");
    assert_eq!(bench.problems(), [""; 0]);
    Ok(())
}

#[test]
fn a_custom_model_is_held_here_until_it_is_drawn_with() -> io::Result<()> {
    let mut bench = Bench::new()?;
    assert!(bench.save("models/help.wgsl", HELP));
    assert!(!bench.save("models/matt.wgsl", &matt(0.25)));
    assert_eq!(bench.library.pending("models/matt.wgsl"), Some(matt(0.25).as_str()));
    assert!(bench.registry.model("matt").is_none() && bench.library.is_busy());
    assert_eq!(bench.adopt(), 1);
    assert_eq!(bench.text("models/matt.wgsl"), Some(matt(0.25).as_str()));
    assert_eq!(bench.library.pending("models/matt.wgsl"), None, "the registry has it");
    bench.reread("models/matt.wgsl");
    assert_eq!(bench.adopt(), 0, "nothing changed since");
    // An error leaves the text in use unchanged.
    bench.save("models/matt.wgsl", &matt(0.5).replace("vec3(0.5)", "vec4(0.5)"));
    assert_eq!((bench.adopt(), bench.problems().len()), (0, 1));
    assert_eq!(bench.text("models/matt.wgsl"), Some(matt(0.25).as_str()));
    bench.save("models/matt.wgsl", &matt(0.25));
    assert_eq!((bench.adopt(), bench.problems().len()), (1, 0), "the good version mends it");
    // Back to the text in use, before the other one was tried.
    bench.save("models/matt.wgsl", &matt(0.75));
    bench.save("models/matt.wgsl", &matt(0.25));
    assert_eq!(bench.adopt(), 0, "the file says what is drawn");
    bench.delete("models/matt.wgsl");
    let gone: Vec<_> = bench.library.gone(&bench.registry).map(str::to_owned).collect();
    assert_eq!(gone, ["models/matt.wgsl"]);
    bench.library.forget(&gone[0], &mut bench.registry);
    assert!(bench.registry.model("matt").is_none() && bench.text("models/matt.wgsl").is_none());
    assert_eq!(bench.problems(), [""; 0]);
    Ok(())
}

#[test]
fn a_new_model_with_a_mistake_is_a_stand_in_and_mended_by_the_file_that_it_lacks() -> io::Result<()> {
    let mut bench = Bench::new()?;
    bench.save("models/matt.wgsl", &matt(0.25));
    assert!(bench.problems()[0].contains("there is no file `help.wgsl`"), "{:?}", bench.problems());
    assert_eq!(bench.registry.extent("matt"), Some(Extent::StandIn));
    bench.save("models/help.wgsl", HELP);
    assert_eq!(bench.adopt(), 1);
    assert_eq!(bench.registry.extent("matt"), Some(Extent::Whole));
    assert_eq!(bench.problems(), [""; 0]);
    // A shader in use is read again when a file that it imports changes, and kept if it no longer fits.
    bench.save("models/help.wgsl", &format!("{HELP}// edited\n"));
    assert_eq!(bench.adopt(), 1);
    bench.save("models/help.wgsl", "fn other() {}\n");
    assert_eq!((bench.adopt(), bench.problems().len()), (0, 1));
    assert_eq!(bench.registry.extent("matt"), Some(Extent::Whole));
    bench.save("models/help.wgsl", HELP);
    assert_eq!((bench.adopt(), bench.problems().len()), (1, 0));
    Ok(())
}

#[test]
fn models_that_are_used_are_wanted_until_they_are_looked_at() -> io::Result<()> {
    let mut bench = Bench::new()?;
    fs::write(bench.folder.path().join("models/help.wgsl"), HELP)?;
    fs::write(bench.folder.path().join("models/matt.wgsl"), matt(0.25))?;
    crate::custom::folder::declare_rest(&mut bench.registry);
    let model = bench.registry.model("matt").expect("declared").clone();
    let file = bench.folder.path().join("models/matt.wgsl");
    let wanted = |bench: &Bench| bench.library.wanted(["matt", "phong"].into_iter(), &bench.registry);
    assert_eq!(wanted(&bench), [file]);
    assert!(!bench.library.is_arriving(&model, &bench.registry));
    bench.reread("models/matt.wgsl");
    assert!(wanted(&bench).is_empty() && bench.library.is_arriving(&model, &bench.registry));
    assert_eq!(bench.adopt(), 1);
    assert!(wanted(&bench).is_empty() && !bench.library.is_arriving(&model, &bench.registry));
    Ok(())
}

#[test]
fn the_last_good_texts_are_kept_for_files_that_all_models_share() -> io::Result<()> {
    let mut bench = Bench::new()?;
    let good = format!("{}// good\n", loop_text());
    bench.save("shaders/loop.wgsl", &good);
    let model = &bench.registry.models()[0];
    let shading = &bench.registry.shading_models()[0];
    let drawn = (model, model.declaration.passage());
    let composed =
        crate::registry::compose::compose(bench.registry.sources(), drawn, shading, bench.registry.lights());
    assert!(!bench.library.is_built_in(&composed, &bench.registry));
    bench.library.note_good(&composed, &bench.registry);
    bench.save("shaders/loop.wgsl", "broken");
    bench.save("models/help.wgsl", HELP);
    let lenient = bench.library.lenient(&bench.registry);
    assert_eq!(lenient.get("loop.wgsl"), Some(good.as_str()));
    assert_eq!(lenient.get("models/help.wgsl"), Some(HELP));
    assert_eq!(bench.text("loop.wgsl"), Some("broken"));
    Ok(())
}
