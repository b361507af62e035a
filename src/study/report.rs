//! The page with the chapters.

use std::time::{SystemTime, UNIX_EPOCH};

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::{Chapter, Settings};

/// The name of the program in the head of a report, followed by its version.
pub(super) const GENERATOR: &str = "Lights, Camera, Models! ";

const STYLE: &str = include_str!("report.css");

/// A date in words, from days since 1970: H. Hinnant (2013), *chrono-Compatible Low-Level Date Algorithms*,
/// `civil_from_days`.
fn date(days: i64) -> String {
    let z = days + 719_468;
    let era = z.div_euclid(146_097);
    let day_of_era = z.rem_euclid(146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    let year = year_of_era + era * 400 + i64::from(month <= 2);
    let names = [
        "January",
        "February",
        "March",
        "April",
        "May",
        "June",
        "July",
        "August",
        "September",
        "October",
        "November",
        "December",
    ];
    format!("{day} {} {year}", names[(month - 1) as usize])
}

fn today() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs());
    date((seconds / 86_400) as i64)
}

/// Terms of the text, with explanations.
const GLOSSARY: &[(&str, &str)] = &[
    (
        "BRDF",
        "bidirectional reflectance distribution function, f(l, v): the fraction of the light arriving from direction l that leaves towards v, per steradian (sr⁻¹).",
    ),
    (
        "Directional albedo",
        "E(v) = ∫ f(l, v) cos θ dl: the fraction of uniform light reflected towards v. For a reciprocal BRDF it is also the fraction of a beam from v that is reflected. A passive surface has E ≤ 1.",
    ),
    (
        "Fresnel reflectance",
        "the fraction of light that a smooth boundary between two media reflects. It follows from the refractive index n and, for metals, the extinction coefficient k.",
    ),
    ("Lobe", "the part of a BRDF concentrated about the mirror direction, visible as the highlight."),
    (
        "Microfacet model",
        "a BRDF made of a distribution D of tiny mirrors (Beckmann, GGX), their masking G and their Fresnel reflectance F: f = D G F / (4 (n·l)(n·v)).",
    ),
    ("Reciprocity", "f(l, v) = f(v, l): light and viewer can be exchanged."),
    (
        "Roughness α",
        "the width of the distribution of microfacets; roughly the typical slope of the surface. Blinn–Phong's exponent n is as sharp as α = √(2/(n + 2)).",
    ),
    (
        "White furnace",
        "a test: in uniform light, a surface that absorbs nothing is indistinguishable from its surroundings.",
    ),
    (
        "MERL",
        "a database of 100 isotropic materials that were measured at Mitsubishi Electric Research Laboratories (Matusik et al. 2003).",
    ),
    (
        "SGD",
        "shifted gamma distribution: a microfacet model with eleven parameters per colour channel, which its authors fitted to every MERL material (Bagher et al. 2012).",
    ),
    (
        "Levenberg’s method",
        "a way to find the parameters that minimise a sum of squares (K. Levenberg 1944): steps of the Gauss–Newton method, shortened until the sum falls.",
    ),
    (
        "Light with extent",
        "light that fills a part of the directions from which a point is lit: a softbox, a sky. What it does to a surface is an integral over them.",
    ),
    (
        "Log error",
        "root mean square of the difference of natural logarithms between model and data. 0.10 means that the model is typically 10\u{a0}% off, 0.7 a factor of two. Where the text gives it in per cent, that is 100 (exp(error) − 1).",
    ),
];

