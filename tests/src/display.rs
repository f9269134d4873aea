//! A virtual display (Xvfb) for tests that open windows, with keys and mouse.

use std::{
    io::{BufRead as _, BufReader},
    process::{Child, Command, Stdio},
};

use crate::skip;

/// The number of attempts to start a server.
const STARTS: u32 = 5;

/// A virtual display (Xvfb), which ends when this is dropped.
#[derive(Debug)]
pub struct Display {
    name: String,
    server: Child,
}

impl Drop for Display {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

impl Display {
    /// Returns `None`, and prints the reason, if Xvfb or xdotool is not installed.
    ///
    /// # Panics
    /// When Xvfb does not start or cannot be reached.
    #[must_use]
    pub fn start() -> Option<Self> {
        for program in ["Xvfb", "xdotool"] {
            let found = Command::new(program).arg("-version").stdin(Stdio::null()).output();
            if found.is_err() {
                skip(&format!("{program} is not installed"));
                return None;
            }
        }
        // Servers that start at the same time may take each other's number, and then one of them
        // cannot be reached.
        let mut displays = (0..STARTS).map(|_| Self::of_new_server());
        let reached = displays.find(|display| display.try_xdotool("getdisplaygeometry").is_some());
        assert!(reached.is_some(), "none of {STARTS} servers can be reached");
        reached
    }

    fn of_new_server() -> Self {
        // The server chooses a free number itself. Without the last option it restarts whenever its
        // last client disconnects, and rejects clients meanwhile.
        let server = Command::new("Xvfb")
            .args([
                "-displayfd",
                "1",
                "-screen",
                "0",
                "1000x800x24",
                "-nolisten",
                "tcp",
                "-noreset",
            ])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let Ok(mut server) = server else { panic!("Xvfb does not start: {server:?}") };
        let mut number = String::new();
        let told = server.stdout.take().map(|told| BufReader::new(told).read_line(&mut number));
        assert!(matches!(told, Some(Ok(1..))), "Xvfb does not tell its number: {told:?}");
        Self { name: format!(":{}", number.trim()), server }
    }

    /// Makes a command open its windows on this display only.
    pub fn lend<'a>(&self, command: &'a mut Command) -> &'a mut Command {
        without_display(command).env("DISPLAY", &self.name)
    }

    /// The output of an `xdotool` command; `None` if it fails.
    #[must_use]
    pub fn try_xdotool(&self, command: &str) -> Option<String> {
        let output = Command::new("xdotool")
            .args(command.split(' '))
            .env("DISPLAY", &self.name)
            .output()
            .ok()?;
        let said = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        output.status.success().then_some(said)
    }

    /// The output of an `xdotool` command that must succeed.
    ///
    /// # Panics
    /// When the command fails.
    #[expect(clippy::must_use_candidate, reason = "most commands are given for what they do")]
    pub fn xdotool(&self, command: &str) -> String {
        match self.try_xdotool(command) {
            Some(said) => said,
            None => panic!("xdotool {command}: refused"),
        }
    }

    /// The number of Corniche's window.
    ///
    /// # Panics
    /// When there is no such window.
    #[must_use]
    pub fn window(&self) -> String {
        let found = self.xdotool("search --name Corniche");
        match found.lines().last() {
            Some(id) => id.to_owned(),
            None => panic!("no window has its name"),
        }
    }
}

/// Leaves a command without any display.
pub fn without_display(command: &mut Command) -> &mut Command {
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET")
}
