//! What is done to a file: slips of bytes, of lines and of numbers, and texts that some reader has to think about.

use bolero::TypeGenerator;
use bolero::generator::bolero_generator::driver::{ByteSliceDriver, Options};
use rand::{Rng, SeedableRng};

/// The most that a damaged file has (bytes): a piece of it that is repeated may make it as large.
const MOST: usize = 96 << 10;

/// From this number on, a piece is repeated as often as it fits.
const FULL: u8 = 248;

/// The damage to one file.
#[derive(Clone, Debug, TypeGenerator)]
pub struct Damage {
    /// Which file.
    seed: u16,
    /// A file that pieces are taken from.
    other: u16,
    /// Slips, one after the other.
    #[generator(bolero::generator::produce_with::<Vec<Edit>>().len(0usize..8))]
    edits: Vec<Edit>,
    /// Whether the parts of a container are damaged, and not the container: which part.
    inside: Option<u8>,
}

/// Bytes that the damage of one number is made of.
const DRAWN: usize = 1024;

impl Damage {
    /// The damage of a number, the same every time; bolero draws all but its first from the system.
    pub fn numbered(number: u64) -> Option<Self> {
        let mut bytes = [0; DRAWN];
        rand_pcg::Pcg64::seed_from_u64(number).fill_bytes(&mut bytes);
        Self::generate(&mut ByteSliceDriver::new(&bytes[..], &Options::default()))
    }
}

/// A slip. Places are parts of the length of the file.
#[derive(Clone, Debug, TypeGenerator)]
enum Edit {
    Flip { at: u32, bit: u8 },
    Remove { at: u32, length: u8 },
    Cut { at: u32 },
    Repeat { at: u32, length: u8, times: u8 },
    Take { at: u32, from: u32, length: u8 },
    Put { at: u32, token: u8 },
    Number { at: u32, value: u8 },
    RemoveLine { at: u32 },
    MoveLine { from: u32, to: u32 },
    RepeatLine { at: u32, times: u8 },
}

/// Numbers that a file may have in the place of another.
const NUMBERS: &[&str] = &[
    "0",
    "-1",
    "1",
    "2",
    "-0",
    "1e999",
    "-1e999",
    "1e308",
    "1e-320",
    "NaN",
    "inf",
    "4294967296",
    "2147483647",
    "-9223372036854775808",
    "18446744073709551616",
    "99999999999999999999999999",
    "0.1",
    "0,35",
    "1,234.5",
    "1e10",
    "0x10",
    "\"\"",
    "null",
    "[]",
];

/// Texts that mean something to one reader or another.
const TOKENS: &[&[u8]] = &[
    b"-",
    b",",
    b";",
    b"\t",
    b"\n\n",
    b"\r",
    b"\"",
    b"'",
    b"(",
    b")",
    b"\0",
    b"\xff\xfe",
    b"\x81",
    b"\xef\xbb\xbf",
    b"gf",
    b" (gf/cm)",
    b"direction,weft\n",
    b"specimen,0\n",
    "・㎝".as_bytes(),
    b"1/(",
    b"^99",
    b"#N/A",
    b"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[",
    b"{\"a\":",
    b"{{{{{{{{{{{{{{{{{{{{{{{{",
    b"((((((((((((((((((((((((",
    b"B (gf\xb7cm/deg)",
    b"= { ",
    b" = \"1e400 mm\"\n",
    b"\n[[loads]]\n",
    b"[steps]\n",
    b"true",
    b"<td colspan=99999>",
    b"<table><tr>",
    b"\\u0000",
    b"$EndNodes\n",
    b"$Elements\n",
    b"*SHELL SECTION\n",
    b"**",
    b" OR NOT ",
    b"\xf0\x9f\xa7\xb5",
    b"=cmd|' /C calc'!A0",
    b"e",
    b" ",
];

impl Damage {
    /// The file that is damaged.
    ///
    /// # Panics
    /// Without any file.
    pub fn seed<'s>(&self, seeds: &'s [Vec<u8>]) -> &'s [u8] {
        &seeds[usize::from(self.seed) % seeds.len()]
    }

    /// The part of a container that is damaged, of so many; none where the container is.
    pub fn part(&self, parts: usize) -> Option<usize> {
        self.inside.filter(|_| parts > 0).map(|n| usize::from(n) % parts)
    }

    /// The file, damaged.
    pub fn of(&self, seeds: &[Vec<u8>]) -> Vec<u8> {
        let other = &seeds[usize::from(self.other) % seeds.len()];
        self.to(self.seed(seeds), other)
    }

    /// Bytes, damaged, with pieces of others.
    pub fn to(&self, bytes: &[u8], other: &[u8]) -> Vec<u8> {
        let mut bytes = bytes.to_vec();
        for edit in &self.edits {
            edit.apply(&mut bytes, other);
        }
        bytes
    }
}

