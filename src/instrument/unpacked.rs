//! Archives as folders, where somebody drops one in place of a folder.

use std::io::{Cursor, Read};
use std::path::PathBuf;

use super::limits;
use super::workbook::{Archive, archive};

/// Paths and bytes of all files of an archive, in name order, without those that would lie outside of its folder.
/// `None` for anything that is no archive of files, a workbook among them, and for an archive that unpacks to more than
/// the readers take or is damaged: [`read`](super::read()) says why.
pub fn unpacked(bytes: &[u8]) -> Option<Vec<(PathBuf, Vec<u8>)>> {
    if archive(bytes)? != Archive::Files || limits::archive(bytes).is_err() {
        return None;
    }
    let mut zip = zip::ZipArchive::new(Cursor::new(bytes)).ok()?;
    let mut files = Vec::new();
    for i in 0..zip.len() {
        let mut entry = zip.by_index(i).ok()?;
        let is_folder = entry.name().ok()?.ends_with('/');
        let Some(path) = entry.enclosed_name().filter(|_| !is_folder) else { continue };
        let mut inner = Vec::new();
        entry.read_to_end(&mut inner).ok()?;
        files.push((path, inner));
    }
    files.sort();
    Some(files)
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use zip::write::SimpleFileOptions;

    use super::*;

    fn zipped(files: &[(&str, &[u8])]) -> Vec<u8> {
        let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
        for (name, bytes) in files {
            zip.start_file(*name, SimpleFileOptions::default()).unwrap();
            zip.write_all(bytes).unwrap();
        }
        zip.finish().unwrap().into_inner()
    }

    #[test]
    fn an_archive_is_a_folder_and_what_leads_out_of_it_is_left_out() {
        let bytes = zipped(&[("poplin/fb2.csv", b"1"), ("../out.csv", b"2"), ("a.csv", b"3")]);
        let found = unpacked(&bytes).unwrap();
        assert_eq!(found, [("a.csv".into(), b"3".to_vec()), ("poplin/fb2.csv".into(), b"1".to_vec())]);
    }

    #[test]
    fn workbooks_other_files_and_what_unpacks_to_too_much_are_none() {
        assert_eq!(unpacked(&zipped(&[("xl/workbook.xml", b"")])), None);
        assert_eq!(unpacked(b"a;b\n1;2\n"), None);
        let zeros = vec![0; 200 << 20];
        assert_eq!(unpacked(&zipped(&[("a.csv", &zeros)])), None);
    }
}
