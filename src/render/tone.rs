//! The tables of tone curves for Bevy's pass.

use bevy::{
    asset::RenderAssetUsages,
    core_pipeline::tonemapping::{TonemappingLuts, lut_placeholder},
    image::{
        CompressedImageFormats, ImageAddressMode, ImageFilterMode, ImageSampler, ImageSamplerDescriptor,
        ImageType,
    },
    prelude::*,
};

use crate::optics::tone::ToneMapping;

/// Gives Bevy the tables of [`ToneMapping`] where it was built without its own, which are the same: a site would load
/// them twice.
pub(super) fn plugin(app: &mut App) {
    let world = app.world_mut();
    let Some(luts) = world.get_resource::<TonemappingLuts>().cloned() else { return };
    let mut images = world.resource_mut::<Assets<Image>>();
    let given = [
        (ToneMapping::AgX, luts.agx),
        (ToneMapping::TonyMcMapface, luts.tony_mc_mapface),
        (ToneMapping::BlenderFilmic, luts.blender_filmic),
    ];
    let placeholder = lut_placeholder();
    let [agx, tony_mc_mapface, blender_filmic] = given.map(|(tone, known)| {
        let missing = images.get(&known).is_none_or(|image| image.data == placeholder.data);
        match missing.then(|| image(tone)).flatten() {
            Some(image) => images.add(image),
            None => known,
        }
    });
    world.insert_resource(TonemappingLuts { agx, tony_mc_mapface, blender_filmic });
}

/// The table of a curve, looked up as Bevy's pass expects it.
fn image(tone: ToneMapping) -> Option<Image> {
    let edge = ImageAddressMode::ClampToEdge;
    let smooth = ImageFilterMode::Linear;
    let sampler = ImageSamplerDescriptor {
        address_mode_u: edge,
        address_mode_v: edge,
        address_mode_w: edge,
        mag_filter: smooth,
        min_filter: smooth,
        mipmap_filter: smooth,
        ..default()
    };
    Image::from_buffer(
        tone.table()?,
        ImageType::Extension("ktx2"),
        CompressedImageFormats::NONE,
        false,
        ImageSampler::Descriptor(sampler),
        // A lost graphics card is given the tables again.
        RenderAssetUsages::default(),
    )
    .ok()
}

#[cfg(test)]
mod tests {
    use bevy::render::render_resource::TextureFormat;

    use super::*;

    #[test]
    fn tables_take_the_place_of_missing_ones_and_of_no_others() {
        let other = |side| Image::new_target_texture(side, side, TextureFormat::Rgba8Unorm, None);
        for (missing, table) in [(true, lut_placeholder()), (false, other(2)), (false, other(1))] {
            let mut app = App::new();
            let mut images = Assets::<Image>::default();
            let size = table.size();
            let known = images.add(table);
            let (agx, tony_mc_mapface, blender_filmic) = (known.clone(), known.clone(), known);
            app.insert_resource(images).insert_resource(TonemappingLuts {
                agx,
                tony_mc_mapface,
                blender_filmic,
            });
            plugin(&mut app);
            let (images, luts) =
                (app.world().resource::<Assets<Image>>(), app.world().resource::<TonemappingLuts>());
            for (handle, edge) in [(&luts.agx, 32), (&luts.tony_mc_mapface, 48), (&luts.blender_filmic, 64)] {
                let found = images.get(handle).expect("kept").size();
                assert_eq!(found, if missing { UVec2::splat(edge) } else { size });
            }
        }
    }
}
