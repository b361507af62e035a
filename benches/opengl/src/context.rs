//! An OpenGL context without a window, using EGL.

use std::error::Error;

use khronos_egl as egl;

const PLATFORM_SURFACELESS_MESA: egl::Enum = 0x31DD;

/// A context of OpenGL 3.3, made current on this thread.
pub fn create() -> Result<glow::Context, Box<dyn Error>> {
    unsafe {
        let library = libloading::Library::new("libEGL.so.1")
            .map_err(|e| format!("there is no EGL ({e}); on Debian and Ubuntu: apt-get install libegl1"))?;
        let egl = egl::DynamicInstance::<egl::EGL1_5>::load_required_from(library)?;
        let display =
            egl.get_platform_display(PLATFORM_SURFACELESS_MESA, egl::DEFAULT_DISPLAY, &[egl::ATTRIB_NONE])?;
        egl.initialize(display)?;
        egl.bind_api(egl::OPENGL_API)?;
        let wanted = [egl::SURFACE_TYPE, 0, egl::RENDERABLE_TYPE, egl::OPENGL_BIT, egl::NONE];
        let config =
            egl.choose_first_config(display, &wanted)?.ok_or("EGL has no configuration for OpenGL")?;
        let version = [
            egl::CONTEXT_MAJOR_VERSION,
            3,
            egl::CONTEXT_MINOR_VERSION,
            3,
            egl::CONTEXT_OPENGL_PROFILE_MASK,
            egl::CONTEXT_OPENGL_CORE_PROFILE_BIT,
            egl::NONE,
        ];
        let context = egl.create_context(display, config, None, &version)?;
        egl.make_current(display, None, None, Some(context))?;
        let gl = glow::Context::from_loader_function(|name| {
            egl.get_proc_address(name).map_or(std::ptr::null(), |f| f as *const _)
        });
        // The context exists as long as the program.
        std::mem::forget(egl);
        Ok(gl)
    }
}
