//! The page as one file that can be sent.

use std::collections::{BTreeMap, BTreeSet};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::figure::FigureKind;
use super::text::{decoded, escape};

/// Bytes of a page with its pictures, at most, unless more is wanted: what a mail takes.
pub const LIMIT: usize = 3_000_000;

/// What a picture stands in.
const FIGURE: &str = "<figure>";

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
    /// The picture that it holds.
    picture: Option<Picture<'a>>,
    /// What it shows.
    inner: &'a str,
    /// What follows.
    after: &'a str,
}

/// A picture of the folder.
struct Picture<'a> {
    /// Its file.
    name: String,
    /// The rest of its `<img>`.
    attributes: &'a str,
    /// What it is of.
    kind: FigureKind,
}

impl Picture<'_> {
    /// The name of the file: the same for the same chart of every fabric.
    fn chart(&self) -> &str {
        chart_of(&self.name)
    }
}

/// A page of [`html`](super::html) that needs no folder: pictures are part of it, and links to files of the folder
/// are their names only. `picture` gives the bytes of a PNG or SVG file of the folder. Pictures are taken as long
/// as the page stays within `limit` bytes, what is worth most first ([`FigureKind`]): those of one file name (one chart of every
/// fabric) together, or, where there is not room for all of them, those of the first fabrics of the page. The others are named
/// in a line at their place and in a note at the end. `None` of a page that is not of
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
    let mut encoded = BTreeMap::new();
    for picture_of in links.iter().filter_map(|l| l.picture.as_ref()) {
        encoded.insert(picture_of.name.as_str(), STANDARD.encode(picture(&picture_of.name)?));
    }
    let taken = those_that_fit(&links, &encoded, limit.saturating_sub(page.len() + NOTE));
    let mut left_out = Vec::new();
    // Charts that are left out of the block of figures that is being written.
    let mut absent = Vec::new();
    for link in &links {
        let mut after = link.after;
        match &link.picture {
            Some(picture) if taken.contains(picture.name.as_str()) => {
                let bytes = &encoded[picture.name.as_str()];
                let kind = if picture.name.ends_with(".svg") { "svg+xml" } else { "png" };
                out.push_str(&format!("<img src=\"data:image/{kind};base64,{bytes}\"{}", picture.attributes));
            }
            Some(picture) => {
                absent.push(picture.chart());
                left_out.push(picture.name.clone());
                after = without_figure(&mut out, after);
            }
            None => out.push_str(link.inner),
        }
        push_with_absent(&mut out, after, &mut absent);
    }
    note(&mut out, &left_out);
    Ok(Some(OneFile { page: out, left_out }))
}

fn link(part: &str) -> Option<Link<'_>> {
    let (inner, after) = part.split_once("\">").and_then(|(_, rest)| rest.split_once("</a>"))?;
    let picture = inner.strip_prefix("<img src=\"./").and_then(|text| text.split_once('"')).map(
        |(address, attributes)| Picture {
            name: decoded(address),
            attributes,
            kind: FigureKind::of_attributes(attributes),
        },
    );
    Some(Link { picture, inner, after })
}

/// What follows a link; at the end of a block of figures, with the charts that are left out of it in one line.
fn push_with_absent(out: &mut String, after: &str, absent: &mut Vec<&str>) {
    // No text of the page has a raw `<`, and figures have no `<div>` in them.
    let Some(end) = after.find("</div>").filter(|_| !absent.is_empty()) else { return out.push_str(after) };
    let list = escape(&std::mem::take(absent).join(", "));
    out.push_str(&format!("{}<p class=\"absent\">Not in this file: {list}.</p>\n", &after[..end]));
    out.push_str(&after[end..]);
}

/// Takes the frame of a picture that is left out away, with its caption; what follows it.
fn without_figure<'a>(out: &mut String, after: &'a str) -> &'a str {
    if out.ends_with(FIGURE) {
        out.truncate(out.len() - FIGURE.len());
    }
    after.split_once("</figure>\n").map_or(after, |(_, rest)| rest)
}

/// The name of the file: the same for the same chart of every fabric.
fn chart_of(name: &str) -> &str {
    name.rsplit('/').next().unwrap_or(name)
}

/// Names of the pictures that there is room for.
fn those_that_fit<'a>(links: &'a [Link], encoded: &BTreeMap<&str, String>, room: usize) -> BTreeSet<&'a str> {
    let mut charts: Vec<(FigureKind, &str, Vec<&str>)> = Vec::new();
    for picture in links.iter().filter_map(|link| link.picture.as_ref()) {
        match charts.iter_mut().find(|(kind, chart, _)| (*kind, *chart) == (picture.kind, picture.chart())) {
            Some((.., names)) => names.push(&picture.name),
            None => charts.push((picture.kind, picture.chart(), vec![&picture.name])),
        }
    }
    // Those of one worth stay in the order of the page.
    charts.sort_by_key(|(kind, ..)| *kind);
    let mut remaining = room;
    let mut fits = |name: &str| {
        let rest = encoded.get(name).and_then(|bytes| remaining.checked_sub(bytes.len()));
        remaining = rest.unwrap_or(remaining);
        rest.is_some()
    };
    // Of a chart that there is not room for in all fabrics, those of the first fabrics.
    let mut taken = BTreeSet::new();
    for (.., names) in charts {
        taken.extend(names.into_iter().take_while(|name| fits(name)));
    }
    taken
}

/// What is not in the file, before the end of the body.
fn note(out: &mut String, left_out: &[String]) {
    if left_out.is_empty() {
        return;
    }
    let mut kinds: Vec<(&str, usize)> = Vec::new();
    for name in left_out {
        match kinds.iter_mut().find(|(kind, _)| *kind == chart_of(name)) {
            Some((_, count)) => *count += 1,
            None => kinds.push((chart_of(name), 1)),
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
