use super::super::write::{hash, write_atomic};
use super::*;

fn names(root: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(root).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn our_own_files_are_replaced_and_others_are_not() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join("new/results");
    let out = OutputFolder::open(&root, false).unwrap();
    out.write("a.csv", b"1").unwrap();
    out.write("poplin/sheet.json", b"{}").unwrap();
    out.write("a.csv", b"2").unwrap();
    assert!(out.finish().unwrap().is_empty());
    assert_eq!(names(&root), [MANIFEST, "a.csv", "poplin"]);

    fs::write(root.join("mine.csv"), b"mine").unwrap();
    fs::write(root.join("poplin/sheet.json"), b"{ edited }").unwrap();
    let out = OutputFolder::open(&root, false).unwrap();
    out.write("a.csv", b"3").unwrap();
    assert!(matches!(out.write("mine.csv", b"x"), Err(OutputError::NotOurs { .. })));
    assert!(matches!(out.write("poplin/sheet.json", b"x"), Err(OutputError::NotOurs { .. })));
    assert_eq!(fs::read(root.join("mine.csv")).unwrap(), b"mine");
    assert_eq!(out.finish().unwrap(), ["poplin/sheet.json"], "left over from the first run");

    let out = OutputFolder::open(&root, true).unwrap();
    out.write("mine.csv", b"x").unwrap();
    out.write("poplin/sheet.json", b"x").unwrap();
    assert_eq!(fs::read(root.join("mine.csv")).unwrap(), b"x");
}

/// Tables are written last: those beside the files of a run that ended early are of the run before it.
#[test]
fn results_of_a_run_that_ended_early_are_refused_until_the_next_has_ended() {
    use super::super::write::results_reader;
    let folder = tempfile::tempdir().unwrap();
    let first = OutputFolder::open(folder.path(), false).unwrap();
    first.write("fabrics.csv", b"1").unwrap();
    first.finish().unwrap();
    // One that has changed nothing leaves them as they were.
    let idle = OutputFolder::open(folder.path(), false).unwrap();
    idle.write("fabrics.csv", b"1").unwrap();
    drop(idle);
    assert!(results_reader(folder.path()).is_ok());
    let early = OutputFolder::open(folder.path(), false).unwrap();
    early.write("a/sheet.json", b"{}").unwrap();
    drop(early);
    assert!(matches!(results_reader(folder.path()), Err(OutputError::Unfinished { .. })));
    let last = OutputFolder::open(folder.path(), false).unwrap();
    last.write("a/sheet.json", b"{}").unwrap();
    last.write("fabrics.csv", b"2").unwrap();
    assert!(last.finish().unwrap().is_empty());
    assert!(results_reader(folder.path()).is_ok());
}

#[test]
fn a_run_that_ends_early_can_be_repeated_with_other_inputs() {
    let folder = tempfile::tempdir().unwrap();
    let out = OutputFolder::open(folder.path(), false).unwrap();
    out.write("a.csv", b"1").unwrap();
    drop(out);
    let out = OutputFolder::open(folder.path(), false).unwrap();
    out.write("a.csv", b"2").unwrap();
    out.finish().unwrap();
    assert_eq!(names(folder.path()), [MANIFEST, "a.csv"]);
}

#[test]
fn a_run_that_was_killed_can_be_repeated_with_other_inputs() {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [("a.csv", "1"), ("b.csv", "1"), ("mine.csv", "mine")] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    // Before `a.csv` there was another; `b.csv` was announced and not written; the last line is cut short.
    let lines = format!("{:?}\n{:?}\n[\"c.c", ["a.csv", &hash(b"1")], ["b.csv", &hash(b"2")]);
    fs::write(folder.path().join(JOURNAL), lines).unwrap();
    let out = OutputFolder::open(folder.path(), false).unwrap();
    out.write("a.csv", b"3").unwrap();
    assert!(matches!(out.write("b.csv", b"3"), Err(OutputError::NotOurs { .. })));
    assert!(matches!(out.write("mine.csv", b"3"), Err(OutputError::NotOurs { .. })));
    out.finish().unwrap();
    assert_eq!(names(folder.path()), [MANIFEST, "a.csv", "b.csv", "mine.csv"]);
}

#[test]
fn runs_that_were_killed_one_after_the_other_can_be_repeated() {
    let folder = tempfile::tempdir().unwrap();
    // The first was killed within a line of its journal, the second at once after a file.
    fs::write(folder.path().join(JOURNAL), "[\"a.c").unwrap();
    let out = OutputFolder::open(folder.path(), false).unwrap();
    out.write("b.csv", b"1").unwrap();
    std::mem::forget(out);
    // In one process the lock would outlive the run: the journal alone is what a kill leaves.
    let journal = fs::read(folder.path().join(JOURNAL)).unwrap();
    fs::remove_file(folder.path().join(JOURNAL)).unwrap();
    fs::write(folder.path().join(JOURNAL), journal).unwrap();
    let out = OutputFolder::open(folder.path(), false).unwrap();
    out.write("b.csv", b"2").unwrap();
}

