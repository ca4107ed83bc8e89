//! Helpers of the tests of the command line: the program, temporary folders, and a small scene.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

/// A scene of a few pixels that renders in no time.
pub const SCENE: &str = r#"
LookAt 0 0 -5  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 24 "integer yresolution" 16
Sampler "independent" "integer pixelsamples" 2
Integrator "path" "integer maxdepth" 3
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
Shape "sphere" "float radius" 1
"#;

/// A folder of its own for each test, removed at the end.
pub struct Folder(PathBuf);

impl Folder {
    pub fn new(name: &str) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let (process, count) = (std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(format!("alhazen-cli-{name}-{process}-{count}"));
        fs::create_dir_all(&path).expect("a folder for the test");
        Self(path)
    }

    /// A folder with the small scene as `scene.pbrt`.
    pub fn with_scene(name: &str) -> Self {
        let folder = Self::new(name);
        folder.write("scene.pbrt", SCENE);
        folder
    }

    pub fn path(&self) -> &Path {
        &self.0
    }

    pub fn write(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).expect("a file for the test");
    }

    pub fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).expect("the test's folder");
        let mut names: Vec<_> = entries
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_alhazen"));
        command.current_dir(&self.0).args(arguments).stdin(Stdio::null()).env_remove("NO_COLOR");
        command
    }

    /// Runs the program in the folder.
    pub fn alhazen(&self, arguments: &[&str]) -> Finished {
        self.command(arguments).output().expect("the program runs").into()
    }

    /// Runs the program in the folder with a text on its standard input.
    pub fn alhazen_reading(&self, arguments: &[&str], text: &str) -> Finished {
        let mut command = self.command(arguments);
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program runs");
        let mut input = child.stdin.take().expect("standard input");
        input.write_all(text.as_bytes()).expect("the program reads");
        drop(input);
        child.wait_with_output().expect("the program ends").into()
    }

    pub fn image(&self, name: &str) -> alhazen::image::Image {
        alhazen::image::open(self.0.join(name)).expect("a picture")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // A leftover folder does not fail a test.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The output of the program, and its exit code.
#[derive(Debug)]
pub struct Finished {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl Finished {
    /// Its standard output as JSON.
    pub fn json(&self) -> serde_json::Value {
        serde_json::from_str(&self.out).unwrap_or_else(|error| panic!("{error}: {self:?}"))
    }

    /// The same, after checking its exit code.
    pub fn expect(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "{self:?}");
        self
    }
}

impl From<Output> for Finished {
    fn from(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        Self { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
    }
}
