//! A shell that is set up for another PROJ, as by conda, does not disturb a released program, and a
//! program built from source names the cause.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
};

use e2e::{Ran, binary, sample, skip, text};

/// The folder with the tables of this computer's PROJ.
fn tables_of_proj() -> Option<PathBuf> {
    let named = env::var_os("PROJ_DATA").unwrap_or_default();
    let usual = ["/usr/share/proj", "/usr/local/share/proj", "/opt/homebrew/share/proj"];
    let mut folders = env::split_paths(&named).chain(usual.map(PathBuf::from));
    folders.find(|folder| folder.join("proj.db").is_file())
}

#[test]
fn tables_of_another_proj_do_not_disturb_a_released_program() {
    let Some(tables) = tables_of_proj() else { return skip("the tables of PROJ are not found") };
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    // The layout of a released archive, around this program.
    let program = file("bin/corniche");
    fs::create_dir_all(file("bin")).unwrap();
    fs::create_dir_all(file("lib/corniche/share")).unwrap();
    fs::hard_link(binary(), &program).or_else(|_| fs::copy(binary(), &program).map(drop)).unwrap();
    std::os::unix::fs::symlink(&tables, file("lib/corniche/share/proj")).unwrap();
    // A database without tables does not belong to this PROJ.
    fs::create_dir(file("foreign")).unwrap();
    fs::write(file("foreign/proj.db"), "").unwrap();
    let (dem, plan) = (sample("pass/pass-dem.tif"), file("plan.json"));
    for variable in ["PROJ_DATA", "PROJ_LIB"] {
        let run = |program: &Path| -> Ran {
            let mut command = Command::new(program);
            command.args(["plan", "-q", "-O", "--dem", text(&dem), "-o", text(&plan)]);
            command.env_remove("PROJ_DATA").env(variable, file("foreign")).output().unwrap().into()
        };
        let released = run(&program);
        assert_eq!(released.code, 0, "{variable}: {}", released.err);
        let from_source = run(&binary());
        assert_eq!(from_source.code, 2, "{variable}: {}", from_source.err);
        let words = format!("{variable} is set to ");
        assert!(from_source.err.contains(&words), "{}", from_source.err);
    }
}
