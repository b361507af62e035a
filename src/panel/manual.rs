//! The manual: the documents of the program as one page for a browser, usable offline.

use std::collections::BTreeMap;

use maud::{DOCTYPE, PreEscaped, html};
use pulldown_cmark::{CowStr, Event, HeadingLevel, Options, Parser, Tag, TagEnd, html::push_html};

use crate::program::{self, in_own_name};

macro_rules! pages {
    ($($id:literal)+) => { [$(($id, include_str!(concat!("../../docs/", $id, ".md")))),+] };
}

/// The pages with their ids, which are the paths of the files.
pub const PAGES: [(&str, &str); 38] = pages! {
    "README" "installing" "window" "keys" "scenes" "reflection-models" "measured" "shading-and-lights" "comparing" "lessons"
    "command-line" "python" "browser" "figures" "worked-examples" "study" "exporting" "performance" "custom-models" "extending"
    "extending/reflection-model" "extending/light-type" "extending/object-type" "extending/shading-model"
    "extending/parameters" "extending/parameter-kind" "extending/scene-field" "extending/panel" "extending/systems"
    "extending/scene-format" "extending/metric" "extending/command" "extending/channel" "extending/plot-kind"
    "extending/handle" "extending/layout" "extending/another-crate" "architecture"
};

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
                title { (program::title()) " – manual" }
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
                let link = |e: &Event| matches!(e, Event::Start(Tag::Link { .. }) | Event::End(TagEnd::Link));
                events.extend(within.into_iter().filter(|event| !link(event)));
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
    push_html(&mut body, events.into_iter().map(renamed));
    (in_own_name(&title), body)
}

/// Text with the names of this program instead of those of the lab. Anchors, to which links lead, keep their words.
fn renamed(event: Event<'_>) -> Event<'_> {
    match event {
        Event::Text(text) => Event::Text(in_own_name(&text).into()),
        Event::Code(code) => {
            // A command alone is known by its quotes.
            let quoted = in_own_name(&format!("`{code}`"));
            Event::Code(quoted[1..quoted.len() - 1].to_owned().into())
        }
        other => other,
    }
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
    }
}
