//! Key presses and pointer movements on a virtual screen, with the few necessary requests of the X protocol
//! and of its extension XTEST.

#![cfg(target_os = "linux")]

use std::{
    io::{Read as _, Write as _},
    os::unix::net::UnixStream,
    thread,
    time::Duration,
};

/// Keys by their numbers on a PC keyboard, as in Xvfb.
#[derive(Clone, Copy)]
pub enum Key {
    Escape = 9,
    Two = 11,
    Three = 12,
    Equals = 21,
    Tab = 23,
    Return = 36,
    Q = 24,
    W = 25,
    Control = 37,
    Shift = 50,
    D = 40,
    Z = 52,
    X = 53,
    S = 39,
    H = 43,
    Alt = 64,
    Right = 114,
    Down = 116,
    F5 = 71,
}

/// A keyboard attached to a screen.
pub struct Keyboard {
    server: UnixStream,
    /// Number of the extension.
    xtest: u8,
    /// The window that contains all others.
    root: u32,
}

impl Keyboard {
    /// Connects to the screen with this name, such as ":99".
    pub fn new(display: &str) -> Self {
        let path = format!("/tmp/.X11-unix/X{}", display.trim_start_matches(':'));
        let mut server = UnixStream::connect(path).expect("the server listens");
        // Numbers with the lowest byte first, version 11.0, no password.
        server.write_all(b"l\0\x0b\0\0\0\0\0\0\0\0\0").expect("sent");
        let mut head = [0; 8];
        server.read_exact(&mut head).expect("answered");
        assert_eq!(head[0], 1, "the server refuses");
        let mut facts = vec![0; 4 * usize::from(u16::from_le_bytes([head[6], head[7]]))];
        server.read_exact(&mut facts).expect("answered");
        // The first screen follows the name of the maker and the pixel formats, 8 bytes each.
        let maker = usize::from(u16::from_le_bytes([facts[16], facts[17]])).next_multiple_of(4);
        let root = number(&facts, 32 + maker + 8 * usize::from(facts[21]));
        let mut keyboard = Self { server, xtest: 0, root };
        // QueryExtension.
        let (reply, _) = keyboard.ask(b"\x62\0\x04\0\x05\0\0\0XTEST\0\0\0");
        assert_eq!(reply[8], 1, "the server has the extension XTEST");
        keyboard.xtest = reply[9];
        keyboard
    }

    /// Presses keys together and releases them. They reach the visible window, as if it had been clicked:
    /// without a window manager nobody else does this.
    pub fn press(&mut self, keys: &[Key]) {
        let window = self.window();
        // SetInputFocus.
        self.tell(&[42, 1, 3, 0], &[window, 0]);
        for key in keys {
            self.fake(2, *key);
        }
        for key in keys.iter().rev() {
            self.fake(3, *key);
        }
        // As between two keystrokes of a fast typist.
        thread::sleep(Duration::from_millis(50));
    }

    /// Moves the pointer to a position on the screen, like a tablet.
    pub fn point_at(&mut self, x: i16, y: i16) {
        self.fake_at(6, 0, x, y);
    }

    /// Moves the pointer by an offset, like a mouse.
    pub fn move_by(&mut self, x: i16, y: i16) {
        self.fake_at(6, 1, x, y);
    }

    /// Presses or releases the left button of the pointer.
    pub fn button(&mut self, pressed: bool) {
        self.fake_at(if pressed { 4 } else { 5 }, 1, 0, 0);
    }

    /// The visible window.
    fn window(&mut self) -> u32 {
        // QueryTree.
        let (_, children) = self.ask(&[&[15, 0, 2, 0][..], &self.root.to_le_bytes()].concat());
        let mut children = children.chunks_exact(4).map(|child| number(child, 0));
        children
            // GetWindowAttributes: a visible window has the state 2.
            .find(|child| self.ask(&[&[3, 0, 2, 0][..], &child.to_le_bytes()].concat()).0[26] == 2)
            .expect("a window is shown")
    }

    fn fake(&mut self, event: u8, key: Key) {
        self.fake_at(event, key as u8, 0, 0);
    }

    fn fake_at(&mut self, event: u8, detail: u8, x: i16, y: i16) {
        let head = [self.xtest, 2, 9, 0, event, detail, 0, 0];
        let place = u32::from(x.cast_unsigned()) | u32::from(y.cast_unsigned()) << 16;
        self.tell(&head, &[0, 0, 0, 0, place, 0, 0]);
    }

    fn tell(&mut self, head: &[u8], numbers: &[u32]) {
        let rest: Vec<_> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
        self.server.write_all(&[head, &rest].concat()).expect("sent");
    }

    /// The reply to a request, and the data after it.
    fn ask(&mut self, request: &[u8]) -> ([u8; 32], Vec<u8>) {
        self.server.write_all(request).expect("sent");
        let mut reply = [0; 32];
        loop {
            self.server.read_exact(&mut reply).expect("answered");
            // Anything except a reply or an error is an event, which is ignored.
            assert_ne!(reply[0], 0, "the server refuses {request:?}: {reply:?}");
            if reply[0] == 1 {
                break;
            }
        }
        let mut more = vec![0; 4 * number(&reply, 4) as usize];
        self.server.read_exact(&mut more).expect("answered");
        (reply, more)
    }
}

/// A number in an answer.
fn number(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
}