/// A place in something so long.
fn place(at: u32, length: usize) -> usize {
    ((u64::from(at) * (length as u64 + 1)) >> 32) as usize
}

/// The line at a place, with its end.
fn line(bytes: &[u8], at: usize) -> std::ops::Range<usize> {
    let start = bytes[..at].iter().rposition(|b| *b == b'\n').map_or(0, |i| i + 1);
    let end = bytes[at..].iter().position(|b| *b == b'\n').map_or(bytes.len(), |i| at + i + 1);
    start..end
}

impl Edit {
    fn apply(&self, bytes: &mut Vec<u8>, other: &[u8]) {
        match *self {
            Self::Flip { at, bit } => {
                let at = place(at, bytes.len());
                if let Some(byte) = bytes.get_mut(at) {
                    *byte ^= 1 << (bit % 8);
                }
            }
            Self::Remove { at, length } => {
                let at = place(at, bytes.len());
                bytes.drain(at..(at + usize::from(length)).min(bytes.len()));
            }
            Self::Cut { at } => bytes.truncate(place(at, bytes.len())),
            Self::Repeat { at, length, times } => {
                let at = place(at, bytes.len());
                let end = (at + usize::from(length)).min(bytes.len());
                repeat(bytes, at..end, times);
            }
            Self::Take { at, from, length } => {
                let (at, from) = (place(at, bytes.len()), place(from, other.len()));
                let end = (from + usize::from(length)).min(other.len());
                bytes.splice(at..at, other[from..end].iter().copied());
            }
            Self::Put { at, token } => {
                let at = place(at, bytes.len());
                bytes.splice(at..at, TOKENS[usize::from(token) % TOKENS.len()].iter().copied());
            }
            Self::Number { at, value } => {
                let at = place(at, bytes.len());
                let Some(start) = bytes[at..].iter().position(u8::is_ascii_digit).map(|i| at + i) else {
                    return;
                };
                let of_number = |b: &u8| b.is_ascii_digit() || *b == b'.';
                let end =
                    bytes[start..].iter().position(|b| !of_number(b)).map_or(bytes.len(), |i| start + i);
                bytes.splice(start..end, NUMBERS[usize::from(value) % NUMBERS.len()].bytes());
            }
            Self::RemoveLine { at } => {
                let found = line(bytes, place(at, bytes.len()));
                bytes.drain(found);
            }
            Self::MoveLine { from, to } => {
                let found = line(bytes, place(from, bytes.len()));
                let taken: Vec<u8> = bytes.drain(found).collect();
                let to = line(bytes, place(to, bytes.len())).start;
                bytes.splice(to..to, taken);
            }
            Self::RepeatLine { at, times } => {
                let found = line(bytes, place(at, bytes.len()));
                repeat(bytes, found, times);
            }
        }
    }
}

/// Puts a piece in a few times more, and now and then as often as it fits: a long file takes the time of many short
/// ones.
fn repeat(bytes: &mut Vec<u8>, piece: std::ops::Range<usize>, times: u8) {
    let times = if times < FULL { usize::from(times % 8) } else { usize::MAX };
    let fits = MOST.saturating_sub(bytes.len()) / piece.len().max(1);
    let copies = bytes[piece.clone()].repeat(times.min(fits));
    bytes.splice(piece.end..piece.end, copies);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn damaged(edits: Vec<Edit>, text: &str) -> String {
        let damage = Damage { seed: 0, other: 0, edits, inside: None };
        String::from_utf8(damage.of(&[text.as_bytes().to_vec()])).unwrap()
    }

    #[test]
    fn each_slip_is_what_its_name_says() {
        let half = 1 << 31;
        assert_eq!(damaged(vec![Edit::Cut { at: half }], "abcdefg"), "abcd");
        assert_eq!(damaged(vec![Edit::Number { at: 0, value: 1 }], "a = 12.5;"), "a = -1;");
        assert_eq!(damaged(vec![Edit::RemoveLine { at: half }], "a\nb\nc\n"), "a\nc\n");
        assert_eq!(damaged(vec![Edit::MoveLine { from: half, to: 0 }], "a\nb\nc\n"), "b\na\nc\n");
        assert_eq!(damaged(vec![Edit::RepeatLine { at: 0, times: 2 }], "a\nb\n"), "a\na\na\nb\n");
        let long = damaged(vec![Edit::Repeat { at: 0, length: 2, times: u8::MAX }], "ab");
        assert!(long.len() > MOST / 2 && long.len() <= MOST, "{}", long.len());
        // Nothing is no place to fail at.
        let slips = [Edit::Flip { at: half, bit: 1 }, Edit::Remove { at: half, length: 3 }];
        assert_eq!(damaged(slips.to_vec(), ""), "");
    }
}