#[test]
fn temporary_files_of_a_run_that_was_killed_are_removed_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("poplin")).unwrap();
    let orphans = [".kesf-a1B2c3", "poplin/.kesf-Zz9Zz9"];
    let others = [".kesf-notes.txt", "poplin/.kesf-mine", "poplin/a1B2c3"];
    for name in orphans.into_iter().chain(others) {
        fs::write(folder.path().join(name), "").unwrap();
    }
    let line = format!("{:?}\n", ["poplin/sheet.json", &hash(b"")]);
    fs::write(folder.path().join(JOURNAL), line).unwrap();
    OutputFolder::open(folder.path(), false).unwrap().finish().unwrap();
    assert!(orphans.iter().all(|name| !folder.path().join(name).exists()));
    assert!(others.iter().all(|name| folder.path().join(name).exists()));
}

#[test]
fn two_runs_at_once_are_kept_apart() {
    let folder = tempfile::tempdir().unwrap();
    let first = OutputFolder::open(folder.path(), false).unwrap();
    assert!(matches!(OutputFolder::open(folder.path(), true), Err(OutputError::Busy { .. })));
    first.finish().unwrap();
    assert!(OutputFolder::open(folder.path(), false).is_ok());
}

#[test]
fn the_manifest_is_the_same_for_the_same_files() {
    let folder = tempfile::tempdir().unwrap();
    let manifest = || {
        let out = OutputFolder::open(folder.path(), false).unwrap();
        out.write("b", b"1").unwrap();
        out.write("a", b"1").unwrap();
        out.finish().unwrap();
        fs::read_to_string(folder.path().join(MANIFEST)).unwrap()
    };
    let first = manifest();
    assert_eq!(first, manifest());
    // SHA-256 of "1" (FIPS 180-4; sha256sum).
    assert!(first.contains("6b86b273ff34fce19d6b804eff5a3f5747ada4eaa22f1d49c01e52ddb7875b4b"));
}

#[test]
fn names_that_leave_the_folder_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = OutputFolder::open(folder.path(), false).unwrap();
    for name in ["", "../x", "/etc/x", "a/../../x", "..\\x", MANIFEST] {
        assert!(matches!(out.write(name, b"x"), Err(OutputError::Name { .. })), "{name}");
    }
}

#[test]
fn a_broken_manifest_and_a_file_in_place_of_the_folder_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(MANIFEST), b"not json").unwrap();
    assert!(matches!(OutputFolder::open(folder.path(), false), Err(OutputError::Manifest { .. })));
    assert!(OutputFolder::open(folder.path(), true).is_ok());
    let file = folder.path().join("file");
    fs::write(&file, b"").unwrap();
    assert!(matches!(OutputFolder::open(&file, false), Err(OutputError::Write { .. })));
    assert!(matches!(write_atomic(&file.join("x"), b""), Err(OutputError::Write { .. })));
}

#[test]
fn a_file_that_is_written_in_pieces_is_whole_or_not_there() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("mine.csv"), "mine").unwrap();
    let out = OutputFolder::open(folder.path(), false).unwrap();
    let mut pending = out.create("a/b.csv").unwrap();
    pending.write_all(b"1,").unwrap();
    assert!(!folder.path().join("a/b.csv").exists());
    pending.write_all(b"2").unwrap();
    pending.commit().unwrap();
    assert_eq!(fs::read(folder.path().join("a/b.csv")).unwrap(), b"1,2");
    out.create("c.csv").unwrap().write_all(b"1").unwrap();
    let mut foreign = out.create("mine.csv").unwrap();
    foreign.write_all(b"1").unwrap();
    assert!(matches!(foreign.commit(), Err(OutputError::NotOurs { .. })));
    out.finish().unwrap();
    assert_eq!(names(folder.path()), [MANIFEST, "a", "mine.csv"]);
}

#[test]
fn files_of_an_earlier_run_are_read_and_kept_as_it_left_them() {
    let folder = tempfile::tempdir().unwrap();
    let out = OutputFolder::open(folder.path(), false).unwrap();
    ["a", "b"].iter().for_each(|name| out.write(name, b"1").unwrap());
    assert_eq!(out.read("a").unwrap().as_deref(), Some(&b"1"[..]));
    out.finish().unwrap();
    fs::write(folder.path().join("b"), "edited").unwrap();
    let out = OutputFolder::open(folder.path(), false).unwrap();
    assert_eq!(["a", "b", "c"].map(|name| out.keep(name).unwrap()), [true, false, false]);
    assert_eq!(out.read("b").unwrap(), None);
    assert_eq!(out.finish().unwrap(), ["b"]);
}
