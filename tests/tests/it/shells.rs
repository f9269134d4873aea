//! Completions and manual pages: generated, so that they are always up to date.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{collections::BTreeSet, fs, path::Path, process::Command};

use e2e::{corniche, skip, text};

/// The commands in the `--help` of the program or of a command.
fn commands_of(command: &[&str]) -> BTreeSet<String> {
    let help = corniche(command.iter().chain(&["--help"])).out;
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let names = listed
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.split_whitespace().next());
    names.map(str::to_owned).filter(|name| name != "help").collect()
}

fn commands() -> BTreeSet<String> {
    commands_of(&[])
}

/// The long options in the `--help` of a command.
fn options(command: &str) -> BTreeSet<String> {
    let help = corniche(command.split(' ').chain(["--help"])).out;
    let lines = help.lines().map(str::trim_start).filter(|line| line.starts_with('-'));
    let words = lines.flat_map(|line| {
        line.split([' ', ',', '=']).take(4).map(str::to_owned).collect::<Vec<_>>()
    });
    words
        .filter(|word| word.starts_with("--") && word.len() > 2)
        .map(|word| word.trim_end_matches("...").to_owned())
        .collect()
}

/// Bash itself completes commands, options and values with the script.
#[test]
fn bash_completes_commands_options_and_values() {
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("corniche");
    let printed = corniche(["completions", "bash"]);
    assert_eq!((printed.code, printed.err.as_str()), (0, ""));
    fs::write(&script, &printed.out).unwrap();
    let complete = |words: &[&str]| -> Option<BTreeSet<String>> {
        let words: Vec<String> = words.iter().map(|word| format!("'{word}'")).collect();
        let last = words.len() - 1;
        let code = format!(
            "source '{}'; COMP_WORDS=({}); COMP_CWORD={last}; _corniche corniche \"${{COMP_WORDS[{last}]}}\" \
             \"${{COMP_WORDS[{}]}}\"; printf '%s\\n' \"${{COMPREPLY[@]}}\"",
            text(&script),
            words.join(" "),
            last - 1
        );
        let ran = Command::new("bash").args(["--norc", "-c", &code]).output().ok()?;
        let said = String::from_utf8_lossy(&ran.stderr).into_owned();
        assert!(ran.status.success(), "{said}");
        Some(String::from_utf8(ran.stdout).unwrap().lines().map(str::to_owned).collect())
    };
    let Some(offered) = complete(&["corniche", ""]) else { return skip("there is no bash") };
    let commands = commands();
    assert!(commands.len() >= 14 && commands.is_subset(&offered), "{offered:?}");
    assert_eq!(complete(&["corniche", "gro"]).unwrap(), BTreeSet::from(["growth".to_owned()]));
    let offered = complete(&["corniche", "build", "--"]).unwrap();
    let options = options("build");
    assert!(options.contains("--max-error") && options.contains("--log-format"), "{options:?}");
    assert!(options.is_subset(&offered), "{:?}", options.difference(&offered));
    let values = complete(&["corniche", "render", "--roads", ""]).unwrap();
    assert!(values.contains("geo") && !values.contains("sv-no-caps"), "{values:?}");
    let values = complete(&["corniche", "fly", "--roads", ""]).unwrap();
    assert!(values.contains("geo") && values.contains("sv-no-caps"), "{values:?}");
}

#[test]
fn each_shell_has_a_script() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let ran = corniche(["completions", shell]);
        assert!(
            ran.code == 0 && ran.out.contains("corniche") && ran.out.contains("max-error"),
            "{shell}"
        );
    }
    assert_eq!(corniche(["completions", "tcsh"]).code, 2);
}

#[test]
fn each_command_has_a_manual_page_with_its_options() {
    let folder = tempfile::tempdir().unwrap();
    let pages = folder.path().join("new/man1");
    let ran = corniche(["man", text(&pages)]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    // Hyphens are written as \- in manual pages.
    let page = |name: &str| fs::read_to_string(pages.join(name)).unwrap().replace("\\-", "-");
    let whole = page("corniche.1");
    let mut names = BTreeSet::from(["corniche.1".to_owned()]);
    let parts = commands().into_iter().flat_map(|command| {
        let parts = commands_of(&[&command]);
        let parts = parts.into_iter().map(|part| format!("{command} {part}")).collect::<Vec<_>>();
        [vec![command], parts].concat()
    });
    let all: Vec<String> = parts.collect();
    assert!(all.iter().any(|command| command == "export roads"), "{all:?}");
    for command in all {
        let name = format!("corniche-{}.1", command.replace(' ', "-"));
        let text = page(&name);
        for option in options(&command) {
            assert!(text.contains(&option), "{name} has no {option}");
        }
        let is_listed = whole.contains(&format!("corniche-{command}(1)"));
        assert!(is_listed || command.contains(' '), "{command}");
        names.insert(name);
    }
    let written = |folder: &Path| -> BTreeSet<String> {
        fs::read_dir(folder)
            .unwrap()
            .map(|file| file.unwrap().file_name().into_string().unwrap())
            .collect()
    };
    assert_eq!(written(&pages), names);
    assert!(page("corniche-verify.1").contains("P2.bound"), "the checks are on its page");
    let told = page("corniche-render.1").contains("How shadow volumes compute their round caps");
    assert!(told, "what -h leaves out is told");
    if let Ok(shown) =
        Command::new("man").args(["--warnings", "-l"]).arg(pages.join("corniche-build.1")).output()
    {
        assert!(shown.stderr.is_empty(), "{}", String::from_utf8_lossy(&shown.stderr));
    }
    // All existing pages are kept, unless -O is given.
    fs::write(pages.join("corniche-view.1"), b"mine").unwrap();
    fs::remove_file(pages.join("corniche-build.1")).unwrap();
    assert_eq!(corniche(["man", text(&pages)]).code, 3);
    assert_eq!(page("corniche-view.1"), "mine");
    assert!(!pages.join("corniche-build.1").exists());
    assert_eq!(corniche(["man", text(&pages), "-O"]).code, 0);
    assert_eq!(written(&pages), names);
}
