//! The common part of `render` and `resume`: runs a job, shows its progress, saves it and writes
//! its picture.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use alhazen::assets::AssetSource;
use alhazen::description::Imported;
use alhazen::description::schema::Settings;
use alhazen::description::{Diagnostic, SceneDesc};
use alhazen::image::DisplaySettings;
use alhazen::import::import;
use alhazen::integrators::{Control, Limits, PassError, Session, Stop};
use alhazen::{Header, Job, Overrides, PreviewSchedule, system_clock};

use crate::bar::Bar;
use crate::checkpoint::Checkpoint;
use crate::console::{say, warn};
use crate::diagnostics;
use crate::failure::Failure;
use crate::interrupt::{self, Interrupt};
use crate::live::Live;
use crate::output;
use crate::results::{write_preview, write_results};
use crate::summary::{Seconds, Summary, peak_memory};

/// What is printed.
#[derive(Clone, Copy, Debug)]
pub struct Verbosity {
    /// Nothing but errors.
    pub quiet: bool,
    /// One JSON object instead of text.
    pub json: bool,
}

impl Verbosity {
    fn is_talkative(self) -> bool {
        !self.quiet && !self.json
    }

    /// Writes warnings to standard error, beside a progress bar.
    fn warn_of(self, warnings: Vec<String>, bar: &Bar) {
        for warning in warnings.iter().filter(|_| !self.quiet) {
            // The render goes on even if the message cannot be written.
            let _ = bar.suspend(|| warn(format_args!("warning: {warning}")));
        }
    }
}

/// A scene that was imported and changed.
pub struct Prepared {
    imported: Imported,
    overrides: Overrides,
    begin: Instant,
    imported_at: Instant,
}

impl Prepared {
    /// Imports a scene and changes it.
    pub fn new(scene: &Path, assets: &dyn AssetSource, overrides: Overrides) -> Result<Self, Failure> {
        let begin = Instant::now();
        let mut imported = import(scene, assets);
        if imported.has_errors() {
            return Err(scene_failure(imported));
        }
        overrides.apply(&mut imported.desc).map_err(|error| Failure::Usage(error.to_string()))?;
        for file in imported.desc.integrator.files() {
            output::check_place(Path::new(&file)).map_err(Failure::Input)?;
        }
        Ok(Self { imported, overrides, begin, imported_at: Instant::now() })
    }

    /// What was imported.
    pub fn imported(&self) -> &Imported {
        &self.imported
    }

    /// Compiles the scene.
    pub fn compile(self) -> Result<(Job, Compiled), Failure> {
        self.compile_as(|desc| Job::compile(desc).map(|compiled| (compiled.job, compiled.warnings)))
    }

    /// Compiles the scene by a function that gives warnings, too.
    pub fn compile_as<T>(
        mut self,
        compile: impl FnOnce(SceneDesc) -> Result<(T, Vec<Diagnostic>), Vec<Diagnostic>>,
    ) -> Result<(T, Compiled), Failure> {
        let integrator = self.imported.desc.integrator.name();
        match compile(std::mem::take(&mut self.imported.desc)) {
            Ok((compiled, warnings)) => {
                self.imported.diagnostics.extend(warnings);
                let Self { imported, begin, imported_at, .. } = self;
                let compiled_at = Instant::now();
                Ok((compiled, Compiled { imported, integrator, begin, imported_at, compiled_at }))
            }
            Err(errors) => {
                if let Some(error) = self.overrides.blamed(&errors) {
                    return Err(Failure::Usage(error.to_string()));
                }
                self.imported.diagnostics.extend(errors);
                Err(scene_failure(self.imported))
            }
        }
    }
}

/// The data of an imported scene that are needed after compilation.
pub struct Compiled {
    imported: Imported,
    integrator: &'static str,
    begin: Instant,
    imported_at: Instant,
    compiled_at: Instant,
}

