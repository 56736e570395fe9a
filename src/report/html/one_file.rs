//! The page as one file that can be sent.

use std::collections::BTreeMap;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::text::{decoded, escape};

/// Bytes of a page with its pictures, at most, unless more is wanted: what a mail takes.
pub const LIMIT: usize = 3_000_000;

/// Bytes kept for the note on what was left out.
const NOTE: usize = 2_000;

/// A page in one file.
#[derive(Clone, Debug, PartialEq)]
pub struct OneFile {
    /// The page.
    pub page: String,
    /// Pictures of the folder that the page names and does not hold.
    pub left_out: Vec<String>,
}

/// A piece of a page after `<a href="./`: a link to a file of the folder.
struct Link<'a> {
    /// The picture that it holds, and the rest of its `<img>`.
    picture: Option<(String, &'a str)>,
    /// What it shows.
    inner: &'a str,
    /// What follows.
    after: &'a str,
}

/// A page of [`html`](super::html) that needs no folder: pictures are part of it, and links to files of the folder
/// are their names only. `picture` gives the bytes of a PNG file of the folder. Pictures of one file name (one kind
/// of chart, over all fabrics) are taken in the order of the page, all or none, as long as the page stays within
/// `limit` bytes; the others are named in their places and in a note at the end. `None` of a page that is not of
/// [`html`](super::html).
///
/// # Errors
/// That of `picture`.
pub fn self_contained<E>(
    page: &str,
    limit: usize,
    mut picture: impl FnMut(&str) -> Result<Vec<u8>, E>,
) -> Result<Option<OneFile>, E> {
    let mut parts = page.split("<a href=\"./");
    let mut out = parts.next().unwrap_or_default().to_string();
    // Markup has no raw `<` or `"` elsewhere: all text of a page is escaped.
    let Some(links) = parts.map(link).collect::<Option<Vec<Link>>>() else { return Ok(None) };
    let mut sizes: Vec<(&str, usize)> = Vec::new();
    let mut encoded = BTreeMap::new();
    for (name, _) in links.iter().filter_map(|l| l.picture.as_ref()) {
        let png = STANDARD.encode(picture(name)?);
        match sizes.iter_mut().find(|(kind, _)| *kind == kind_of(name)) {
            Some((_, size)) => *size += png.len(),
            None => sizes.push((kind_of(name), png.len())),
        }
        encoded.insert(name.as_str(), png);
    }
    let kinds = kinds_that_fit(&sizes, limit.saturating_sub(page.len() + NOTE));
    let mut left_out = Vec::new();
    for link in &links {
        match &link.picture {
            Some((name, attributes)) if kinds.contains(&kind_of(name)) => {
                let png = &encoded[name.as_str()];
                out.push_str(&format!("<img src=\"data:image/png;base64,{png}\"{attributes}"));
            }
            Some((name, _)) => {
                out.push_str(&format!("<span class=\"absent\">not in this file: {}</span>", escape(name)));
                left_out.push(name.clone());
            }
            None => out.push_str(link.inner),
        }
        out.push_str(link.after);
    }
    note(&mut out, &left_out);
    Ok(Some(OneFile { page: out, left_out }))
}

fn link(part: &str) -> Option<Link<'_>> {
    let (inner, after) = part.split_once("\">").and_then(|(_, rest)| rest.split_once("</a>"))?;
    let picture = inner
        .strip_prefix("<img src=\"./")
        .and_then(|text| text.split_once('"'))
        .map(|(address, attributes)| (decoded(address), attributes));
    Some(Link { picture, inner, after })
}

/// The name of the file: the same for the same chart of every fabric.
fn kind_of(name: &str) -> &str {
    name.rsplit('/').next().unwrap_or(name)
}

fn kinds_that_fit<'a>(sizes: &[(&'a str, usize)], room: usize) -> Vec<&'a str> {
    let mut left = room;
    let mut fitting = Vec::new();
    for &(kind, size) in sizes {
        if size <= left {
            left -= size;
            fitting.push(kind);
        }
    }
    fitting
}

/// What is not in the file, before the end of the body.
fn note(out: &mut String, left_out: &[String]) {
    if left_out.is_empty() {
        return;
    }
    let mut kinds: Vec<(&str, usize)> = Vec::new();
    for name in left_out {
        match kinds.iter_mut().find(|(kind, _)| *kind == kind_of(name)) {
            Some((_, count)) => *count += 1,
            None => kinds.push((kind_of(name), 1)),
        }
    }
    let list: Vec<String> = kinds.iter().map(|(kind, count)| format!("{} ({count})", escape(kind))).collect();
    let text = format!(
        "<p class=\"absent\" id=\"left-out\">Not in this file, to keep it small enough to send: {} pictures, {}. They are in \
         the folder of results that the page was made from.</p>\n",
        left_out.len(),
        list.join(", ")
    );
    match out.rfind("</main>") {
        Some(end) => out.insert_str(end, &text),
        None => out.push_str(&text),
    }
}