/// The sources of the report.
const SOURCES: &[&str] = &[
    "Z. Andersson and others (2026). OpenPBR Surface specification 1.1.1. Academy Software Foundation.",
    "M. Bagher, C. Soler, N. Holzschuch (2012). Accurate Fitting of Measured Reflectances Using a Shifted Gamma Micro-Facet Distribution. Computer Graphics Forum 31(4), 1509–1518. Parameters as in dj_brdf (J. Dupuy, public domain).",
    "J. F. Blinn (1977). Models of Light Reflection for Computer Synthesized Pictures. SIGGRAPH ’77, 192–198.",
    "Commission Internationale de l’Éclairage (2003). Spatial Distribution of Daylight: CIE Standard General Sky. CIE S 011, ISO 15469.",
    "R. L. Cook, K. E. Torrance (1982). A Reflectance Model for Computer Graphics. ACM Transactions on Graphics 1(1), 7–24.",
    "Cornell University Program of Computer Graphics. Measured reflectance of paints, as distributed with pbrt-v2 (BSD 2-Clause).",
    "E. Heitz (2014). Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs. Journal of Computer Graphics Techniques 3(2), 48–107.",
    "E. Heitz, J. Dupuy, S. Hill, D. Neubelt (2016). Real-Time Polygonal-Light Shading with Linearly Transformed Cosines. ACM Transactions on Graphics 35(4), 41.",
    "E. James (2022). Physically Based Shading Models in Real-time Rendering. Final report, University of Leeds.",
    "B. Karis (2013). Real Shading in Unreal Engine 4. SIGGRAPH course.",
    "C. Kulla, A. Conty (2017). Revisiting Physically Based Shading at Imageworks. SIGGRAPH course.",
    "J. H. Lambert (1760). Photometria sive de mensura et gradibus luminis, colorum et umbrae. Augsburg.",
    "K. Levenberg (1944). A Method for the Solution of Certain Non-Linear Problems in Least Squares. Quarterly of Applied Mathematics 2(2), 164–168.",
    "J. Löw, J. Kronander, A. Ynnerman, J. Unger (2012). BRDF Models for Accurate and Efficient Rendering of Glossy Surfaces. ACM Transactions on Graphics 31(1), 9.",
    "W. Matusik, H. Pfister, M. Brand, L. McMillan (2003). A Data-Driven Reflectance Model. ACM Transactions on Graphics 22(3), 759–769 (the MERL database).",
    "A. Ngan, F. Durand, W. Matusik (2005). Experimental Analysis of BRDF Models. Eurographics Symposium on Rendering, 117–126.",
    "B. T. Phong (1975). Illumination for Computer Generated Pictures. Communications of the ACM 18(6), 311–317.",
    "M. N. Polyanskiy. Refractiveindex.info database of optical constants (CC0). Each constant names its measurement in the program.",
    "C. Schlick (1994). An Inexpensive BRDF Model for Physically-based Rendering. Computer Graphics Forum 13(3), 233–246.",
    "E. Turquin (2019). Practical Multiple Scattering Compensation for Microfacet Models. Industrial Light & Magic.",
    "E. Veach, L. Guibas (1995). Optimally Combining Sampling Techniques for Monte Carlo Rendering. SIGGRAPH ’95, 419–428.",
    "B. Walter, S. Marschner, H. Li, K. Torrance (2007). Microfacet Models for Refraction through Rough Surfaces. EGSR 2007, 195–206.",
    "G. J. Ward (1992). Measuring and Modeling Anisotropic Reflection. SIGGRAPH ’92, 265–272.",
];

