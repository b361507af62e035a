//! Curves as CSV.

use std::fmt::Write as _;

use glam::Vec3;

use super::{Channel, Kind, Setup, Sheet, sample::viewer};

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
    /// is in sr⁻¹; non-finite values are `NaN` or `inf`, as `lcm evaluate` writes them.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text = String::from("curve,");
        let value = match self.setup.kind {
            Kind::Brdf | Kind::Polar | Kind::Slice => "f",
            Kind::BrdfCos => "f_cos",
            Kind::Response => "pi_f_cos",
            Kind::Albedo => "e",
            Kind::Fresnel => "fresnel",
            Kind::Distribution => "d",
            Kind::Masking => "g",
        };
        text += match self.setup.kind {
            Kind::Slice => "theta_h,theta_d,",
            Kind::Albedo => "angle,mu,",
            Kind::Fresnel | Kind::Distribution => "angle,",
            _ => "angle,theta_i,phi_i,theta_o,phi_o,",
        };
        if self.setup.kind.is_scalar() {
            text += value;
        } else {
            text += &format!("{value}_r,{value}_g,{value}_b,luminance");
        }
        text.push('\n');
        for curve in &self.curves {
            let name = cell(&curve.name);
            for point in &curve.points {
                let angles = self.angles(point.angle);
                self.row(&mut text, &name, &angles, point.rgb);
            }
        }
        for slice in &self.slices {
            let name = cell(&slice.name);
            for (i, f) in slice.values.iter().enumerate() {
                let (theta_h, theta_d) = slice.angles(i);
                self.row(&mut text, &name, &format!("{theta_h},{theta_d}"), *f);
            }
        }
        text
    }

    fn angles(&self, angle: f64) -> String {
        let Setup { kind, theta_i, phi_i } = self.setup;
        match kind {
            Kind::Albedo => format!("{angle},{}", angle.to_radians().cos()),
            Kind::Fresnel | Kind::Distribution => format!("{angle}"),
            _ => {
                let (theta_o, phi_o) = viewer(angle, phi_i);
                format!("{angle},{theta_i},{phi_i},{theta_o},{phi_o}")
            }
        }
    }

    fn row(&self, text: &mut String, name: &str, angles: &str, rgb: Vec3) {
        // Writing to a string cannot fail.
        let _ = if self.setup.kind.is_scalar() {
            writeln!(text, "{name},{angles},{}", rgb.x)
        } else {
            let luminance = Channel::Luminance.of(rgb) as f32;
            writeln!(text, "{name},{angles},{},{},{},{luminance}", rgb.x, rgb.y, rgb.z)
        };
    }
}
