//! Strokes of DXF drawings.

use std::f64::consts::TAU;
use std::path::Path;

use dxf::entities::{Entity, EntityType, Insert};
use dxf::enums::Units;
use kurbo::{Affine, Arc, Point, Vec2};

use super::dxf_text::{self, Written};
use super::reading::{DrawingOptions, LeftOutOfDrawing, ReadDrawing, leave_out, refused, unit_of};
use super::spline::Spline;
use super::strokes::{SmoothCurve, Stroke};
use crate::finding::Place;
use crate::mesh::MeshError;

/// Entities that can be a contour, or a part of one, or bring some.
const READ: [&str; 8] = ["LINE", "ARC", "CIRCLE", "ELLIPSE", "LWPOLYLINE", "POLYLINE", "SPLINE", "INSERT"];
/// Parts of the entity before them.
const PARTS: [&str; 3] = ["VERTEX", "SEQEND", "ATTRIB"];
/// Entities that say something and cut nothing.
const NOTES: [&str; 15] = [
    "TEXT",
    "MTEXT",
    "RTEXT",
    "ARCALIGNEDTEXT",
    "ATTDEF",
    "POINT",
    "DIMENSION",
    "LEADER",
    "MULTILEADER",
    "MLEADER",
    "TOLERANCE",
    "HATCH",
    "VIEWPORT",
    "IMAGE",
    "WIPEOUT",
];
/// Most blocks within one another.
const DEEPEST: usize = 16;
/// Most strokes that blocks may make.
const MOST: usize = 100_000;

/// The drawing of a DXF file.
///
/// # Errors
/// M021 with the line.
pub(super) fn parse(
    path: &Path,
    bytes: &[u8],
    options: &DrawingOptions<'_>,
) -> Result<ReadDrawing, MeshError> {
    let text = dxf_text::decoded(bytes).map_err(|m| refused(Place::file(path), m))?;
    let written = dxf_text::entities(&text).map_err(|(line, m)| refused(Place::at(path, line, 0), m))?;
    let short = written.shortened(&text);
    let file = dxf::Drawing::load_with_encoding(&mut short.as_bytes(), encoding_rs::UTF_8)
        .map_err(|e| refused(Place::file(path), format!("the drawing cannot be read: {e}")))?;
    let mut reading = Reading {
        path,
        file: &file,
        blocks: &written.blocks,
        layer: options.layer,
        strokes: Vec::new(),
        left_out: Vec::new(),
        height: None,
    };
    let entities: Vec<&Entity> = file.entities().collect();
    reading.entities(&entities, &written.drawn, Affine::IDENTITY, &[])?;
    let Reading { strokes, left_out, .. } = reading;
    let unit = unit_of(path, unit(path, &file)?, options.unit)?;
    Ok(ReadDrawing { strokes, to_metres: Affine::scale(unit), left_out })
}

/// $INSUNITS.
fn unit(path: &Path, file: &dxf::Drawing) -> Result<Option<(f64, &'static str)>, MeshError> {
    Ok(Some(match file.header.default_drawing_units {
        Units::Unitless => return Ok(None),
        Units::Inches => (0.0254, "$INSUNITS 1, inches"),
        Units::Feet => (0.3048, "$INSUNITS 2, feet"),
        Units::Millimeters => (1e-3, "$INSUNITS 4, millimetres"),
        Units::Centimeters => (1e-2, "$INSUNITS 5, centimetres"),
        Units::Meters => (1.0, "$INSUNITS 6, metres"),
        Units::Mils => (0.0254e-3, "$INSUNITS 9, mils"),
        Units::Yards => (0.9144, "$INSUNITS 10, yards"),
        Units::Microns => (1e-6, "$INSUNITS 13, microns"),
        Units::Decimeters => (0.1, "$INSUNITS 14, decimetres"),
        other => {
            let message =
                format!("its unit is {other:?} ($INSUNITS): save it in mm, cm, m, inches, feet or yards");
            return Err(refused(Place::file(path), message));
        }
    }))
}

