//! A square piece of fabric as triangles, for programs whose cards hold a mesh.
//!
//! Cloth programs resist bending by hinges between triangles, and what a hinge does for a bent sheet depends on how
//! the triangles lie. On a grid whose diagonals change direction from column to column each column of hinges bends
//! like a strip of its own width: with a hinge energy `½ k (c·w)²/A` of the cotangent operator `c` of Wardetzky et
//! al. (*Comput. Aided Geom. Des.* 24 (2007) 499), A the area of both triangles, the energy per area of a bent sheet
//! is `½ k (w,xx² + w,yy² + 5 w,xy²)` for squares. Four of the five are the diagonals'; the fifth is that of the hinges
//! within a column, whose triangles have their right angles at opposite ends. Were the diagonals to change from cell to
//! cell, the fifth would vanish, but then every second vertex of a row bends freely (MuJoCo's strip drops 3 % more).
//!
//! ```text
//!  j=1  +---+---+---+        The first column of cells lies half before the clamp: points at -h/2 and h/2
//!       | / | \ | / |        are held, so that the hinge between them is the clamp at x = 0.
//!  j=0  +---+---+---+        For stretching the clamp is at h/2.
//!      i=0  1   2   3
//! ```

/// Side of the free part (m).
pub const SIDE: f64 = 0.04;

/// Cells along and across; even.
pub const CELLS: usize = 20;

/// Points and triangles of a square piece that is held along one edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Swatch {
    /// Points (m); x along the free length, from half a cell before the clamp.
    pub points: Vec<[f64; 2]>,
    /// Triangles, counter-clockwise.
    pub triangles: Vec<[usize; 3]>,
    /// Points that are held.
    pub held: Vec<usize>,
}

/// Width of a cell (m): half a cell lies before the clamp.
pub fn cell() -> f64 {
    SIDE / (CELLS as f64 - 0.5)
}

/// The piece whose free length runs along x (`turned`: along y).
pub fn swatch(turned: bool) -> Swatch {
    let h = cell();
    grid(turned, |i| (i as f64 - 0.5) * h, 2)
}

/// The same for finite elements, which have rotations: the clamp is the first row of points.
pub fn clamped(turned: bool) -> Swatch {
    grid(turned, |i| i as f64 * SIDE / CELLS as f64, 1)
}

/// Points at `along(i)`, the first rows of which are held.
fn grid(turned: bool, along: impl Fn(usize) -> f64, rows: usize) -> Swatch {
    let across = CELLS + 1;
    let place = |i: usize, j: usize| {
        let (along, aside) = (along(i), j as f64 * SIDE / CELLS as f64);
        if turned { [aside, along] } else { [along, aside] }
    };
    let points = (0..=CELLS).flat_map(|i| (0..across).map(move |j| place(i, j))).collect();
    let mut triangles = Vec::new();
    for (i, j) in (0..CELLS).flat_map(|i| (0..CELLS).map(move |j| (i, j))) {
        let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| i * across + j);
        let both = if i % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
        triangles.extend(both.map(|[p, q, r]| if turned { [p, r, q] } else { [p, q, r] }));
    }
    Swatch { points, triangles, held: (0..rows * across).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// The triangles cover the rectangle once, all turn left, and the clamp lies in the middle of the held column.
    #[test]
    fn triangles_cover_the_piece() {
        for turned in [false, true] {
            let s = swatch(turned);
            let double = |[p, q, r]: [usize; 3]| {
                let [a, b, c] = [p, q, r].map(|k| s.points[k]);
                (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
            };
            assert!(s.triangles.iter().all(|t| double(*t) > 0.0));
            let area: f64 = s.triangles.iter().map(|t| 0.5 * double(*t)).sum();
            assert_relative_eq!(area, SIDE * (SIDE + 0.5 * cell()), max_relative = 1e-12);
            let along = usize::from(turned);
            let mean: f64 = s.held.iter().map(|k| s.points[*k][along]).sum::<f64>() / s.held.len() as f64;
            assert!(mean.abs() < 1e-15 && s.held.len() == 2 * (CELLS + 1));
            let far = s.points.iter().map(|p| p[along]).fold(0.0, f64::max);
            assert_relative_eq!(far, SIDE, max_relative = 1e-12);
            let shell = clamped(turned);
            assert_eq!((shell.triangles, shell.held.len()), (s.triangles, CELLS + 1));
            assert!(shell.held.iter().all(|k| shell.points[*k][along] == 0.0));
        }
    }
}
