//! Tests of the report's Snakemake workflow.

use std::fs;
use std::os::unix::process::CommandExt;
use std::path::PathBuf;
use std::process::Command;
use std::thread;
use std::time::SystemTime;

use glint_reference::report::workspace;

use crate::{TRANSCRIPT, folder};

/// Jobs of the workflow that these tests run. Other tests check the pages that the jobs write.
const TABLES: [&str; 2] = ["tables/sine", "tables/raymarch-pictures"];

/// A run of the workflow in a separate folder, with jobs that need no board.
struct Run {
    folder: PathBuf,
}

impl Run {
    fn new(name: &str) -> Self {
        let folder = folder(name);
        fs::write(folder.join("transcript"), TRANSCRIPT).expect("writable");
        let run = Self { folder };
        run.stamp("the first inputs");
        run
    }

    /// Writes a text in place of the checksums of all files that the jobs execute.
    fn stamp(&self, text: &str) {
        fs::write(self.folder.join("inputs"), text).expect("writable");
    }

    /// The Snakemake command for these workers and targets.
    fn snakemake(&self, workers: u32, targets: &[&str]) -> Command {
        let cycles = format!(
            "cycles=--transcript {}",
            self.folder.join("transcript").display()
        );
        let mut command = Command::new(workspace::path(".venv/bin/snakemake"));
        command
            .arg("--snakefile")
            .arg(workspace::path("tools/reference/workflow/Snakefile"))
            .arg("--directory")
            .arg(&self.folder)
            .args(["--cores", &workers.to_string(), "--nolock"])
            .arg("--rerun-incomplete")
            .args(targets)
            .args(["--config", "quick=1"])
            .args(["pages=sine raymarch-pictures", &cycles])
            .args([
                format!("root={}", workspace::path("").display()),
                format!("report={}", env!("CARGO_BIN_EXE_report")),
                "stamp=inputs".to_owned(),
            ]);
        command
    }

    fn succeed(&self, workers: u32, targets: &[&str]) {
        let output = self.snakemake(workers, targets).output();
        let output = output.expect("Snakemake starts");
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
    }

    /// A file in a folder of the run.
    fn read(&self, file: &str) -> String {
        fs::read_to_string(self.folder.join(file)).expect("readable")
    }

    /// Modification time of a table.
    fn written(&self, table: &str) -> SystemTime {
        let table = fs::metadata(self.folder.join("tables").join(table));
        let time = table.and_then(|table| table.modified());
        time.expect("the job has written its table")
    }
}

#[test]
fn every_page_has_a_job() {
    let path = workspace::path("tools/reference/workflow/Snakefile");
    let text = fs::read_to_string(path).expect("readable");
    let templates = fs::read_dir(workspace::path("tools/reference/pages/templates"));
    for template in templates.expect("a folder") {
        let path = template.expect("a file").path();
        let page = path.file_stem().expect("a name").to_string_lossy();
        assert!(
            page == "README" || page == "state" || text.contains(&format!("(\"{page}")),
            "{page}"
        );
    }
}

/// A run by two workers that continues a killed run writes the same tables as a run by one worker.
#[test]
fn a_killed_run_goes_on_and_writes_the_same_tables() {
    let run = Run::new("workflow-killed");
    run.succeed(1, &TABLES[..1]);
    let first = run.written("sine/sine.csv");
    let mut command = run.snakemake(2, &TABLES);
    let mut killed = command.process_group(0).spawn().expect("Snakemake starts");
    let begun = run.folder.join("tables/raymarch-pictures");
    while !begun.exists() {
        let ended = killed.try_wait().expect("Snakemake can be awaited");
        assert_eq!(ended, None, "Snakemake ended before its job");
        thread::yield_now();
    }
    let group = format!("-{}", killed.id());
    let kill = Command::new("kill").args(["-9", "--", &group]).status();
    assert!(kill.expect("kill starts").success());
    killed.wait().expect("Snakemake can be awaited");

    run.succeed(2, &TABLES);
    let one = Run::new("workflow-one");
    one.succeed(1, &["report"]);
    for (table, job) in [("sine.csv", TABLES[0]), ("raymarch.csv", TABLES[1])] {
        let table_of_one = one.read(&format!("pages/{table}"));
        assert!(
            table_of_one == run.read(&format!("{job}/{table}")),
            "{table}: the files differ"
        );
        let committed = fs::read_to_string(workspace::path("docs/report").join(table));
        assert!(
            table_of_one != committed.expect("readable"),
            "{table}: expected the table of the quick run, found the committed table"
        );
    }
    assert!(
        one.read("pages/README.md").contains("sine") && one.read("pages/sine.svg").contains("<svg")
    );
    assert_eq!(run.written("sine/sine.csv"), first, "the job ran again");
    run.stamp("the first inputs");
    run.succeed(2, &TABLES);
    assert_eq!(run.written("sine/sine.csv"), first, "the same inputs");
    run.stamp("other inputs");
    run.succeed(2, &TABLES[..1]);
    assert!(run.written("sine/sine.csv") > first, "other inputs");
}
