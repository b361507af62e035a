//! The command line of *Lights, Camera, Models!*; all of it is in [`lights_camera_models::cli`].

fn main() -> std::process::ExitCode {
    lights_camera_models::cli::main()
}
