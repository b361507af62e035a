//! The command line of *Lights, Camera, Models!*, implemented in [`lights_camera_models::cli`].

fn main() -> std::process::ExitCode {
    lights_camera_models::cli::main()
}
