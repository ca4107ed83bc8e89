//! What `alhazen doctor` finds.

use crate::common::{Finished, Folder};

#[cfg(unix)]
#[test]
fn it_finds_the_denoiser() {
    let folder = Folder::new("doctor-denoiser");
    let found = || {
        let mut command = folder.command(&["doctor", "--json"]);
        let finished: Finished =
            command.env("PATH", folder.path()).output().expect("the program runs").into();
        finished.expect(0).json()["checks"]["denoiser"]["path"].clone()
    };
    assert!(found().is_null());
    folder.write("oidnDenoise", "");
    assert_eq!(found().as_str(), folder.path().join("oidnDenoise").to_str());
}

#[test]
fn it_finds_what_renders_use() {
    let folder = Folder::new("doctor");
    let json = folder.alhazen(&["doctor", "--json"]).expect(0).json();
    assert_eq!(json["status"], "done");
    let version = folder.alhazen(&["--version"]).expect(0).out;
    assert_eq!(format!("alhazen {}", json["version"].as_str().unwrap()), version.trim_end());
    let checks = &json["checks"];
    assert!(checks["threads"]["available"].as_u64().unwrap() >= 1);
    assert_eq!(checks["folder"]["writable"], true);
    assert_eq!(folder.files(), Vec::<String>::new(), "it leaves nothing behind");
    let text = folder.alhazen(&["doctor"]).expect(0).out;
    for name in checks.as_object().unwrap().keys() {
        assert!(text.contains(&format!("\n  {}", name.replace('_', " "))), "{name}: {text}");
    }
}

#[test]
fn an_instruction_set_that_was_chosen_is_named() {
    let folder = Folder::new("doctor-set");
    let doctor = |set: &str| -> Finished {
        let mut command = folder.command(&["doctor", "--json"]);
        command.env("ALHAZEN_INSTRUCTION_SET", set).output().expect("the program runs").into()
    };
    let set = doctor("scalar").expect(0).json()["checks"]["instruction_set"].clone();
    assert_eq!(set["used"], "scalar");
    assert!(set["note"].as_str().unwrap().contains("ALHAZEN_INSTRUCTION_SET"), "{set}");
    let best = doctor(set["best"].as_str().unwrap()).expect(0).json();
    assert!(best["checks"]["instruction_set"]["note"].is_null(), "{best}");
}

#[cfg(target_os = "linux")]
#[test]
fn limits_and_obstacles_say_what_follows() {
    let mut command = std::process::Command::new("sh");
    command.args(["-c", "ulimit -v 1000000 && exec \"$0\" doctor --json", env!("CARGO_BIN_EXE_alhazen")]);
    // Not even the owner of the system can write there.
    let finished: Finished = command.current_dir("/proc").output().expect("the program runs").into();
    let checks = finished.expect(0).json()["checks"].clone();
    assert_eq!(checks["memory"]["limit_bytes"], 1_024_000_000);
    assert!(checks["memory"]["note"].as_str().unwrap().contains("ends with an error"));
    assert_eq!(checks["folder"]["writable"], false);
    assert!(checks["folder"]["note"].as_str().unwrap().contains("--output"), "{checks}");
}