/// The whole page: the phenomena, and the chapters beyond them with their ids.
pub(super) fn page(chapters: &[Chapter], beyond: &[(&str, Chapter)], settings: Settings) -> String {
    let shown = chapters.iter().filter(|c| c.shown).count();
    let threads = rayon::current_num_threads();
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="generator" content=(format!("{GENERATOR}{}", env!("CARGO_PKG_VERSION")));
                title { "Physically based shading against Blinn–Phong: results" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    p .kicker { "Lights, Camera, Models! · study" }
                    h1 { "What physically based shading reproduces and Blinn–Phong does not" }
                    p .meta {
                        "Version " (env!("CARGO_PKG_VERSION")) " · " (today())
                        @if settings.quick { " · quick run: small pictures, a tenth of the materials, fewer samples" }
                    }
                }
                main {
                    (summary(chapters, beyond, shown))
                    @for (i, chapter) in chapters.iter().enumerate() {
                        section #(format!("phenomenon-{}", i + 1)) {
                            h2 { (i + 1) ". " (chapter.title) }
                            (chapter.body)
                        }
                    }
                    (discussion(chapters, shown))
                    @for (i, (id, chapter)) in beyond.iter().enumerate() {
                        section id=(id) {
                            // The discussion of the phenomena comes in between.
                            h2 { (chapters.len() + 2 + i) ". " (chapter.title) }
                            (chapter.body)
                        }
                    }
                    (appendix(settings, threads, chapters.iter().chain(beyond.iter().map(|(_, c)| c))))
                }
            }
        }
    };
    page.into_string()
}

fn summary(chapters: &[Chapter], beyond: &[(&str, Chapter)], shown: usize) -> Markup {
    html! {
        section #summary {
            h2 { "Summary" }
            p {
                "E. James (2022) asks how physically based shading makes frames more photorealistic than the Blinn–Phong "
                "shading that it replaced. To answer independently of taste, that report proposes to look for physical "
                "phenomena that one kind of model reproduces and the other does not. It ends before its results. This "
                "study supplies them: four phenomena, each with a question, a method, pictures of the same scene under both "
                "kinds of model, measurements, and a conclusion."
            }
            p {
                @if shown == chapters.len() { "All four phenomena are" } @else { (count(shown)) " of the four phenomena is or are" } " shown by the numbers below:"
            }
            ol {
                @for (i, chapter) in chapters.iter().enumerate() {
                    li {
                        a href=(format!("#phenomenon-{}", i + 1)) { (chapter.title) }
                        ". " (chapter.finding)
                    }
                }
            }
            p { "Two more chapters go beyond the comparison: one takes a standard of today apart, one lights three materials by more than points." }
            ul {
                @for (id, chapter) in beyond {
                    li { a href=(format!("#{id}")) { (chapter.title) } ". " (chapter.finding) }
                }
            }
        }
        section #method {
            h2 { "Common method" }
            p {
                "Every model is a function of the direction l to the light and v to the viewer. The classical models "
                "give a colour per unit of light intensity, the physically based ones a BRDF f. To exchange them under the "
                "same lights, the program uses one quantity for all, the response π f(l, v) cos θ, where θ is the angle between l "
                "and the normal n. A white matte surface that faces a light has response 1 under every model. Where this "
                "report needs the BRDF of a classical model, it is its response divided by π cos θ."
            }
            p {
                "Pictures are calculated by the program’s CPU renderer with four samples per pixel and shading per pixel. "
                "It shares no code with the shaders of the GPU, and tests compare the pictures of both. "
                "Numbers taken from pictures are linear light, before the display’s encoding. There are no shadows and no light "
                "from one object to another: the study covers only the reflection at a surface. Raw numbers lie beside "
                "this page as CSV files."
            }
        }
        aside #glossary {
            h2 { "Words" }
            dl {
                @for (word, meaning) in GLOSSARY { dt { (word) } dd { (meaning) } }
            }
        }
    }
}

fn count(n: usize) -> &'static str {
    ["None", "One", "Two", "Three", "Four"].get(n).copied().unwrap_or("All")
}

