use glam::Vec3;

use super::{Declaration, ReflectionModel, built_in};
use crate::{
    optics::{
        Frame, Terms,
        lobes::{Lobe, Lobes},
    },
    parameter::{BASE_COLOUR, TRANSMITTANCE_COLOUR},
    parameters,
};

parameters! {
    /// **Diffuse transmission** — a sheet that scatters light evenly on both of its sides.
    ///
    /// ```text
    /// f_r = s C_b/π      f_t = s C_t/π      s = 1/max(1, C_b + C_t)
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_colour` | C_b | sRGB | 0–255; what is reflected | white |
    /// | `transmittance_colour` | C_t | sRGB | 0–255; what passes through | white |
    ///
    /// Source: J. H. Lambert (1760), *Photometria*, applied to both sides. In each of red, green and blue in which the two
    /// colours add up to more than all light, both are scaled by the same s: two whites are half and half, and the sheet
    /// then absorbs nothing. Sums below 1 are left alone; the rest is absorbed.
    ///
    /// **When to use it**: paper, leaves, cloth and lampshades: their lit side and the glow of the other one. Light goes
    /// straight through the sheet; within a thick one, such as wax or milk, it would spread.
    ///
    /// **Laws**: all hold, over the whole sphere of directions.
    pub struct DiffuseTransmission {
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR,
        /// `C_t`, linear.
        transmittance_colour: colour = TRANSMITTANCE_COLOUR,
    }
}

impl DiffuseTransmission {
    /// The reflected and the transmitted fraction of the light.
    fn shares(&self) -> [Vec3; 2] {
        let scale = (self.base_colour + self.transmittance_colour).max(Vec3::ONE).recip();
        [self.base_colour * scale, self.transmittance_colour * scale]
    }
}

impl ReflectionModel for DiffuseTransmission {
    const DECLARATION: Declaration =
        built_in!("diffuse_transmission", "Diffuse transmission", Transmission).transmitting();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let cos_l = frame.n.dot(l);
        if frame.n.dot(v) <= 0.0 {
            return Terms::default();
        }
        let [reflected, transmitted] = self.shares();
        if cos_l < 0.0 {
            return Terms::through(-cos_l * transmitted);
        }
        Terms::of(cos_l * reflected, Vec3::ZERO)
    }

    fn ambient_response(&self, _v: Vec3, _frame: &Frame) -> Vec3 {
        let [reflected, transmitted] = self.shares();
        reflected + transmitted
    }

    fn lobes(&self) -> Lobes {
        // Both sides get samples, however dark.
        let weight = |share: Vec3| share.element_sum() + 0.1;
        let [reflected, transmitted] = self.shares().map(weight);
        Lobes::new(&[(Lobe::Cosine, reflected), (Lobe::CosineBelow, transmitted)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_much_light_is_shared_and_less_is_left_alone() {
        let of =
            |base_colour, transmittance_colour| DiffuseTransmission { base_colour, transmittance_colour };
        let [front, back] = of(Vec3::ONE, Vec3::ONE).shares();
        assert_eq!((front, back), (Vec3::splat(0.5), Vec3::splat(0.5)));
        let (less, more) = (Vec3::new(0.25, 0.25, 0.75), Vec3::new(0.5, 0.75, 0.75));
        let [front, back] = of(less, more).shares();
        assert_eq!((front, back), (Vec3::new(0.25, 0.25, 0.5), Vec3::new(0.5, 0.75, 0.5)));
        assert_eq!(of(Vec3::ZERO, Vec3::ZERO).shares(), [Vec3::ZERO; 2]);
    }

    #[test]
    fn light_passes_to_the_side_of_the_viewer_alone() {
        let sheet =
            DiffuseTransmission { base_colour: Vec3::splat(0.2), transmittance_colour: Vec3::splat(0.6) };
        let at = |l: Vec3, v: Vec3| sheet.response(l.normalize(), v.normalize(), &Frame::LOCAL);
        let v = Vec3::new(0.3, 0.0, 0.8);
        assert!((at(Vec3::new(1.0, 0.0, 1.0), v).diffuse.x - 0.2 * 0.5f32.sqrt()).abs() < 1e-6);
        assert!((at(Vec3::new(1.0, 0.0, -1.0), v).transmitted.x - 0.6 * 0.5f32.sqrt()).abs() < 1e-6);
        assert_eq!(at(Vec3::Z, -v), Terms::default());
    }
}
