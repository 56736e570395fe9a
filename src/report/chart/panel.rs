//! The column beside a plot: legend, values, errors. Nothing in it can lie over data.

use plotters::prelude::RGBColor;

use super::canvas::{Align, Canvas, Point, Stroke, Type};
use super::error::ChartError;
use super::palette::{GREY, GROUPS, INK};

/// One line of the column.
#[derive(Clone, Debug)]
pub(super) enum Row {
    /// A heading over what follows.
    Heading(String),
    /// A sample of a line and what it stands for.
    Sample(Stroke, String),
    /// The marker of a group (by number) and what it stands for.
    Marker(usize, String),
    /// A name, and a value at the right edge; below the name where both do not fit.
    Value(String, String),
    /// A remark, broken into lines as needed.
    Remark(String, RGBColor),
    /// What does not fit into the line above, and how far from the left edge it begins.
    More(String, f64),
    /// Half a line of nothing.
    Gap,
}

const LINE: f64 = 37.0;
const SIZE: f64 = 25.0;
const SAMPLE: f64 = 66.0;
const MARKER: f64 = 34.0;
/// Between the sample of a line and its name.
const AFTER_SAMPLE: f64 = 14.0;
/// The least between a name and its value.
const BETWEEN: f64 = 12.0;

/// Draws the rows from `top` down, between `left` and `right`, closer together if they must be to end
/// above `bottom`.
pub(super) fn draw(
    canvas: &mut Canvas,
    rows: &[Row],
    [left, right]: [f64; 2],
    [top, bottom]: [f64; 2],
) -> Result<(), ChartError> {
    let mut broken = Vec::new();
    for row in rows {
        broken.extend(lines_of(canvas, row, right - left)?);
    }
    let lines: f64 = broken.iter().map(|r| if matches!(r, Row::Gap) { 0.5 } else { 1.0 }).sum();
    let shrink = ((bottom - top) / (lines * LINE)).min(1.0);
    let size = SIZE * shrink.max(0.7);
    let mut y = top;
    for row in &broken {
        if matches!(row, Row::Gap) {
            y += 0.5 * LINE * shrink;
            continue;
        }
        y += LINE * shrink;
        let baseline = y - 0.3 * LINE * shrink;
        draw_row(canvas, row, [left, right], baseline, size)?;
    }
    Ok(())
}

/// A row as lines of a width: no word of it is cut where it can be broken.
fn lines_of(canvas: &Canvas, row: &Row, width: f64) -> Result<Vec<Row>, ChartError> {
    let text = Type::new(SIZE, INK);
    Ok(match row {
        Row::Remark(remark, color) => {
            let lines = wrap(canvas, remark, Type::new(SIZE * 0.92, *color), width)?;
            lines.into_iter().map(|line| Row::Remark(line, *color)).collect()
        }
        Row::Heading(heading) => {
            let lines = wrap(canvas, heading, text.bold(), width)?;
            lines.into_iter().map(Row::Heading).collect()
        }
        Row::Marker(group, name) => {
            let lines = wrap(canvas, name, text, width - MARKER)?;
            first_and_more(lines, |line| Row::Marker(*group, line), MARKER)
        }
        Row::Sample(stroke, name) => {
            let lines = wrap(canvas, name, text, width - SAMPLE - AFTER_SAMPLE)?;
            first_and_more(lines, |line| Row::Sample(*stroke, line), SAMPLE + AFTER_SAMPLE)
        }
        Row::Value(name, value)
            if canvas.text_width(name, text)? + canvas.text_width(value, text)? > width - BETWEEN =>
        {
            vec![Row::Value(name.clone(), String::new()), Row::Value(String::new(), value.clone())]
        }
        row => vec![row.clone()],
    })
}

/// The first line as a row of its kind, and the others below it.
fn first_and_more(lines: Vec<String>, first: impl Fn(String) -> Row, indent: f64) -> Vec<Row> {
    let mut lines = lines.into_iter();
    let mut rows = vec![first(lines.next().unwrap_or_default())];
    rows.extend(lines.map(|line| Row::More(line, indent)));
    rows
}

