//! Names that every system takes for a file or a folder: Linux, Windows and macOS.

use unicode_normalization::UnicodeNormalization;

/// Bytes of a name. File systems take 255, and a number, an ending or the name of a temporary file comes on top.
const MOST: usize = 200;

/// What no name under Windows may hold; `/` and `\` lead into another folder.
const FORBIDDEN: &str = "/\\<>:\"|?*";

/// A name without what no file can have in its own: empty if nothing is left. It may still be that of a device.
pub fn file_name(name: &str) -> String {
    let flat: String =
        name.chars().map(|c| if c.is_control() || FORBIDDEN.contains(c) { '-' } else { c }).collect();
    let bare = |text: &str| text.trim_matches(|c: char| c == '.' || c.is_whitespace()).to_string();
    let short = bare(&flat);
    bare(&short[..short.floor_char_boundary(MOST)])
}

/// Whether Windows takes a name for a device, whatever its ending.
pub fn is_device(name: &str) -> bool {
    let lower = name.to_lowercase();
    let stem = lower.split('.').next().unwrap_or_default().trim_end();
    let is_port = |kind| stem.strip_prefix(kind).is_some_and(|n| PORTS.contains(&n));
    ["con", "prn", "aux", "nul", "conin$", "conout$"].contains(&stem) || is_port("com") || is_port("lpt")
}

/// Numbers of ports; the raised ones count too.
const PORTS: [&str; 13] = ["0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "¹", "²", "³"];

/// What two names share that are one file under Windows or macOS: letters in any case, accents in any form.
pub fn on_disk(name: &str) -> String {
    name.nfc().collect::<String>().to_lowercase().nfc().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_one_of_windows_too() {
        for (name, safe) in [
            ("poplin", "poplin"),
            ("köper, grau (2)", "köper, grau (2)"),
            ("a/b\\c", "a-b-c"),
            ("10:30 <new>?", "10-30 -new--"),
            ("line\nbreak\u{7}", "line-break-"),
            (" .hidden. . ", "hidden"),
            ("..", ""),
            ("\u{3000}", ""),
        ] {
            assert_eq!(file_name(name), safe, "{name:?}");
        }
        let long = file_name(&"ü".repeat(300));
        assert!(long.len() <= MOST && long.chars().all(|c| c == 'ü') && long.len() > MOST - 2);
        assert_eq!(file_name(&format!("{} .", "a".repeat(MOST - 2))), "a".repeat(MOST - 2));
    }

    #[test]
    fn devices_are_known_whatever_their_ending() {
        for name in ["CON", "nul.txt", "Aux", "com1", "LPT9.csv", "com¹", "con .x", "CONIN$"] {
            assert!(is_device(name), "{name}");
        }
        for name in ["cone", "com10", "com", "nullify", "a.con", "lpt"] {
            assert!(!is_device(name), "{name}");
        }
    }

    #[test]
    fn what_is_one_file_elsewhere_is_one_name() {
        assert_eq!(on_disk("Köper"), on_disk("ko\u{308}PER"));
        assert_ne!(on_disk("köper"), on_disk("koper"));
    }
}
