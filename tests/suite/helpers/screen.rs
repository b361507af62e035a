//! A virtual screen: programs with windows run on it, and their output can be examined while they run.

#![cfg(target_os = "linux")]

use std::{
    fs,
    io::{BufRead as _, BufReader},
    ops::Range,
    path::{Path, PathBuf},
    process::{Child, Command, Output, Stdio},
    thread,
    time::{Duration, Instant},
};

/// A separate virtual screen, closed when dropped.
pub struct Screen {
    server: Child,
    display: String,
    /// The folder in which the server stores its framebuffer, readable by all.
    memory: tempfile::TempDir,
}

impl Screen {
    pub fn new(width: u32, height: u32) -> Self {
        let memory = tempfile::tempdir().expect("a folder");
        // The server picks a free number and writes it to its standard output.
        let mut server = Command::new("Xvfb")
            .args([
                "-displayfd",
                "1",
                "-screen",
                "0",
                &format!("{width}x{height}x24"),
                "-nolisten",
                "tcp",
                "-noreset",
            ])
            .arg("-fbdir")
            .arg(memory.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb is installed; scripts/test installs it");
        let mut line = String::new();
        let output = server.stdout.take().expect("piped");
        BufReader::new(output).read_line(&mut line).expect("Xvfb says its number");
        Self { server, display: format!(":{}", line.trim()), memory }
    }

    /// The display name for programs.
    pub fn display(&self) -> &str {
        &self.display
    }

    /// The process of the server.
    pub fn process(&self) -> u32 {
        self.server.id()
    }

    /// Runs the program until it ends.
    pub fn lcm(&self, arguments: &[&str], config: &Path) -> Output {
        self.command(arguments, config).output().expect("lcm runs")
    }

    /// The program on this screen, not yet started.
    pub fn command(&self, arguments: &[&str], config: &Path) -> Command {
        let mut command = lcm(arguments, config);
        command.env("DISPLAY", &self.display);
        command
    }

    /// Starts the program, and leaves it running until the result is dropped.
    pub fn start(&self, arguments: &[&str]) -> Running<'_> {
        self.start_with(|config| lcm(arguments, config))
    }

    /// Starts a program with a folder for its settings, and leaves it running until the result is dropped.
    pub fn start_with(&self, command: impl FnOnce(&Path) -> Command) -> Running<'_> {
        let folder = tempfile::tempdir().expect("a folder");
        let said = folder.path().join("said");
        let file = fs::File::create(&said).expect("writable");
        let program = command(folder.path())
            .env("DISPLAY", &self.display)
            .stderr(file)
            .spawn()
            .expect("the program starts");
        Running { screen: self, program, said, _folder: folder }
    }

    /// The present content of the screen.
    pub fn look(&self) -> Picture {
        Picture::from_xwd(&self.framebuffer())
    }

    /// That content as the server keeps it.
    fn framebuffer(&self) -> Vec<u8> {
        fs::read(self.memory.path().join("Xvfb_screen0")).expect("the server keeps its picture there")
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// The program, with a folder for its settings and data, and without any display.
pub fn lcm(arguments: &[&str], config: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lcm"));
    alone(&mut command, config).args(arguments);
    command
}

/// Sets a folder for a program's settings and data, without any display.
pub fn alone<'a>(command: &'a mut Command, config: &Path) -> &'a mut Command {
    command
        .env("LCM_CONFIG_DIR", config)
        .env("LCM_DATA_DIR", config.join("data"))
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .env_remove("DISPLAY")
        .stdin(Stdio::null())
}

/// A program with an open window; killed when dropped.
pub struct Running<'a> {
    screen: &'a Screen,
    program: Child,
    said: PathBuf,
    _folder: tempfile::TempDir,
}

