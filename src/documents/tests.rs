use super::*;
use crate::report::json::{SectionDocument, SheetDocument};
use crate::report::write::Manifest;
use crate::results::list::ListDocument;
use crate::results::{CheckDocument, ComparisonDocument, SolutionDocument};
use crate::run::RunDocument;
use crate::schema::{self, GeneratedSchema, SCHEMAS, as_committed};
use crate::verify;

/// The schemas as files and in the program: `KESF_SCHEMAS_WRITE=1 cargo test --release --lib committed` writes them anew.
#[test]
fn the_committed_schemas_are_those_of_the_types() {
    let all = generated();
    for file in &all {
        as_committed(&format!("schemas/{}.json", file.name), &file.text());
    }
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/schemas");
    assert_eq!(std::fs::read_dir(folder).unwrap().count(), all.len());
    assert_eq!(
        SCHEMAS.iter().map(|f| f.name).collect::<Vec<_>>(),
        all.iter().map(|f| f.name).collect::<Vec<_>>()
    );
    assert!(SCHEMAS.iter().all(|file| !file.title().is_empty()));
}

/// The schemas of all files and documents, from their types, in name order: those of [`SCHEMAS`].
fn generated() -> Vec<GeneratedSchema> {
    let mut all = schema::generated();
    all.extend([
        document::<CheckDocument>("check", "kesf.check/1, of kesf check"),
        document::<ComparisonDocument>(
            "comparison",
            "kesf.comparison/1, of kesf compare and of cases of tests",
        ),
        document::<CurvesDocument>("curves", "kesf.curves/1, of kesf read"),
        GeneratedSchema::of_document::<ErrorLine>("error", "A line on standard error with --json"),
        document::<ExplanationsDocument>("explanations", "kesf.explanations/1, of kesf explain"),
        document::<ExportDocument>("export", "kesf.export/1, of kesf export"),
        document::<InitDocument>("init", "kesf.init/1, of kesf init"),
        document::<ListDocument>("list", "kesf.list/1, of kesf list"),
        GeneratedSchema::of_document::<Manifest>(
            "manifest",
            "kesf.manifest/1, the files of a folder of results",
        ),
        document::<ReportDocument>("report", "kesf.report/1, of kesf report"),
        document::<ResultsDocument>("results", "kesf.results/1, of kesf run"),
        GeneratedSchema::of_document::<RunDocument>("run", "kesf.run/1, run.json in a folder of results"),
        document::<SectionDocument>("section", "kesf.section/1, of kesf section, and section.json"),
        document::<SheetDocument>("sheet", "kesf.sheet/1, of kesf characterise, and sheet.json"),
        document::<SolutionDocument>("solution", "kesf.solution/1, of kesf solve and of cases with a sheet"),
        document::<verify::VerifyDocument>("verify", "kesf.verify/1, of kesf verify"),
    ]);
    all.extend([
        document::<FoundDocument>("found", "kesf.found/1, of kesf library find"),
        document::<LibraryDocument>("library", "kesf.library/1, of kesf library build"),
        document::<MergedDocument>("merged", "kesf.merged/1, of kesf merge"),
        document::<PartDocument>("part", "kesf.part/1, of kesf run --shard"),
    ]);
    all.sort_by_key(|file| file.name);
    all
}

/// A document that a command prints, or that is a file without `findings` and `failures`.
fn document<D: schemars::JsonSchema>(name: &'static str, title: &'static str) -> GeneratedSchema {
    let mut file = GeneratedSchema::of_document::<Complete<D>>(name, title);
    if let Some(required) = file.schema["required"].as_array_mut() {
        required.retain(|key| key != "failures");
    }
    file
}