fn discussion(chapters: &[Chapter], shown: usize) -> Markup {
    html! {
        section #discussion {
            h2 { "5. The phenomena together" }
            p {
                @if shown == chapters.len() {
                    "In all four cases the difference lies in the equations and not in taste: it has a sign and a size. "
                    "The four have a common cause. Blinn–Phong’s highlight is a curve with a free height and a free "
                    "width. Nothing ties its height to the angle of view (phenomenon 1), to the energy that arrives "
                    "(phenomenon 2), to the direction of the light (phenomenon 3), or its flanks to how "
                    "measured surfaces scatter (phenomenon 4). A microfacet model has as many numbers to "
                    "set, but each has a meaning outside the picture, and the ties are part of the equation."
                } @else {
                    "Not every phenomenon is confirmed by the numbers of this run (see the conclusions above), so the "
                    "question of the thesis has no simple answer here: what follows holds for the "
                    (count(shown).to_lowercase()) " that are."
                }
            }
            p {
                "The answer to the thesis's question is therefore: physically based shading is more photorealistic "
                "in the sense that a surface keeps behaving like one surface when the viewer or the light moves. A single "
                "frame from a single direction can often be matched by Blinn–Phong, as phenomenon 3 does on purpose; the "
                "match need not survive the change. “Physically based” does not guarantee quality either: phenomenon 2 lists which of these models "
                "lose or gain light, and phenomenon 4 the errors that remain after the best fit."
            }
            h3 { "Limits" }
            ul {
                li { "Local reflection only: no shadows, no interreflection. In the chapters up to here all light comes from points, from one direction, or equally from everywhere." }
                li { "Three wavelengths stand for the spectrum. Optical constants are those of clean, smooth samples; real gold objects are alloys." }
                li { "Phenomenon 3 takes the physically based picture as reference, not a photograph. Its last part repeats the question with measured paints, for which neither model is the reference." }
                li { "The 100 MERL materials enter as published fits of another model (SGD), not as measurements. A model that resembles SGD has an advantage. The three Cornell paints are measurements, but only three." }
                li { "Two interference paints of the Cornell set (Cayman, Mystique) are left out: their colour changes with angle, which no model here describes." }
                li { "Error measures weigh. The log error counts dim directions as much as bright ones; a measure in linear light would stress the peak of the highlight." }
                li { "No user study was made. A numerically large difference need not disturb a viewer." }
            }
        }
    }
}

fn appendix<'a>(settings: Settings, threads: usize, chapters: impl Iterator<Item = &'a Chapter>) -> Markup {
    html! {
        section #settings {
            h2 { "Versions and settings" }
            table .settings {
                tbody {
                    tr { th scope="row" { "Program" } td { "Lights, Camera, Models! " (env!("CARGO_PKG_VERSION")) ", " code { "lcm study" @if settings.quick { " --quick" } } } }
                    tr { th scope="row" { "Date" } td { (today()) } }
                    tr { th scope="row" { "Machine" } td { (std::env::consts::ARCH) ", " (std::env::consts::OS) ", " (threads) @if threads == 1 { " thread" } @else { " threads" } } }
                    tr { th scope="row" { "Renderer" } td { "CPU, four samples per pixel, Phong shading (normals interpolated, colour per pixel)" } }
                    tr { th scope="row" { "Pictures" } td { @if settings.quick { "a quarter of the usual size" } @else { "480 × 320 pixels; rows of objects 960 or 1200 pixels wide; balls 160 × 160" } "; sRGB, no tone mapping" } }
                    tr { th scope="row" { "Precision" } td { "models in 32-bit floating point; fits and integrals in 64-bit" } }
                    tr { th scope="row" { "Scenes" } td { code { "scenes/fresnel_effect.json" } ", " code { "white_furnace.json" } ", " code { "gold_three_lights.json" } ", " code { "lobe_shape.json" } ": " code { "lcm view" } " opens them" } }
                    tr { th scope="row" { "Numbers" } td {
                        @for (i, table) in chapters.flat_map(|c| &c.tables).enumerate() {
                            @if i > 0 { ", " } code { (table.name) ".csv" }
                        }
                    } }
                }
            }
        }
        section #sources {
            h2 { "Sources" }
            ul .sources { @for source in SOURCES { li { (source) } } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        for (days, expected) in [
            (0, "1 January 1970"),
            (19_782, "29 February 2024"),
            (19_783, "1 March 2024"),
            (20_453, "31 December 2025"),
        ] {
            assert_eq!(date(days), expected);
        }
    }
}
