//! Results read back: tables of a run, parts of a batch, bounds of a question.

use std::cell::RefCell;
use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use bytes::Bytes;
use kesf::library::{Bounds, Shelf, Stored};
use kesf::parts::{Part, Table, encode, evaluate};
use kesf::results::{Input, Job, Observer, Shard};
use kesf::run::RunSettings;

use crate::archives::{unpacked_size, unzipped, zipped};
use crate::{Damage, Target, corpus};

/// What `kesf run` says of two fabrics.
const TABLE: &str = "fabric,parameter,direction,mean,sd,n,unit,status,cv,ci95\n\
                     poplin,B,warp,8.5e-6,1e-7,3,N·m,measured,0.0118,2.5e-7\n\
                     poplin,B,weft,5e-6,,1,N·m,measured,,\n\
                     poplin,G,warp,50,,1,N/m,doubtful,,\n\
                     poplin,W,,0.12,,1,kg/m²,measured,,\n\
                     \"köper, grau\",B,warp,1e-5,,1,N·m,inferred,,\n\
                     \"köper, grau\",tangent_low,warp,5000,,1,N/m,measured,,\n";

/// A table of parameters, as `kesf run` writes it.
pub fn library() -> Target {
    Target {
        seeds: vec![TABLE.as_bytes().to_vec()],
        damaged: Damage::of,
        size: <[u8]>::len,
        holds: library_holds,
    }
}

thread_local! {
    static FOLDER: RefCell<tempfile::TempDir> = RefCell::new(corpus::scratch());
}

fn library_holds(bytes: &[u8]) -> bool {
    FOLDER.with_borrow(|folder| {
        let run = folder.path().join("run");
        fs::create_dir_all(&run).expect("a folder");
        fs::write(run.join("fabrics.csv"), bytes).expect("a file");
        let mut shelf = Shelf::default();
        if shelf.add(&Stored(run)).is_err() || shelf.is_empty() {
            return false;
        }
        let table = shelf.table().expect("a table");
        assert_eq!(table.num_rows(), shelf.len());
        shelf.parquet().expect("a file");
        true
    })
}

/// What somebody asks of a library.
pub fn bounds() -> Target {
    let seeds = [
        "B_warp > 0.05",
        "B_warp BETWEEN 0.05 AND 0.1 AND NOT (W < 10 OR G_warp IS NULL)",
        "W >= 8 AND W <= 20 AND B_weft <> 0.1",
        "fabric LIKE 'pop%' AND B_warp * 2 > 0.1",
        "B_warp IN (0.1, 0.2) OR -B_weft < 1e-3",
    ];
    let seeds = seeds.iter().map(|text| text.as_bytes().to_vec()).collect();
    Target { seeds, damaged: Damage::of, size: <[u8]>::len, holds: bounds_hold }
}

fn bounds_hold(bytes: &[u8]) -> bool {
    static SHELF: OnceLock<Shelf> = OnceLock::new();
    let shelf = SHELF.get_or_init(|| {
        FOLDER.with_borrow(|folder| {
            fs::write(folder.path().join("fabrics.csv"), TABLE).expect("a file");
            let mut shelf = Shelf::default();
            shelf.add(&Stored(folder.path().to_path_buf())).expect("a table of parameters");
            shelf
        })
    });
    let table = shelf.table().expect("a table");
    let Ok(text) = std::str::from_utf8(bytes) else { return false };
    let Ok(bounds) = Bounds::parse(text, &table.schema()) else { return false };
    assert!(bounds.columns().all(|name| table.column_by_name(name).is_some()));
    for row in 0..table.num_rows() {
        bounds.hold(&table, row);
    }
    true
}

/// A part of a batch: three Parquet files, which stand in an archive here.
pub fn parts() -> Target {
    let inputs = vec![Input::Path(corpus::package().join("../kesf_data/petrak_m1"))];
    let job = Job { inputs, ..Job::default() };
    let made = evaluate(&job, &RunSettings::default(), &Observer::default()).expect("an evaluation");
    let files = made.files(shard(), "set-up", "key").expect("the files of a part");
    Target { seeds: vec![zipped(&files)], damaged: damaged_part, size: unpacked_size, holds: part_holds }
}

fn shard() -> Shard {
    "1/1".parse().expect("a shard")
}

/// One of the files, damaged.
fn damaged_part(damage: &Damage, seeds: &[Vec<u8>]) -> Vec<u8> {
    let mut files = unzipped(damage.seed(seeds));
    let at = damage.part(files.len()).unwrap_or(0);
    files[at].1 = damage.to(&files[at].1, b"");
    zipped(&files)
}

fn part_holds(bytes: &[u8]) -> bool {
    let files: Vec<Bytes> = unzipped(bytes).into_iter().map(|(_, bytes)| bytes.into()).collect();
    let Ok(files) = <[Bytes; 3]>::try_from(files) else { return false };
    let Ok(part) = Part::read(Path::new("parts"), shard(), files) else { return false };
    let tables = [Table::Findings, Table::Failures, Table::Results].map(|table| part.table(table).clone());
    let written = encode(&tables, "[]", shard(), "set-up", "key").expect("the files of a part");
    let again: Vec<Bytes> = written.into_iter().map(|(_, bytes)| bytes.into()).collect();
    let again: [Bytes; 3] = again.try_into().expect("three files");
    let again = Part::read(Path::new("parts"), shard(), again).expect("the part again");
    for (table, rows) in [Table::Findings, Table::Failures, Table::Results].into_iter().zip(&tables) {
        assert_eq!(again.table(table), rows);
    }
    true
}
