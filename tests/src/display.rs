//! A display without a screen (Xvfb) for tests that open windows, with keys and mouse.

use std::{
    io::{BufRead as _, BufReader},
    process::{Child, Command, Stdio},
};

use crate::skip;

/// A server is tried so often.
const STARTS: u32 = 5;

/// A display without a screen (Xvfb); it ends with this.
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
    /// `None`, and says why, where there is no Xvfb or no xdotool.
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
        // Servers that start at one time may take each other's number from them, and then one cannot be reached.
        let mut displays = (0..STARTS).map(|_| Self::of_new_server());
        let reached = displays.find(|display| display.try_xdotool("getdisplaygeometry").is_some());
        assert!(reached.is_some(), "none of {STARTS} servers can be reached");
        reached
    }

    fn of_new_server() -> Self {
        // The server chooses a free number itself. Without the last option it begins again whenever its last client goes,
        // and whoever comes then is turned away.
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

    /// Lets a command's windows open here and nowhere else.
    pub fn lend<'a>(&self, command: &'a mut Command) -> &'a mut Command {
        without_display(command).env("DISPLAY", &self.name)
    }

    /// What `xdotool` says to a command; `None` when it cannot be followed.
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

    /// The same for a command that must be followed.
    ///
    /// # Panics
    /// When it is not.
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
    /// When there is none.
    #[must_use]
    pub fn window(&self) -> String {
        let found = self.xdotool("search --name Corniche");
        match found.lines().last() {
            Some(id) => id.to_owned(),
            None => panic!("no window has its name"),
        }
    }
}

/// Leaves a command without any display to open a window on.
pub fn without_display(command: &mut Command) -> &mut Command {
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET")
}