impl Compiled {
    /// The name of the algorithm.
    pub fn integrator(&self) -> &'static str {
        self.integrator
    }

    /// What was imported, without its description, with all warnings.
    pub fn imported(&self) -> &Imported {
        &self.imported
    }

    /// Adds warnings to those of the scene.
    #[cfg(feature = "gpu")]
    pub fn add(&mut self, warnings: Vec<Diagnostic>) {
        self.imported.diagnostics.extend(warnings);
    }
}

/// A job with everything that it is run with.
pub struct Task<'a> {
    /// The scene file.
    pub scene: &'a Path,
    /// The job.
    pub job: Job,
    /// The passes to do.
    pub passes: Range<u32>,
    /// Further limits that end it.
    pub limits: Limits,
    /// The files of the picture; it is not written if there are none.
    pub outputs: Vec<PathBuf>,
    /// How they show the light if they are for displays.
    pub display: DisplaySettings,
    /// Where the render is saved.
    pub checkpoint: Option<Checkpoint>,
    /// Who watches.
    pub live: Live,
    /// Notes on the result beside those of the algorithm.
    pub notes: Vec<(&'static str, String)>,
    /// What is printed.
    pub verbosity: Verbosity,
}

impl Task<'_> {
    /// Renders, writes the results and reports.
    pub fn run(mut self, compiled: Compiled, interrupt: &Interrupt) -> Result<ExitCode, Failure> {
        let Compiled { mut imported, integrator, begin, imported_at, compiled_at } = compiled;
        let is_talkative = self.verbosity.is_talkative();
        interrupt.begin_rendering(is_talkative);
        self.live.begin(&self.job.session);
        if is_talkative {
            diagnostics::print(&imported.diagnostics, &imported.sources)?;
        }
        let control = Control::new(interrupt.cancel(), system_clock());
        self.sketch(&control, interrupt);
        let bar = Bar::new(is_talkative);
        let outcome = self.render(&control, &bar, interrupt);
        bar.finish();
        let rendered_at = Instant::now();

        let beside = self.write(&outcome)?;
        self.notes.extend(self.job.session.integrator().summary());
        let ended_by = outcome.ok();
        let missed = ended_by.and_then(|stop| self.job.missed_noise(&self.limits, stop));
        let summary = Summary {
            ended_by,
            scene: self.scene,
            outputs: &self.outputs,
            beside: &beside,
            checkpoint: self.checkpoint.as_ref().map(Checkpoint::path).filter(|path| path.exists()),
            notes: &self.notes,
            integrator,
            session: &self.job.session,
            threads: rayon::current_num_threads(),
            seconds: Seconds {
                import: (imported_at - begin).as_secs_f64(),
                compile: (compiled_at - imported_at).as_secs_f64(),
                render: (rendered_at - compiled_at).as_secs_f64(),
                write: rendered_at.elapsed().as_secs_f64(),
            },
            peak_memory: peak_memory(),
        };
        if self.verbosity.json {
            imported.diagnostics.extend(missed);
            let (_, warnings) = diagnostics::to_json(&imported.diagnostics, &imported.sources);
            say(summary.to_json(warnings))?;
        } else if is_talkative {
            say(&summary)?;
            diagnostics::print(missed.as_slice(), &imported.sources)?;
        } else if let Some(interruption) = summary.interruption() {
            warn(interruption)?;
        }
        let picture = self.job.header().development(self.job.session.state());
        self.live.finish(&picture, interrupt);
        self.verbosity.warn_of(self.live.take_warnings(), &bar);
        self.live.stay(interrupt);
        Ok(if summary.ended_by.is_none() { ExitCode::from(interrupt::EXIT_CODE) } else { ExitCode::SUCCESS })
    }

    /// Shows a sketch of a render that begins, if anybody sees it.
    fn sketch(&self, control: &Control, interrupt: &Interrupt) {
        if (!self.outputs.is_empty() || self.live.is_watched())
            && self.job.session.state().done.is_empty()
            && let Some(sketch) = self.job.sketch(control)
        {
            self.live.show(&sketch);
            write_preview(&sketch, &self.outputs, &self.display);
            interrupt.note_written(&self.outputs, 0);
        }
    }

    /// Does the passes, and shows and saves what they give.
    fn render(&mut self, control: &Control, bar: &Bar, interrupt: &Interrupt) -> Result<Stop, PassError> {
        let mut preview = Preview {
            header: self.job.header().clone(),
            outputs: &self.outputs,
            display: &self.display,
            interrupt,
            schedule: PreviewSchedule::begin(),
        };
        self.job.session.run(self.passes.clone(), &self.limits, control, &mut |session| {
            bar.show(&session.progress());
            preview.after_pass(session, &self.live, self.checkpoint.as_mut());
            self.live.after_pass(session, &preview.header);
            self.verbosity.warn_of(self.live.take_warnings(), bar);
            let checkpoint = self.checkpoint.as_mut();
            interrupt.after_pass(checkpoint.is_some_and(|checkpoint| !checkpoint.after_pass(session)));
        })
    }

    /// Writes the picture and saves the render, however it has ended; gives the files beside the
    /// picture. Fails if memory or the device did.
    fn write(&mut self, outcome: &Result<Stop, PassError>) -> Result<Vec<PathBuf>, Failure> {
        let session = &self.job.session;
        let out_of_memory = match outcome {
            Err(PassError::OutOfMemory(problem) | PassError::Device(problem)) => Some(problem),
            Ok(_) | Err(PassError::Cancelled) => None,
        };
        if let Some(problem) = out_of_memory
            && session.progress().pass == 0
        {
            return Err(Failure::Input(problem.clone()));
        }
        let files = session.integrator().files();
        let films = if self.outputs.is_empty() { Vec::new() } else { session.integrator().films() };
        let picture = self.job.header().development(session.state());
        let beside = write_results(&picture, &self.outputs, &self.display, films, files);
        // If a cancelled pass has left samples on the film, the last checkpoint is kept.
        let saved = match &mut self.checkpoint {
            Some(checkpoint) if session.is_whole() => checkpoint.finish(session),
            _ => Ok(()),
        };
        if let Some(problem) = out_of_memory {
            let passes = session.progress().pass;
            let plural = if passes == 1 { "" } else { "es" };
            let written = if beside.is_ok() && saved.is_ok() { "is" } else { "could not be" };
            return Err(Failure::Input(format!(
                "{problem}; the picture after {passes} pass{plural} {written} written"
            )));
        }
        let beside = beside?;
        saved?;
        Ok(beside)
    }
}

/// Writes the picture to its files while it is rendered.
struct Preview<'a> {
    header: Header,
    outputs: &'a [PathBuf],
    display: &'a DisplaySettings,
    interrupt: &'a Interrupt,
    schedule: PreviewSchedule,
}

impl Preview<'_> {
    /// Writes the picture if that is due or asked for; if it is asked for, the checkpoint too.
    fn after_pass(&mut self, session: &Session, live: &Live, checkpoint: Option<&mut Checkpoint>) {
        let is_asked = live.is_save_asked();
        if self.outputs.is_empty() && !is_asked {
            return;
        }
        self.schedule.after_pass(is_asked, || {
            let passes = session.progress().pass;
            write_preview(&self.header.development(session.state()), self.outputs, self.display);
            self.interrupt.note_written(self.outputs, passes);
            if is_asked {
                checkpoint.into_iter().for_each(|checkpoint| checkpoint.save(session));
                live.note_saved(passes);
            }
        });
    }
}

/// The failure of a scene with errors.
pub fn scene_failure(imported: Imported) -> Failure {
    Failure::Scene { diagnostics: imported.diagnostics, sources: imported.sources }
}
