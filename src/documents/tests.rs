use super::*;
use crate::schema::{SCHEMAS, as_committed};

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
