//! Packs what is large and seldom asked for of what is built in: the fonts of the charts, to half of their size and less.

use std::io::Result;

fn main() -> Result<()> {
    println!("cargo:rerun-if-changed=build.rs");
    #[cfg(feature = "results")]
    fonts::pack()?;
    Ok(())
}

/// Writes what src/report/chart/fonts.rs unpacks.
#[cfg(feature = "results")]
mod fonts {
    use std::io::{Result, Write as _};
    use std::path::PathBuf;
    use std::{env, fs};

    use flate2::Compression;
    use flate2::write::ZlibEncoder;
    use unifont::enumerate_glyphs;

    pub fn pack() -> Result<()> {
        write("dejavu-sans-regular", dejavu::sans::regular())?;
        write("dejavu-sans-bold", dejavu::sans::bold())?;
        write("unifont", &glyphs())
    }

    fn write(name: &str, bytes: &[u8]) -> Result<()> {
        let mut packed = ZlibEncoder::new(Vec::new(), Compression::default());
        packed.write_all(bytes)?;
        let folder = PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default());
        fs::write(folder.join(format!("{name}.zlib")), packed.finish()?)
    }

    /// Of each character in rising order: its code (4 bytes), its width in dots (1 byte), and the dots of its 16 rows from above
    /// (2 bytes each), where the highest bit is the dot on the left. Numbers begin with their lowest byte.
    fn glyphs() -> Vec<u8> {
        let mut bytes = Vec::new();
        for (character, glyph) in enumerate_glyphs() {
            bytes.extend(u32::from(character).to_le_bytes());
            bytes.push(glyph.get_width() as u8);
            for y in 0..16 {
                let row = (0..16).fold(0u16, |row, x| row << 1 | u16::from(glyph.get_pixel(x, y)));
                bytes.extend(row.to_le_bytes());
            }
        }
        bytes
    }
}
