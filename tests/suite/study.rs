//! `lcm study` from end to end, in its quick setting.

use std::fs;

use crate::support::lcm;

/// The report of a quick run and its folder.
fn quick() -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    // In a folder that does not exist yet.
    let to = folder.path().join("new/report");
    let run = lcm(&["study", "--quick", "--quiet", "-o", to.to_str().unwrap()], "");
    assert_eq!((run.status, run.err.as_str(), run.out.as_str()), (Some(0), "", ""));
    let html = fs::read_to_string(to.join("index.html")).unwrap();
    (folder, html)
}

/// The external resources that a browser would load for the page.
fn loads(html: &str) -> Vec<&str> {
    ["src=\"", "href=\"", "url(", "@import", "srcset=", "<script", "<link", "<iframe"]
        .into_iter()
        .flat_map(|how| html.match_indices(how).map(|(at, _)| &html[at..(at + 60).min(html.len())]))
        .filter(|found| !found.starts_with("src=\"data:image/png;base64,") && !found.starts_with("href=\"#"))
        .collect()
}

#[test]
fn the_study_writes_a_report_that_stands_alone() {
    let (folder, html) = quick();
    for i in 1..=4 {
        assert!(html.contains(&format!("<section id=\"phenomenon-{i}\">")), "section {i}");
    }
    for part in ["Question", "Method", "Results", "Conclusion"] {
        assert_eq!(html.matches(&format!("<h3>{part}</h3>")).count(), 4, "{part}");
    }
    // The content of the numbers, and not only their presence.
    assert!(html.contains("All four phenomena are shown"), "{}", &html[..4000.min(html.len())]);
    assert_eq!(loads(&html), [""; 0]);
    assert_eq!(loads("<img src=\"https://x\">").len(), 1);
    // NaN and infinity would appear in text and attributes; pictures are not text.
    let text: String = html.split("base64,").map(|part| part.split_once('"').map_or(part, |p| p.1)).collect();
    for none in ["NaN", "inf ", ">inf", "−inf"] {
        assert!(!text.contains(none), "{none}");
    }
    assert!(text.matches("<svg").count() >= 5 && html.matches("data:image/png").count() >= 12);
    let tables: Vec<_> = fs::read_dir(folder.path().join("new/report"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "csv"))
        .collect();
    assert!(tables.len() >= 9, "{tables:?}");
    for table in tables {
        let text = fs::read_to_string(&table).unwrap();
        let columns: Vec<_> = text.lines().map(|line| line.split(',').count()).collect();
        assert!(columns.len() > 2 && columns.iter().all(|c| *c == columns[0]), "{}", table.display());
    }
    // A quick run is marked as such.
    assert!(html.contains("quick run"));
}

#[test]
fn where_the_study_cannot_write_it_says_so_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let run = lcm(&["study", "-o", file.join("below").to_str().unwrap()], "");
    assert_eq!(run.status, Some(4), "{}", run.err);
    assert!(run.err.contains("could not be written") && run.err.lines().count() == 1, "{}", run.err);
}
