//! The built-in fonts, which build.rs has packed: each is unpacked when its first letter is drawn.

use std::io::Read as _;
use std::sync::OnceLock;

use flate2::read::ZlibDecoder;

/// Dots per em of Unifont, in each direction.
pub(super) const DOTS: usize = 16;
/// Bytes of a glyph of Unifont: code, width, rows.
const GLYPH: usize = 4 + 1 + 2 * DOTS;

macro_rules! packed {
    ($name:literal) => {
        include_bytes!(concat!(env!("OUT_DIR"), "/", $name, ".zlib"))
    };
}

/// The file of DejaVu Sans in one of its weights; empty if it cannot be unpacked. Were it inlined, each unit of the library that
/// asks for it would hold the font again.
#[inline(never)]
pub(super) fn dejavu_file(bold: bool) -> &'static [u8] {
    static REGULAR: OnceLock<Vec<u8>> = OnceLock::new();
    static BOLD: OnceLock<Vec<u8>> = OnceLock::new();
    match bold {
        false => REGULAR.get_or_init(|| unpacked(packed!("dejavu-sans-regular"))),
        true => BOLD.get_or_init(|| unpacked(packed!("dejavu-sans-bold"))),
    }
}

/// A glyph of Unifont.
pub(super) struct Glyph {
    character: u32,
    /// 8 or 16 dots.
    width: u8,
    /// From above; the highest bit is the dot on the left.
    rows: [u16; DOTS],
}

impl Glyph {
    /// That of a character of the basic plane.
    pub fn of(character: char) -> Option<&'static Self> {
        static ALL: OnceLock<Vec<Glyph>> = OnceLock::new();
        let all = ALL.get_or_init(|| {
            unpacked(packed!("unifont")).chunks_exact(GLYPH).filter_map(Glyph::read).collect()
        });
        let at = all.binary_search_by_key(&u32::from(character), |glyph| glyph.character).ok()?;
        all.get(at)
    }

    fn read(bytes: &[u8]) -> Option<Self> {
        let (character, rest) = bytes.split_first_chunk::<4>()?;
        let (width, rows) = rest.split_first()?;
        let mut glyph = Self { character: u32::from_le_bytes(*character), width: *width, rows: [0; DOTS] };
        for (row, bytes) in glyph.rows.iter_mut().zip(rows.as_chunks::<2>().0) {
            *row = u16::from_le_bytes(*bytes);
        }
        Some(glyph)
    }

    /// Width in dots.
    pub fn width(&self) -> usize {
        usize::from(self.width)
    }

    /// Whether there is a dot, from the left and from above.
    pub fn has_dot(&self, x: usize, y: usize) -> bool {
        x < self.width() && self.rows.get(y).is_some_and(|row| row & (0x8000 >> x) != 0)
    }
}

/// What was packed; nothing if that is damaged.
fn unpacked(packed: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let read = ZlibDecoder::new(packed).read_to_end(&mut bytes);
    read.map(|_| bytes).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_font_is_whole() {
        // The beginning of a TrueType file, and the sizes of those of DejaVu 2.37.
        for (bold, size) in [(false, 757_076), (true, 705_684)] {
            let file = dejavu_file(bold);
            assert_eq!((&file[..4], file.len()), (&[0, 1, 0, 0][..], size));
        }
        assert!(unpacked(&packed!("unifont")[..100_000]).is_empty(), "half a file is none");
    }

    #[test]
    fn a_glyph_has_the_dots_of_its_character() {
        let drawn = |character: char| {
            let glyph = Glyph::of(character).unwrap();
            let dot = |x, y| if glyph.has_dot(x, y) { '#' } else { '.' };
            let row = |y| (0..glyph.width()).map(|x| dot(x, y)).collect::<String>();
            (0..DOTS).map(row).filter(|row| row.contains('#')).collect::<Vec<_>>()
        };
        assert_eq!(drawn('―').len(), 1, "a bar is one row");
        assert!(drawn('―')[0].trim_matches('.').chars().all(|dot| dot == '#'));
        assert_eq!((Glyph::of('縦').unwrap().width(), Glyph::of('ﾎ').unwrap().width()), (16, 8));
        assert!(Glyph::of('\u{f8ff0}').is_none());
    }
}
