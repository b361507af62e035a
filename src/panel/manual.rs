//! The manual: the documents of the program as one page for a browser, usable offline.

use std::collections::{BTreeMap, BTreeSet};

use maud::{DOCTYPE, PreEscaped, html};
use pulldown_cmark::{CowStr, Event, HeadingLevel, Options, Parser, Tag, TagEnd, html::push_html};

/// The pages with their ids, which are the paths of the files.
pub const PAGES: [(&str, &str); 32] = [
    ("README", include_str!("../../docs/README.md")),
    ("window", include_str!("../../docs/window.md")),
    ("keys", include_str!("../../docs/keys.md")),
    ("scenes", include_str!("../../docs/scenes.md")),
    ("reflection-models", include_str!("../../docs/reflection-models.md")),
    ("shading-and-lights", include_str!("../../docs/shading-and-lights.md")),
    ("comparing", include_str!("../../docs/comparing.md")),
    ("lessons", include_str!("../../docs/lessons.md")),
    ("command-line", include_str!("../../docs/command-line.md")),
    ("worked-examples", include_str!("../../docs/worked-examples.md")),
    ("study", include_str!("../../docs/study.md")),
    ("exporting", include_str!("../../docs/exporting.md")),
    ("performance", include_str!("../../docs/performance.md")),
    ("custom-models", include_str!("../../docs/custom-models.md")),
    ("extending", include_str!("../../docs/extending.md")),
    ("extending/reflection-model", include_str!("../../docs/extending/reflection-model.md")),
    ("extending/light-type", include_str!("../../docs/extending/light-type.md")),
    ("extending/object-type", include_str!("../../docs/extending/object-type.md")),
    ("extending/shading-model", include_str!("../../docs/extending/shading-model.md")),
    ("extending/parameters", include_str!("../../docs/extending/parameters.md")),
    ("extending/scene-field", include_str!("../../docs/extending/scene-field.md")),
    ("extending/panel", include_str!("../../docs/extending/panel.md")),
    ("extending/systems", include_str!("../../docs/extending/systems.md")),
    ("extending/scene-format", include_str!("../../docs/extending/scene-format.md")),
    ("extending/metric", include_str!("../../docs/extending/metric.md")),
    ("extending/command", include_str!("../../docs/extending/command.md")),
    ("extending/channel", include_str!("../../docs/extending/channel.md")),
    ("extending/plot-kind", include_str!("../../docs/extending/plot-kind.md")),
    ("extending/handle", include_str!("../../docs/extending/handle.md")),
    ("extending/layout", include_str!("../../docs/extending/layout.md")),
    ("extending/another-crate", include_str!("../../docs/extending/another-crate.md")),
    ("architecture", include_str!("../../docs/architecture.md")),
];

/// The complete page.
#[must_use]
pub fn page() -> String {
    let sections: Vec<_> = PAGES.iter().map(|(id, text)| (*id, section(id, text))).collect();
    let whole = html! {
        (DOCTYPE)
        html lang="en-GB" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "Lights, Camera, Models! – manual" }
                style { (PreEscaped(include_str!("manual.css"))) }
            }
            body {
                nav aria-label="Pages" {
                    strong { "Manual" }
                    " " small { (env!("CARGO_PKG_VERSION")) }
                    ul { @for (id, (title, _)) in &sections { li { a href={ "#" (id) } { (title) } } } }
                }
                main { @for (id, (_, body)) in &sections { section id=(id) { (PreEscaped(body)) } } }
            }
        }
    };
    whole.into_string()
}

/// The title of a document, and its content as HTML. Links between documents lead to anchors of the page; other links
/// than those to the web, such as to source files, become plain text. Pictures are replaced by their names: the program
/// contains none.
fn section(id: &str, text: &str) -> (String, String) {
    let mut slugs = BTreeMap::new();
    let mut title = String::new();
    let mut events = Vec::new();
    let mut links = Vec::new();
    let mut parser = Parser::new_ext(text, Options::ENABLE_TABLES);
    while let Some(event) = parser.next() {
        match event {
            // Comments, with the names of generated tables.
            Event::Html(_) | Event::InlineHtml(_) => {}
            Event::Start(Tag::Heading { level, .. }) => {
                let within: Vec<_> =
                    parser.by_ref().take_while(|e| !matches!(e, Event::End(TagEnd::Heading(_)))).collect();
                let words = plain(&within);
                let anchor = format!("{id}--{}", numbered(&mut slugs, slug(&words)));
                if level == HeadingLevel::H1 && title.is_empty() {
                    title.clone_from(&words);
                }
                let attribute = Some(CowStr::from(anchor));
                let tag = Tag::Heading { level, id: attribute, classes: Vec::new(), attrs: Vec::new() };
                events.push(Event::Start(tag));
                // Links in a heading become plain text.
                events.extend(
                    within
                        .into_iter()
                        .filter(|e| !matches!(e, Event::Start(Tag::Link { .. }) | Event::End(TagEnd::Link))),
                );
                events.push(Event::End(TagEnd::Heading(level)));
            }
            Event::Start(Tag::Link { link_type, dest_url, title, id: label }) => {
                let target = target(id, &dest_url);
                links.push(target.is_some());
                let link = |to: String| Tag::Link { link_type, dest_url: to.into(), title, id: label };
                events.extend(target.map(link).map(Event::Start));
            }
            Event::End(TagEnd::Link) => {
                if links.pop() == Some(true) {
                    events.push(Event::End(TagEnd::Link));
                }
            }
            Event::Start(Tag::Image { .. }) => {
                events.push(Event::InlineHtml("<span class=\"picture\">Picture: ".into()));
            }
            Event::End(TagEnd::Image) => events.push(Event::InlineHtml("</span>".into())),
            other => events.push(other),
        }
    }
    let mut body = String::new();
    push_html(&mut body, events.into_iter());
    (title, body)
}