fn draw_row(
    canvas: &mut Canvas,
    row: &Row,
    [left, right]: [f64; 2],
    baseline: f64,
    size: f64,
) -> Result<(), ChartError> {
    let text = Type::new(size, INK);
    let middle = baseline - 0.36 * size;
    match row {
        Row::Heading(heading) => canvas.text((left, baseline), heading, text.bold()),
        Row::Sample(stroke, name) => {
            canvas.line(&[(left, middle), (left + SAMPLE, middle)], *stroke)?;
            canvas.text((left + SAMPLE + AFTER_SAMPLE, baseline), name, text)
        }
        Row::Marker(group, name) => {
            marker(canvas, (left + 12.0, middle), 10.0, *group)?;
            canvas.text((left + MARKER, baseline), name, text)
        }
        Row::More(line, indent) => canvas.text((left + indent, baseline), line, text),
        Row::Value(name, value) => {
            let width = canvas.text_width(value, text)?;
            let name = fitted(canvas, name, text, right - left - width - BETWEEN)?;
            canvas.text((left, baseline), &name, Type { color: GREY, ..text })?;
            canvas.text((right, baseline), value, text.align(Align::Right))
        }
        Row::Remark(line, color) => canvas.text((left, baseline), line, Type::new(size * 0.92, *color)),
        Row::Gap => Ok(()),
    }
}

/// The marker of a group: colour and shape differ, so that groups are told apart in grey too.
pub(super) fn marker(canvas: &mut Canvas, at: Point, radius: f64, group: usize) -> Result<(), ChartError> {
    let color = GROUPS[group % GROUPS.len()];
    let around = |corners: &[(f64, f64)]| -> Vec<Point> {
        corners.iter().map(|(x, y)| (at.0 + radius * x, at.1 + radius * y)).collect()
    };
    match group % 4 {
        0 => canvas.dot(at, radius, color),
        1 => canvas.polygon(&around(&[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)]), color),
        2 => canvas.polygon(&around(&[(0.0, -1.2), (1.1, 0.8), (-1.1, 0.8)]), color),
        _ => canvas.polygon(&around(&[(0.0, -1.3), (1.2, 0.0), (0.0, 1.3), (-1.2, 0.0)]), color),
    }
}

/// Breaks a text at blanks into lines that fit; a single word that is too long is shortened.
pub(super) fn wrap(canvas: &Canvas, text: &str, kind: Type, width: f64) -> Result<Vec<String>, ChartError> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let candidate = match lines.last() {
            Some(line) => format!("{line} {word}"),
            None => word.to_string(),
        };
        if canvas.text_width(&candidate, kind)? <= width && !lines.is_empty() {
            if let Some(line) = lines.last_mut() {
                *line = candidate;
            }
        } else {
            lines.push(fitted(canvas, word, kind, width)?);
        }
    }
    Ok(lines)
}

/// The text itself, or its beginning with an ellipsis where it would not fit.
pub(super) fn fitted(canvas: &Canvas, text: &str, kind: Type, width: f64) -> Result<String, ChartError> {
    if canvas.text_width(text, kind)? <= width {
        return Ok(text.to_string());
    }
    let mut kept: Vec<char> = text.chars().collect();
    while kept.pop().is_some() {
        let shorter: String = kept.iter().chain(&['…']).collect();
        if canvas.text_width(&shorter, kind)? <= width {
            return Ok(shorter);
        }
    }
    Ok("…".to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(row: &Row) -> &str {
        match row {
            Row::Heading(text) | Row::Sample(_, text) | Row::Marker(_, text) => text,
            Row::Value(name, value) => {
                if name.is_empty() {
                    value
                } else {
                    name
                }
            }
            Row::Remark(text, _) | Row::More(text, _) => text,
            Row::Gap => "",
        }
    }

    /// The last words of a legend may be those that matter: `on an assumed E`.
    #[test]
    fn words_are_broken_into_lines_and_not_cut() {
        let canvas = Canvas::new();
        let rows = [
            Row::Heading("warp, simulated, on an assumed E".into()),
            Row::Sample(Stroke::solid(INK, 3.0), "warp, simulated, on an assumed E".into()),
            Row::Value("warp".into(), "0.013355 ± 0.000052 gf·cm²/cm".into()),
        ];
        let words = |row: &Row| {
            let lines = lines_of(&canvas, row, 260.0).unwrap();
            (lines.len(), lines.iter().map(text).collect::<Vec<_>>().join(" "))
        };
        let [heading, sample, value] = rows.each_ref().map(words);
        assert!(heading.0 > 1 && sample.0 > 1 && value.0 == 2, "{heading:?} {sample:?} {value:?}");
        assert_eq!([heading.1.as_str(), sample.1.as_str()], ["warp, simulated, on an assumed E"; 2]);
        assert_eq!(value.1, "warp 0.013355 ± 0.000052 gf·cm²/cm");
    }
}