impl Running<'_> {
    /// Software Vulkan on a busy machine takes its time.
    const DEADLINE: Duration = Duration::from_secs(60);

    /// How long a picture that stays the same is not looked at again, which would take time from the program.
    const SAME: Duration = Duration::from_millis(200);

    /// The program's standard error so far.
    pub fn said(&self) -> String {
        fs::read_to_string(&self.said).expect("readable")
    }

    /// Asks the program to end, as Ctrl+C does, and waits until it has. Returns its standard error.
    pub fn ended(mut self) -> String {
        let ask = format!("kill -INT {}", self.program.id());
        assert!(Command::new("sh").args(["-c", &ask]).status().expect("a shell").success());
        let asked = Instant::now();
        while self.program.try_wait().expect("the state of a child is known").is_none() {
            assert!(asked.elapsed() < Self::DEADLINE, "Ctrl+C does not end it; is SIGINT ignored here?");
            thread::sleep(Duration::from_millis(20));
        }
        self.said()
    }

    /// Waits until the screen satisfies a condition.
    pub fn until(&mut self, what: &str, mut shows: impl FnMut(&Picture) -> bool) -> Picture {
        let begin = Instant::now();
        let (mut last, mut looked) = (Vec::new(), begin);
        loop {
            let now = self.screen.framebuffer();
            if now != last || looked.elapsed() > Self::SAME {
                looked = Instant::now();
                let picture = Picture::from_xwd(&now);
                if shows(&picture) {
                    return picture;
                }
                last = now;
            }
            let ended = self.program.try_wait().expect("the state of a child is known");
            if ended.is_some() || begin.elapsed() > Self::DEADLINE {
                let picture = Picture::from_xwd(&last);
                let file = std::env::temp_dir().join("lcm_screen.png");
                picture.write(&file);
                panic!("never showed {what}; {}; ended: {ended:?}; said: {}", file.display(), self.said());
            }
            thread::sleep(Duration::from_millis(20));
        }
    }

    /// Waits until the screen has not changed for a moment.
    pub fn rest(&mut self) -> Picture {
        let begin = Instant::now();
        let mut last = self.screen.look();
        let mut since = Instant::now();
        while since.elapsed() < Duration::from_millis(400) {
            assert!(begin.elapsed() < Self::DEADLINE, "the screen never rests");
            thread::sleep(Duration::from_millis(20));
            let now = self.screen.look();
            if now.pixels != last.pixels {
                (last, since) = (now, Instant::now());
            }
        }
        last
    }

    /// Processor time that the program has used, in ticks of the clock (usually of 10 ms).
    pub fn ticks(&self) -> u64 {
        let stat = fs::read_to_string(format!("/proc/{}/stat", self.program.id())).expect("it runs");
        // The name in parentheses may contain anything; user and system time are the 14th and 15th fields.
        let fields = stat.rsplit(')').next().unwrap_or_default();
        fields.split_whitespace().skip(11).take(2).map(|t| t.parse::<u64>().expect("a number")).sum()
    }
}

impl Drop for Running<'_> {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

/// A picture of a window or a screen: width, height, RGB.
pub struct Picture {
    pub width: u32,
    pub height: u32,
    pub pixels: Vec<u8>,
}

impl Picture {
    /// Reads a PNG file.
    pub fn read(path: &Path) -> Self {
        let decoder = png::Decoder::new(BufReader::new(fs::File::open(path).expect("the capture exists")));
        let mut reader = decoder.read_info().expect("a PNG file");
        let mut pixels = vec![0; reader.output_buffer_size().expect("not huge")];
        let info = reader.next_frame(&mut pixels).expect("a whole picture");
        assert_eq!(info.color_type, png::ColorType::Rgb);
        Self { width: info.width, height: info.height, pixels }
    }

    /// Reads the framebuffer of an X server as described in `XWDFile.h`: a header of 32-bit numbers, the most
    /// significant byte first; a table of colours; the pixels.
    fn from_xwd(bytes: &[u8]) -> Self {
        let number = |i: usize| {
            let field: [u8; 4] = bytes[4 * i..4 * i + 4].try_into().expect("four bytes");
            u32::from_be_bytes(field) as usize
        };
        let (header, version, width, height) = (number(0), number(1), number(4), number(5));
        let (bits, stride, colours) = (number(11), number(12), number(19));
        assert_eq!((version, number(7), bits), (7, 0, 32), "version, byte order and bits of a pixel");
        let begin = header + 12 * colours;
        let row = |y: usize| &bytes[begin + y * stride..][..4 * width];
        // Tests that wait look all the time.
        let mut pixels = vec![0; 3 * width * height];
        for (y, to) in pixels.chunks_exact_mut(3 * width).enumerate() {
            for (to, p) in to.chunks_exact_mut(3).zip(row(y).chunks_exact(4)) {
                to.copy_from_slice(&[p[2], p[1], p[0]]);
            }
        }
        Self { width: width as u32, height: height as u32, pixels }
    }

    pub fn write(&self, path: &Path) {
        let file = fs::File::create(path).expect("writable");
        let mut encoder = png::Encoder::new(file, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().expect("writable");
        writer.write_image_data(&self.pixels).expect("writable");
    }

    pub fn at(&self, x: u32, y: u32) -> [u8; 3] {
        let i = ((y * self.width + x) * 3) as usize;
        [self.pixels[i], self.pixels[i + 1], self.pixels[i + 2]]
    }

    fn part(&self, x: Range<u32>, y: Range<u32>) -> impl Iterator<Item = [u8; 3]> + '_ {
        y.flat_map(move |y| x.clone().map(move |x| (x, y))).map(|(x, y)| self.at(x, y))
    }

    /// The number of different colours in an area.
    pub fn colours(&self, x: Range<u32>, y: Range<u32>) -> usize {
        let mut seen: Vec<_> = self.part(x, y).collect();
        seen.sort_unstable();
        seen.dedup();
        seen.len()
    }

    /// The number of pixels in an area that satisfy a condition.
    pub fn count(&self, x: Range<u32>, y: Range<u32>, is: impl Fn([u8; 3]) -> bool) -> usize {
        self.part(x, y).filter(|p| is(*p)).count()
    }
}
