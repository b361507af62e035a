//! `lcm study` from start to end, in its quick setting.

use std::{fs, path::Path};

use lights_camera_models::study::{Study, Table};

use crate::helpers::support::{lcm, names};

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

/// The numbers of the chapter on OpenPBR: shares of layers that add up to a whole, and the conclusions drawn
/// from them.
fn layers_add_up(html: &str, folder: &Path) {
    assert!(html.contains("<section id=\"layers\">") && html.contains("href=\"#layers\""));
    let rows = |name: &str| -> Vec<Vec<f64>> {
        let text = fs::read_to_string(folder.join(name)).unwrap();
        let row = |line: &str| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
        text.lines().skip(1).map(row).collect()
    };
    let energy = rows("layers_energy.csv");
    for row in &energy {
        assert!(row[1..5].iter().all(|share| (0.0..1.0).contains(share)), "{row:?}");
        assert!((row[1..5].iter().sum::<f64>() - row[5]).abs() < 1e-5 && row[5] < 1.0, "{row:?}");
    }
    let (first, last) = (&energy[0], &energy[energy.len() - 1]);
    // Along the normal, the coat of index 1.6 reflects (0.6/2.6)² = 0.053, minus what the fuzz above it
    // takes.
    assert!((0.03..0.055).contains(&first[2]) && last[2] > 3.0 * first[2], "{first:?} {last:?}");
    assert!(last[4] < first[4], "the body loses");
    // For copper: a coat without darkening, with darkening, and with a colour; each row has name, angle, red,
    // green, blue.
    let copper = rows("layers_coated_copper.csv");
    let normal: Vec<_> = copper.iter().filter(|row| row[1] == 0.0).collect();
    assert_eq!(normal.len(), 4);
    assert!(normal[2][3] < normal[1][3] && normal[2][5] > normal[1][5], "darkening: {normal:?}");
    assert!(normal[3][4] < 0.5 * normal[2][4], "amber takes blue");
    // A film of zero thickness reflects like glass, one of a quarter of a wavelength less.
    let film = rows("layers_film.csv");
    assert!((film[0][3] - 0.04).abs() < 1e-3, "{:?}", film[0]);
    let least = film.iter().take(film.len() / 2).map(|row| row[3]).fold(1.0, f64::min);
    assert!(least < 0.01, "{least}");
    assert!(html.contains("Film of index 2 over a body of index 1.1”"), "the one that gains is named");
}

/// The numbers of the chapter on published orders, and the verdicts that follow from them.
fn orders_are_judged_by_their_numbers(html: &str, folder: &Path) {
    assert!(html.contains("<section id=\"merl\">") && html.contains("href=\"#merl\""));
    let rows = |name: &str| -> Vec<Vec<String>> {
        let text = fs::read_to_string(folder.join(name)).unwrap();
        text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
    };
    let orders = rows("merl_orders.csv");
    assert_eq!(orders.len(), 4);
    let mut reproduced = 0;
    for row in &orders {
        let [count, all, holds] = [4, 5, 6].map(|i| row[i].parse::<f64>().unwrap());
        assert!(all == 10.0 && (holds == 1.0) == (2.0 * count > all), "{row:?}");
        assert!(html.contains(&format!("{count} of {all}")), "{row:?}");
        reproduced += usize::from(holds == 1.0);
    }
    assert!(
        html.contains(&format!("Of 4 published orders of models on the MERL materials, {reproduced} are"))
    );
    // Heavy tails are an order that the fits of SGD, which has them, must show.
    assert!(orders.iter().any(|row| row[2] == "GGX" && row[6].starts_with('1')), "{orders:?}");
    let medians = rows("merl_metrics.csv");
    assert_eq!(medians.len(), 3 * 6);
    let of = |metric: &str, model: &str| -> f64 {
        let row = medians.iter().find(|row| row[0] == metric && row[1] == model).unwrap();
        row[2].parse().unwrap()
    };
    assert!(of("log", "GGX") < of("log", "Cook–Torrance"), "{medians:?}");
    assert!(of("log", "GGX") < 0.5 && of("log", "ABC") > 0.0, "{medians:?}");
}

/// The numbers of the chapter on light with extent.
fn approximations_have_errors(html: &str, folder: &Path) {
    assert!(html.contains("<section id=\"extent\">") && html.contains("href=\"#extent\""));
    let text = fs::read_to_string(folder.join("extent_errors.csv")).unwrap();
    let rows: Vec<Vec<&str>> = text.lines().skip(1).map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 9);
    let rms = |row: &[&str]| row[3].parse::<f64>().unwrap();
    for row in &rows {
        let [mean, largest, noise] = [4, 5, 8].map(|i| row[i].parse::<f64>().unwrap());
        // More than noise, and less than an unrelated picture.
        assert!(rms(row) > noise && rms(row) < 1.0 && noise < 0.05, "{row:?}");
        assert!((0.8..1.2).contains(&mean) && largest.abs() > rms(row), "{row:?}");
        let percent = format!("{:.1}\u{a0}%", 100.0 * rms(row));
        assert!(html.contains(&format!("difference, {percent}")), "{row:?}");
    }
    // One roughness for two is a worse approximation than for one.
    let of = |material: &str, approximation: &str| {
        let row = rows.iter().find(|row| row[0].contains(material) && row[2] == approximation).unwrap();
        rms(row)
    };
    assert!(of("brushed", "LTC") > 1.5 * of("gold", "LTC"), "{rows:?}");
    assert!(html.contains("the highlight is round where it should be stretched"));
}

#[test]
fn the_study_writes_a_report_that_stands_alone() {
    let (folder, html) = quick();
    for i in 1..=4 {
        assert!(html.contains(&format!("<section id=\"phenomenon-{i}\">")), "section {i}");
    }
    for part in ["Question", "Method", "Results", "Conclusion"] {
        assert_eq!(html.matches(&format!("<h3>{part}</h3>")).count(), 7, "{part}");
    }
    // The contents of the numbers, not only their presence.
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
    orders_are_judged_by_their_numbers(&html, &folder.path().join("new/report"));
    layers_add_up(&html, &folder.path().join("new/report"));
    approximations_have_errors(&html, &folder.path().join("new/report"));
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

#[test]
fn a_report_is_written_whole_or_not_at_all() {
    let around = tempfile::tempdir().unwrap();
    let report = |html: &str, last: &'static str| Study {
        html: html.to_owned(),
        tables: ["numbers", last].map(|name| Table { name, csv: format!("a,{html}\n") }).into(),
    };
    // A place that accepts no files fails in the same place as a full disk.
    let new = around.path().join("deep/new");
    assert!(report("one", "../outside").write(&new).is_err());
    assert_eq!(names(around.path()), [""; 0], "nor any of its folders");
    report("one", "more").write(&new).unwrap();
    assert_eq!(names(&new), ["index.html", "more.csv", "numbers.csv"]);
    // Over an earlier report, next to somebody else's files.
    fs::create_dir(new.join("taken.csv")).unwrap();
    assert!(report("two", "taken").write(&new).is_err());
    let content = |name: &str| fs::read_to_string(new.join(name)).unwrap();
    assert_eq!((content("index.html"), content("numbers.csv")), ("one".to_owned(), "a,one\n".to_owned()));
    report("two", "more").write(&new).unwrap();
    assert_eq!((content("index.html"), content("more.csv")), ("two".to_owned(), "a,two\n".to_owned()));
    assert_eq!(names(&new), ["index.html", "more.csv", "numbers.csv", "taken.csv"]);
}
