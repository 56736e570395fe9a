//! Code pages 850, 852 and 857 of DOS, as old instrument programs wrote Western and Central European and Turkish texts.
//!
//! The encodings of the web, which `encoding_rs` has, are without them.

use oem_cp::code_table::{DECODING_TABLE_CP850, DECODING_TABLE_CP852, DECODING_TABLE_CP857};
use oem_cp::{decode_string_complete_table, decode_string_incomplete_table_checked};

/// A code page of DOS.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CodePage {
    /// Western European.
    Cp850,
    /// Central European.
    Cp852,
    /// Turkish.
    Cp857,
}

impl CodePage {
    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cp850 => "CP850",
            Self::Cp852 => "CP852",
            Self::Cp857 => "CP857",
        }
    }

    /// The text of bytes; none where one of them has no character.
    pub fn decode(self, bytes: &[u8]) -> Option<String> {
        match self {
            Self::Cp850 => Some(decode_string_complete_table(bytes, &DECODING_TABLE_CP850)),
            Self::Cp852 => Some(decode_string_complete_table(bytes, &DECODING_TABLE_CP852)),
            Self::Cp857 => decode_string_incomplete_table_checked(bytes, &DECODING_TABLE_CP857),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pages_have_their_characters() {
        assert_eq!(
            CodePage::Cp850.decode(b"Kr\x81mmung \xf8 gf.cm\xfd \x87\xc6o").as_deref(),
            Some("Krümmung ° gf.cm² ção")
        );
        assert_eq!(CodePage::Cp852.decode(b"Pr\xa2bka w\xa5tek").as_deref(), Some("Próbka wątek"));
        assert_eq!(CodePage::Cp857.decode(b"\x80\x94zg\x81 At\x8d \x9e").as_deref(), Some("Çözgü Atı Ş"));
        assert_eq!(CodePage::Cp857.decode(b"\xe7"), None);
    }
}
