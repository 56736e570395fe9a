//! A picture as colours that can be calculated with.

use std::io::Cursor;

use image::{DynamicImage, ImageBuffer, ImageDecoder, ImageReader, Limits, Luma, Rgba};

/// A number at each pixel.
pub(super) type Field = ImageBuffer<Luma<f32>, Vec<f32>>;
/// Red, green, blue and cover at each pixel, 0 to 1, the colours times the cover.
pub(super) type Colours = ImageBuffer<Rgba<f32>, Vec<f32>>;

/// Longest side of the picture that is worked on: an outline is found between pixels, so that more add time only.
const LONGEST: u32 = 900;

/// A picture, made smaller where it is large.
pub(super) struct Raster {
    /// Pixels of the picture as it was given: width and height.
    pub size: [u32; 2],
    /// What is worked on.
    pub colours: Colours,
}

impl Raster {
    /// Decodes PNG or JPEG, turned as the camera says.
    ///
    /// # Errors
    /// What the decoder says.
    pub fn decode(bytes: &[u8]) -> Result<Self, String> {
        let picture = decoded(bytes).map_err(|e| e.to_string())?;
        let (width, height) = (picture.width(), picture.height());
        let small = if width.max(height) > LONGEST { picture.thumbnail(LONGEST, LONGEST) } else { picture };
        let mut colours = small.into_rgba32f();
        for Rgba([r, g, b, cover]) in colours.pixels_mut() {
            [*r, *g, *b] = [*r * *cover, *g * *cover, *b * *cover];
        }
        Ok(Self { size: [width, height], colours })
    }

    /// A place on the smaller picture, in pixels of the picture as it was given.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (width, height) = self.colours.dimensions();
        [x * f64::from(self.size[0]) / f64::from(width), y * f64::from(self.size[1]) / f64::from(height)]
    }

    /// Pixels of the picture as it was given in one of the smaller one.
    pub fn factor(&self) -> f64 {
        let [x, y] = self.place([1.0, 1.0]);
        (x * y).sqrt()
    }
}

/// A picture (PNG or JPEG), turned as the camera says.
///
/// # Errors
/// Those of the decoder, and one for a picture that takes more than half a gigabyte.
pub(crate) fn decoded(bytes: &[u8]) -> Result<DynamicImage, image::ImageError> {
    let mut decoder = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?.into_decoder()?;
    // What a file says of its size is not believed: half a gigabyte is more than any camera's picture.
    let mut limits = Limits::default();
    limits.reserve(decoder.total_bytes())?;
    decoder.set_limits(limits)?;
    let orientation = decoder.orientation()?;
    let mut picture = DynamicImage::from_decoder(decoder)?;
    picture.apply_orientation(orientation);
    Ok(picture)
}