/// The target of a link of a page; `None` unless it is in the manual or on the web.
fn target(page: &str, to: &str) -> Option<String> {
    if to.starts_with("https://") || to.starts_with("http://") {
        return Some(to.to_owned());
    }
    let (file, place) = to.split_once('#').unwrap_or((to, ""));
    let folder = page.rsplit_once('/').map_or("", |(folder, _)| folder);
    let path = match file.strip_prefix("../") {
        Some(above) if !folder.is_empty() => above.to_owned(),
        _ => format!("{folder}/{file}").trim_start_matches('/').to_owned(),
    };
    let named = match path.strip_suffix(".md") {
        _ if file.is_empty() => page,
        name => name.filter(|name| PAGES.iter().any(|(id, _)| id == name))?,
    };
    Some(if place.is_empty() { format!("#{named}") } else { format!("#{named}--{place}") })
}

/// The text of a heading.
fn plain(events: &[Event]) -> String {
    let text = |event: &Event| match event {
        Event::Text(text) | Event::Code(text) => text.to_string(),
        Event::SoftBreak => " ".to_owned(),
        _ => String::new(),
    };
    events.iter().map(text).collect()
}

/// The anchor of a heading, as code hosts generate it.
fn slug(words: &str) -> String {
    let kept = |c: &char| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_');
    words.to_lowercase().chars().filter(kept).map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// The anchor, made unique among the earlier ones of the page.
fn numbered(known: &mut BTreeMap<String, usize>, slug: String) -> String {
    let count = known.entry(slug.clone()).or_insert(0);
    *count += 1;
    if *count == 1 { slug } else { format!("{slug}-{}", *count - 1) }
}

/// Targets of internal links that are missing from a page: empty if the page is complete.
#[must_use]
pub fn dead_links(page: &str) -> BTreeSet<String> {
    let attributes = |name: &str| -> BTreeSet<String> {
        page.split(&format!("{name}=\""))
            .skip(1)
            .filter_map(|rest| Some(rest.split_once('"')?.0.to_owned()))
            .collect()
    };
    let ids: BTreeSet<_> = attributes("id").into_iter().map(|id| format!("#{id}")).collect();
    attributes("href").into_iter().filter(|to| to.starts_with('#') && !ids.contains(to)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_lead_within_the_page_to_the_web_or_nowhere() {
        assert_eq!(target("window", "scenes.md#tables").as_deref(), Some("#scenes--tables"));
        assert_eq!(target("window", "#camera").as_deref(), Some("#window--camera"));
        assert_eq!(target("window", "scenes.md").as_deref(), Some("#scenes"));
        assert_eq!(target("window", "https://bevy.org").as_deref(), Some("https://bevy.org"));
        let from = |to: &str| target("extending/panel", to);
        assert_eq!(from("../window.md#camera").as_deref(), Some("#window--camera"));
        assert_eq!(from("systems.md").as_deref(), Some("#extending/systems"));
        assert_eq!(from("#a").as_deref(), Some("#extending/panel--a"));
        assert_eq!(from("window.md").or(from("../../window.md")), None, "in another folder");
        for elsewhere in ["../src/lib.rs", "other.md", "javascript:alert(1)", "file:///etc/passwd"] {
            assert_eq!(target("window", elsewhere), None, "{elsewhere}");
        }
        let text =
            "# A & `b`\n\n## Same\n\n## Same\n\n<!-- t -->\n\n[in](#same-1) [out](../x.rs) ![Alt](y.png)\n";
        let (title, body) = section("page", text);
        assert_eq!(title, "A & b");
        for part in [
            "id=\"page--a--b\"",
            "id=\"page--same-1\"",
            "<a href=\"#page--same-1\">in</a> out",
            "Picture: Alt",
        ] {
            assert!(body.contains(part), "{part}: {body}");
        }
        assert!(!body.contains("<!--") && !body.contains("<img"));
        assert_eq!(dead_links("<a href=\"#x\"> <b id=\"y\"> <a href=\"#y\">"), ["#x".to_owned()].into());
    }
}
