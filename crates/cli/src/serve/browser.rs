//! Opens a URL in the browser of this computer.

#[cfg(unix)]
use std::os::unix::process::CommandExt as _;
use std::{
    env,
    path::Path,
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

/// The environment variable of the browser, as for other programs: commands separated by `:`, of
/// which the first that succeeds is used. In a command, `%s` is replaced by the URL, which is
/// appended if there is no `%s`, and `%%` by a percent sign.
const BROWSER: &str = "BROWSER";

/// Commands that open URLs, by system; the first that exists and does not fail at once is used.
const OPENERS: &[&[&str]] = if cfg!(target_os = "macos") {
    &[&["open"]]
} else {
    &[&["xdg-open"], &["gio", "open"], &["wslview"], &["x-www-browser"]]
};

/// A command that finds no browser fails within this time; a browser itself keeps running.
const FAILS_WITHIN: Duration = Duration::from_secs(1);
const LOOKS_EVERY: Duration = Duration::from_millis(20);

/// Opens the URL in a browser; returns whether this seems to have succeeded.
pub(crate) fn open(url: &str) -> bool {
    let named = env::var_os(BROWSER).unwrap_or_default();
    let named = named_commands(&named.to_string_lossy(), url, &|name| Path::new(name).is_file());
    let found = OPENERS.iter().map(|words| {
        words.iter().chain([&url]).map(|&word| word.to_owned()).collect::<Vec<String>>()
    });
    named.into_iter().chain(found).any(|words| starts(&words))
}

/// The commands in the variable, each split into words.
fn named_commands(named: &str, url: &str, is_file: &dyn Fn(&str) -> bool) -> Vec<Vec<String>> {
    let commands = named.split(':').map(str::trim).filter(|command| !command.is_empty());
    commands.map(|command| words_with_address(command, url, is_file(command))).collect()
}

/// The words of a command, with the URL. A program whose path has spaces is one word.
fn words_with_address(command: &str, url: &str, is_program: bool) -> Vec<String> {
    if is_program {
        return vec![command.to_owned(), url.to_owned()];
    }
    let mut words: Vec<&str> = command.split_whitespace().collect();
    // In a shell, `&` lets the browser run in the background, as it always does here.
    if words.len() > 1 && words.last() == Some(&"&") {
        words.pop();
    }
    // Percent signs of the URL itself are kept.
    let with_address = |word: &str| {
        word.split("%%").map(|part| part.replace("%s", url)).collect::<Vec<_>>().join("%")
    };
    let mut filled: Vec<String> = words.iter().map(|word| with_address(word)).collect();
    if !words.iter().any(|word| word.replace("%%", "").contains("%s")) {
        filled.push(url.to_owned());
    }
    filled
}

fn starts(words: &[String]) -> bool {
    let Some((program, others)) = words.split_first() else { return false };
    let mut command = Command::new(program);
    // The output of a browser is of no interest here.
    command.args(others).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    // A terminal sends Ctrl-C to the whole process group of the server, but the browser must keep
    // running.
    #[cfg(unix)]
    command.process_group(0);
    command.spawn().is_ok_and(|child| !fails_at_once(child))
}

fn fails_at_once(mut child: Child) -> bool {
    let begun = Instant::now();
    while begun.elapsed() < FAILS_WITHIN {
        match child.try_wait() {
            Ok(Some(status)) => return !status.success(),
            Ok(None) => thread::sleep(LOOKS_EVERY),
            Err(_) => return true,
        }
    }
    false
}

#[cfg(test)]
#[path = "browser_tests.rs"]
mod tests;
