//! Code pages of DOS, to write files in: the tables of Python's codecs, not those of the program.

const CP850: &str = "ÇüéâäàåçêëèïîìÄÅÉæÆôöòûùÿÖÜø£Ø×ƒáíóúñÑªº¿®¬½¼¡«»░▒▓│┤ÁÂÀ©╣║╗╝¢¥┐└┴┬├─┼ãÃ╚╔╩╦╠═╬¤ðÐÊËÈıÍÎÏ┘┌█▄¦Ì▀ÓßÔÒõÕµþÞÚÛÙýÝ¯´\u{ad}±‗¾¶§÷¸°¨·¹³²■\u{a0}";
const CP857: &str = "ÇüéâäàåçêëèïîıÄÅÉæÆôöòûùİÖÜø£ØŞşáíóúñÑĞğ¿®¬½¼¡«»░▒▓│┤ÁÂÀ©╣║╗╝¢¥┐└┴┬├─┼ãÃ╚╔╩╦╠═╬¤ºªÊËÈ\u{fffd}ÍÎÏ┘┌█▄¦Ì▀ÓßÔÒõÕµ\u{fffd}×ÚÛÙìÿ¯´\u{ad}±\u{fffd}¾¶§÷¸°¨·¹³²■\u{a0}";

/// The bytes of a text; none where a character is missing.
pub fn encoded(text: &str, page: &str) -> Option<Vec<u8>> {
    let table = if page == "cp850" { CP850 } else { CP857 };
    let byte = |c: char| match u8::try_from(c).ok().filter(u8::is_ascii) {
        Some(byte) => Some(byte),
        None => table.chars().position(|t| t == c).and_then(|at| u8::try_from(at + 128).ok()),
    };
    text.chars().map(byte).collect()
}