struct Reading<'a> {
    path: &'a Path,
    file: &'a dxf::Drawing,
    blocks: &'a [Vec<Written<'a>>],
    layer: Option<&'a str>,
    strokes: Vec<Stroke>,
    left_out: Vec<LeftOutOfDrawing>,
    /// The z of everything that was drawn so far.
    height: Option<f64>,
}

impl<'a> Reading<'a> {
    /// Strokes of entities, moved as the blocks that they are in.
    fn entities(
        &mut self,
        entities: &[&Entity],
        written: &[Written<'a>],
        by: Affine,
        inside: &[&str],
    ) -> Result<(), MeshError> {
        let mut read = entities.iter().filter(|e| is_read(e));
        for written in written.iter().filter(|w| !PARTS.contains(&w.kind)) {
            let place = Place::at(self.path, written.line, 0);
            let entity = if READ.contains(&written.kind) {
                let Some(entity) = read.next() else {
                    let message =
                        format!("{} cannot be read: it, or one before it, is damaged", written.what());
                    return Err(refused(place, message));
                };
                Some(*entity)
            } else {
                None
            };
            // What a block is on layer 0 is on the layer of its insertion.
            let layer = match inside.last() {
                Some(outer) if written.layer == "0" => *outer,
                _ => written.layer,
            };
            let brings = matches!(entity.map(|e| &e.specific), Some(EntityType::Insert(_)));
            if !brings && self.layer.is_some_and(|wanted| wanted != layer) {
                continue;
            }
            match entity {
                None if NOTES.contains(&written.kind) => {
                    leave_out(&mut self.left_out, place, written.kind);
                }
                None => {
                    let message = format!(
                        "{} is not read: draw it by lines, arcs, polylines or splines (\"explode\" it), or name the layer of the \
                         contours",
                        written.what()
                    );
                    return Err(refused(place, message));
                }
                Some(entity) if entity.common.is_in_paper_space => {
                    let what = format!("{} on paper", written.kind);
                    leave_out(&mut self.left_out, place, &what);
                }
                Some(entity) if !entity.common.is_visible => {
                    let what = format!("invisible {}", written.kind);
                    leave_out(&mut self.left_out, place, &what);
                }
                Some(Entity { specific: EntityType::Insert(insert), .. }) => {
                    self.insert(insert, written, layer, by, inside)?;
                }
                Some(entity) => {
                    let (curves, closed) = self
                        .curves(entity)
                        .map_err(|why| refused(place.clone(), format!("{}: {why}", written.what())))?;
                    let curves = curves.iter().map(|c| c.transformed(by)).collect();
                    let names = if layer == "0" { Vec::new() } else { vec![layer.to_string()] };
                    self.strokes.push(Stroke { curves, closed, names, place, what: written.what() });
                }
            }
        }
        Ok(())
    }

    /// What a block holds, where it is inserted.
    fn insert(
        &mut self,
        insert: &Insert,
        written: &Written<'a>,
        layer: &str,
        by: Affine,
        inside: &[&str],
    ) -> Result<(), MeshError> {
        let place = Place::at(self.path, written.line, 0);
        let found = self.file.blocks().position(|b| b.name.eq_ignore_ascii_case(&insert.name));
        let Some((block, entities)) =
            found.and_then(|i| Some((self.file.blocks().nth(i)?, self.blocks.get(i)?)))
        else {
            let message =
                format!("{} names the block \"{}\", which is not there", written.what(), insert.name);
            return Err(refused(place, message));
        };
        if inside.len() >= DEEPEST || self.strokes.len() > MOST {
            let message = format!("{}: blocks lie too deep in one another, or are too many", written.what());
            return Err(refused(place, message));
        }
        let mirror = mirror(&insert.extrusion_direction)
            .map_err(|why| refused(place.clone(), format!("{}: {why}", written.what())))?;
        let [columns, rows] = [insert.column_count, insert.row_count].map(|n| i64::from(n.max(1)));
        if columns * rows > 1000 {
            return Err(refused(
                place,
                format!("{} repeats a block {} times", written.what(), columns * rows),
            ));
        }
        let entities_of_block: Vec<&Entity> = block.entities.iter().collect();
        let within: Vec<&str> = inside.iter().copied().chain([layer]).collect();
        for (row, column) in (0..rows).flat_map(|r| (0..columns).map(move |c| (r, c))) {
            let step = Vec2::new(insert.column_spacing * column as f64, insert.row_spacing * row as f64);
            let own = mirror
                * Affine::translate((insert.location.x, insert.location.y))
                * Affine::rotate(insert.rotation.to_radians())
                * Affine::translate(step)
                * Affine::scale_non_uniform(insert.x_scale_factor, insert.y_scale_factor)
                * Affine::translate((-block.base_point.x, -block.base_point.y));
            self.entities(&entities_of_block, entities, by * own, &within)?;
        }
        Ok(())
    }

    fn level(&mut self, z: f64, size: f64) -> Result<(), String> {
        let height = *self.height.get_or_insert(z);
        if (z - height).abs() <= 1e-6 * size.max(1.0) {
            return Ok(());
        }
        Err(format!(
            "it is at z = {z}, and something before it at z = {height}: a piece lies in a plane z = const"
        ))
    }

    /// Its curves, and whether the last one ends where the first one begins.
    fn curves(&mut self, entity: &Entity) -> Result<(Vec<SmoothCurve>, bool), String> {
        match &entity.specific {
            EntityType::Line(line) => {
                for p in [&line.p1, &line.p2] {
                    self.level(p.z, p.x.abs().max(p.y.abs()))?;
                }
                Ok((vec![SmoothCurve::line(flat(&line.p1), flat(&line.p2))], false))
            }
            EntityType::Arc(arc) => {
                let by = mirror(&arc.normal)?;
                let mut sweep = (arc.end_angle - arc.start_angle).to_radians().rem_euclid(TAU);
                if sweep == 0.0 {
                    sweep = TAU;
                }
                self.level(arc.center.z, arc.radius)?;
                let curve = circle(&arc.center, arc.radius, arc.start_angle.to_radians(), sweep)?;
                Ok((vec![curve.transformed(by)], false))
            }
            EntityType::Circle(of) => {
                self.level(of.center.z, of.radius)?;
                Ok((vec![circle(&of.center, of.radius, 0.0, TAU)?.transformed(mirror(&of.normal)?)], true))
            }
            EntityType::Ellipse(e) => {
                let upside_down = mirror(&e.normal)? != Affine::IDENTITY;
                let axis = Vec2::new(e.major_axis.x, e.major_axis.y);
                let sweep = e.end_parameter - e.start_parameter;
                let whole = (sweep.abs() - TAU).abs() < 1e-9 || sweep == 0.0;
                let mut sweep = if whole { TAU } else { sweep.rem_euclid(TAU) };
                let mut start = e.start_parameter;
                self.level(e.center.z, axis.hypot())?;
                let sizes =
                    axis.hypot() > 0.0 && e.minor_axis_ratio > 0.0 && e.minor_axis_ratio <= 1.0 + 1e-6;
                if !sizes || e.major_axis.z.abs() > 1e-9 * axis.hypot() {
                    return Err("its axes make no ellipse in the plane".into());
                }
                if upside_down {
                    // Its axis is in space, and it runs the other way about it.
                    (start, sweep) = (-start, -sweep);
                }
                let radii = Vec2::new(axis.hypot(), axis.hypot() * e.minor_axis_ratio);
                let arc = Arc::new(flat(&e.center), radii, start, sweep, axis.atan2());
                Ok((vec![checked(&arc)?], whole))
            }
            EntityType::LwPolyline(line) => {
                let points: Vec<(Point, f64)> =
                    line.vertices.iter().map(|v| (Point::new(v.x, v.y), v.bulge)).collect();
                self.level(entity.common.elevation, 0.0)?;
                let by = mirror(&line.extrusion_direction)?;
                Ok((polyline(&points, line.is_closed(), by)?, line.is_closed()))
            }
            EntityType::Polyline(line) => {
                // 16 and 64: nets and bodies.
                if line.flags & (16 | 64) != 0 {
                    return Err("it is a net or a body, no line".into());
                }
                // 16: points that lead a smoothed line, and lie beside it.
                let drawn: Vec<_> = line.vertices().filter(|v| v.flags & 16 == 0).collect();
                for v in &drawn {
                    self.level(
                        v.location.z.max(line.location.z),
                        v.location.x.abs().max(v.location.y.abs()),
                    )?;
                }
                let points: Vec<(Point, f64)> = drawn.iter().map(|v| (flat(&v.location), v.bulge)).collect();
                let by = mirror(&line.normal)?;
                Ok((polyline(&points, line.is_closed(), by)?, line.is_closed()))
            }
            EntityType::Spline(spline) => self.spline(spline),
            _ => Err("it is not read".into()),
        }
    }

    fn spline(&mut self, spline: &dxf::entities::Spline) -> Result<(Vec<SmoothCurve>, bool), String> {
        if spline.control_points.is_empty() {
            return Err("it has points that it passes and no control points: save it with them".into());
        }
        let weights = &spline.weight_values;
        if !weights.is_empty() && weights.len() != spline.control_points.len() {
            return Err("it has other numbers of weights and of control points".into());
        }
        for p in &spline.control_points {
            self.level(p.z, p.x.abs().max(p.y.abs()))?;
        }
        let weights = weights.iter().copied().chain(std::iter::repeat(1.0));
        let control = spline.control_points.iter().map(flat).zip(weights).collect();
        let degree = usize::try_from(spline.degree_of_curve).unwrap_or(0);
        let spline = Spline { degree, knots: spline.knot_values.clone(), control };
        match spline.defect() {
            Some(defect) => Err(defect),
            None => Ok((spline.curves(), false)),
        }
    }
}

fn is_read(entity: &Entity) -> bool {
    matches!(
        entity.specific,
        EntityType::Line(_)
            | EntityType::Arc(_)
            | EntityType::Circle(_)
            | EntityType::Ellipse(_)
            | EntityType::LwPolyline(_)
            | EntityType::Polyline(_)
            | EntityType::Spline(_)
            | EntityType::Insert(_)
    )
}

fn flat(p: &dxf::Point) -> Point {
    Point::new(p.x, p.y)
}

/// From the coordinates of an entity to those of the drawing: one that is seen from below has its x to the other side.
fn mirror(normal: &dxf::Vector) -> Result<Affine, String> {
    if normal.x.abs().max(normal.y.abs()) > 1e-6 * normal.z.abs() || normal.z == 0.0 {
        return Err("it lies in no plane z = const (its extrusion direction)".into());
    }
    Ok(if normal.z > 0.0 { Affine::IDENTITY } else { Affine::FLIP_X })
}

fn circle(centre: &dxf::Point, radius: f64, start: f64, sweep: f64) -> Result<SmoothCurve, String> {
    checked(&Arc::new(flat(centre), Vec2::splat(radius), start, sweep, 0.0))
}

/// An arc whose numbers make one.
fn checked(arc: &Arc) -> Result<SmoothCurve, String> {
    let numbers = [arc.center.x, arc.center.y, arc.radii.y, arc.start_angle, arc.sweep_angle, arc.x_rotation];
    if !(numbers.iter().all(|n| n.is_finite()) && arc.radii.x > 0.0 && arc.radii.x.is_finite()) {
        return Err("its radius is not positive, or a number is not finite".into());
    }
    Ok(SmoothCurve::arc(arc))
}

fn polyline(points: &[(Point, f64)], closed: bool, by: Affine) -> Result<Vec<SmoothCurve>, String> {
    if points.len() < 2 {
        return Err("it has fewer than two points".into());
    }
    if !points.iter().all(|(p, bulge)| p.is_finite() && bulge.abs() < 1e6) {
        return Err("it has a number that is not finite, or a bulge that is none".into());
    }
    let last = if closed { points.len() } else { points.len() - 1 };
    let mut curves = Vec::with_capacity(last);
    for k in 0..last {
        let ((from, bulge), (to, _)) = (points[k], points[(k + 1) % points.len()]);
        // A point twice is no curve, and no corner.
        if from != to {
            curves.push(SmoothCurve::bulge(from, to, bulge).transformed(by));
        }
    }
    if curves.is_empty() { Err("all its points are one".into()) } else { Ok(curves) }
}
