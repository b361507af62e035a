//! Curves as CSV.

use std::fmt::Write as _;

use glam::Vec3;

use super::{Channel, Sheet};

/// A cell, in quotation marks if necessary.
fn cell(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

impl Sheet {
    /// Every point as a line of CSV: the name of its curve, its angles in degrees, and its values as
    /// calculated, in all channels, whichever is shown. `angle` is the angle of the horizontal axis. The BRDF
    /// is in sr⁻¹; `sigma` is its standard uncertainty, where a curve knows it; non-finite values are `NaN` or `inf`, as `lcm evaluate` writes them.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text = String::from("curve,");
        let declared = self.setup.kind.declaration();
        let value = declared.column;
        text += declared.horizontal.columns.0;
        text.push(',');
        if self.setup.kind.declaration().is_scalar {
            text += value;
        } else {
            text += &format!("{value}_r,{value}_g,{value}_b,luminance");
        }
        let known = self.curves.iter().any(|curve| !curve.sigma.is_empty());
        text += if known { ",sigma\n" } else { "\n" };
        for curve in &self.curves {
            let name = cell(&curve.name);
            for (i, point) in curve.points.iter().enumerate() {
                let angles = (declared.horizontal.columns.1)(&self.setup, point.angle);
                let sigma = curve.sigma.get(i).map_or_else(String::new, f64::to_string);
                let sigma = if known { format!(",{sigma}") } else { sigma };
                self.row(&mut text, &name, &angles, (point.rgb, &sigma));
            }
        }
        for slice in &self.slices {
            let name = cell(&slice.name);
            for (i, f) in slice.values.iter().enumerate() {
                let (theta_h, theta_d) = slice.angles(i);
                self.row(&mut text, &name, &format!("{theta_h},{theta_d}"), (*f, ""));
            }
        }
        text
    }

    fn row(&self, text: &mut String, name: &str, angles: &str, (rgb, sigma): (Vec3, &str)) {
        // Writing to a string cannot fail.
        let _ = if self.setup.kind.declaration().is_scalar {
            writeln!(text, "{name},{angles},{}{sigma}", rgb.x)
        } else {
            let luminance = Channel::Luminance.of(rgb) as f32;
            writeln!(text, "{name},{angles},{},{},{},{luminance}{sigma}", rgb.x, rgb.y, rgb.z)
        };
    }
}
