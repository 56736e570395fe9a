//! Code pages 850 and 857 of DOS, as old instrument programs wrote Western European and Turkish texts.
//!
//! The tables are those of Unicode (`VENDORS/MICSFT/PC/CP850.TXT` and `CP857.TXT`); the crate of encodings has web encodings only.

/// A code page of DOS.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CodePage {
    /// Western European.
    Cp850,
    /// Turkish.
    Cp857,
}

/// The characters of the bytes from 80 to FF in code page 850.
const WESTERN: &str = "\
    ÇüéâäàåçêëèïîìÄÅ\
    ÉæÆôöòûùÿÖÜø£Ø×ƒ\
    áíóúñÑªº¿®¬½¼¡«»\
    ░▒▓│┤ÁÂÀ©╣║╗╝¢¥┐\
    └┴┬├─┼ãÃ╚╔╩╦╠═╬¤\
    ðÐÊËÈıÍÎÏ┘┌█▄¦Ì▀\
    ÓßÔÒõÕµþÞÚÛÙýÝ¯´\
    \u{ad}±‗¾¶§÷¸°¨·¹³²■\u{a0}";

/// Where code page 857 differs; the mark of replacement stands for bytes without a character.
const TURKISH: &[(u8, char)] = &[
    (0x8d, 'ı'),
    (0x98, 'İ'),
    (0x9e, 'Ş'),
    (0x9f, 'ş'),
    (0xa6, 'Ğ'),
    (0xa7, 'ğ'),
    (0xd0, 'º'),
    (0xd1, 'ª'),
    (0xd5, '\u{fffd}'),
    (0xe7, '\u{fffd}'),
    (0xe8, '×'),
    (0xec, 'ì'),
    (0xed, 'ÿ'),
    (0xf2, '\u{fffd}'),
];

impl CodePage {
    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cp850 => "CP850",
            Self::Cp857 => "CP857",
        }
    }

    /// The text of bytes; none where one of them has no character.
    pub fn decode(self, bytes: &[u8]) -> Option<String> {
        let mut table: Vec<char> = WESTERN.chars().collect();
        if self == Self::Cp857 {
            for (byte, character) in TURKISH {
                table[usize::from(byte - 0x80)] = *character;
            }
        }
        let characters = bytes.iter().map(|b| match b.checked_sub(0x80) {
            Some(at) => table[usize::from(at)],
            None => char::from(*b),
        });
        let text: String = characters.collect();
        (!text.contains('\u{fffd}')).then_some(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pages_have_their_characters() {
        assert_eq!(WESTERN.chars().count(), 128);
        assert_eq!(
            CodePage::Cp850.decode(b"Kr\x81mmung \xf8 gf.cm\xfd \x87\xc6o").as_deref(),
            Some("Krümmung ° gf.cm² ção")
        );
        assert_eq!(CodePage::Cp857.decode(b"\x80\x94zg\x81 At\x8d \x9e").as_deref(), Some("Çözgü Atı Ş"));
        assert_eq!(CodePage::Cp857.decode(b"\xe7"), None);
    }
}
