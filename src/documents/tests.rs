use super::*;

/// The schemas as files: `kesf list schemas -o docs/schemas --force` writes them anew.
#[test]
fn the_committed_schemas_are_those_of_the_types() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/schemas");
    let all = schemas();
    for file in &all {
        let path = folder.join(format!("{}.json", file.name));
        let committed = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        assert_eq!(
            committed,
            file.text(),
            "{} is stale: kesf list schemas -o docs/schemas --force",
            path.display()
        );
    }
    #[cfg(feature = "parquet")]
    assert_eq!(std::fs::read_dir(folder).unwrap().count(), all.len());
}
