//! Bounds in SQL: `thickness < 0.4 and B_warp < 0.08`.

use std::collections::BTreeSet;

use super::error::LibraryError;
use super::grammar::{self, Expression, ExpressionKind, Operator};
use super::space::is_of_status;
use crate::finding::nearest;
use arrow_array::cast::AsArray;
use arrow_array::types::Float64Type;
use arrow_array::{Array, RecordBatch};
use arrow_schema::{DataType, Schema};

/// What the cure of bounds that are not understood begins with.
const EXAMPLE: &str = "they are like `thickness < 0.4 and B_warp < 0.08`";

/// Bytes of a condition. Nobody types more, and one without end would be a tree deeper than a thread can go.
const MOST: usize = 4096;

/// Bounds that were understood, for a library of certain columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    root: Node,
    columns: BTreeSet<String>,
    /// Columns of text, and what they are compared with.
    texts: BTreeSet<(String, String)>,
}

/// A part of bounds.
#[derive(Clone, Debug, PartialEq)]
enum Node {
    Number(f64),
    Text(String),
    Column(String, Kind),
    Not(Box<Node>),
    Both(Box<[Node; 2]>),
    Either(Box<[Node; 2]>),
    Compare(Operator, Box<[Node; 2]>),
    Reckon(Operator, Box<[Node; 2]>),
    IsNull(Box<Node>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Number,
    Text,
    Truth,
}

/// What a part comes to in a row; nothing of what is not known (SQL's logic of three values).
#[derive(Clone, Copy, Debug, PartialEq)]
enum Known<'r> {
    Nothing,
    Number(f64),
    Text(&'r str),
    Truth(bool),
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Self::Number => "a number",
            Self::Text => "a text",
            Self::Truth => "a condition",
        }
    }
}

impl Bounds {
    /// Understands bounds over the columns of a table.
    ///
    /// # Errors
    /// O071 with the place in the text, what was found, and what could stand there.
    pub fn parse(text: &str, schema: &Schema) -> Result<Self, LibraryError> {
        if text.len() > MOST {
            return Err(bounds(&format!("{} bytes are more than {MOST}", text.len()), 0, EXAMPLE.into()));
        }
        let mut reader = Reader { text, schema, columns: BTreeSet::new(), texts: BTreeSet::new() };
        let tree = grammar::expression(text)
            .map_err(|(problem, at)| reader.refused(&problem, at, &with_what_is_known()))?;
        let root = reader.wanted(&tree, Kind::Truth)?;
        Ok(Self { root, columns: reader.columns, texts: reader.texts })
    }

    /// Names of the columns that they speak of.
    pub fn columns(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(String::as_str)
    }

    /// Columns of text, each with a text that it is to be, or not to be.
    pub(super) fn texts(&self) -> impl Iterator<Item = (&str, &str)> {
        self.texts.iter().map(|(column, text)| (column.as_str(), text.as_str()))
    }

    /// Whether a row of a table that has these columns is within them; one of which it is not known is not.
    pub fn hold(&self, table: &RecordBatch, row: usize) -> bool {
        value(&self.root, table, row) == Known::Truth(true)
    }
}

fn bounds(problem: &str, column: usize, cure: String) -> LibraryError {
    LibraryError::Bounds { problem: problem.into(), column, cure }
}

fn with_what_is_known() -> String {
    format!(
        "{EXAMPLE}; known are < <= = <> >= >, between, in, is null, and, or, not, + - * / and parentheses"
    )
}

/// The columns of a library, and the one that was probably meant.
fn columns_there_are(name: &str, schema: &Schema) -> String {
    let names: Vec<&str> = schema.fields().iter().map(|field| field.name().as_str()).collect();
    let (statuses, values): (Vec<&str>, Vec<&str>) =
        names.iter().copied().partition(|name| is_of_status(name));
    let mut there_are = format!("there are {}", values.join(", "));
    if let Some(status) = statuses.first() {
        there_are += &format!("; and the status of each value, such as {status}");
    }
    match nearest(name, names) {
        Some(meant) => format!("{there_are}; did you mean `{meant}`?"),
        None => there_are,
    }
}

/// What makes bounds of an expression.
struct Reader<'s> {
    text: &'s str,
    schema: &'s Schema,
    columns: BTreeSet<String>,
    texts: BTreeSet<(String, String)>,
}

impl Reader<'_> {
    fn refused(&self, problem: &str, at: usize, cure: &str) -> LibraryError {
        bounds(problem, self.text[..at].chars().count() + 1, cure.into())
    }

    /// The part, if it is of this kind.
    fn wanted(&mut self, part: &Expression, kind: Kind) -> Result<Node, LibraryError> {
        let (node, found) = self.node(part)?;
        if found == kind {
            return Ok(node);
        }
        let text = &self.text[part.span.clone()];
        let problem = format!("`{text}` is {} where {} was expected", found.name(), kind.name());
        Err(self.refused(&problem, part.span.start, EXAMPLE))
    }

    fn node(&mut self, part: &Expression) -> Result<(Node, Kind), LibraryError> {
        Ok(match &part.form {
            ExpressionKind::Number(number) => (Node::Number(*number), Kind::Number),
            ExpressionKind::Text(text) => (Node::Text(text.clone()), Kind::Text),
            ExpressionKind::Name(name) => return self.column(name, part.span.start),
            ExpressionKind::Not(inner) => {
                (Node::Not(Box::new(self.wanted(inner, Kind::Truth)?)), Kind::Truth)
            }
            ExpressionKind::Minus(inner) => {
                let pair = Box::new([Node::Number(0.0), self.wanted(inner, Kind::Number)?]);
                (Node::Reckon(Operator::Minus, pair), Kind::Number)
            }
            ExpressionKind::Binary(operator, sides) => return self.binary(*operator, sides),
            ExpressionKind::IsNull(inner) => (Node::IsNull(Box::new(self.node(inner)?.0)), Kind::Truth),
        })
    }

    fn binary(&mut self, operator: Operator, sides: &[Expression; 2]) -> Result<(Node, Kind), LibraryError> {
        let [left, right] = sides;
        match operator {
            Operator::And | Operator::Or => {
                let both = Box::new([self.wanted(left, Kind::Truth)?, self.wanted(right, Kind::Truth)?]);
                Ok((
                    if operator == Operator::And { Node::Both(both) } else { Node::Either(both) },
                    Kind::Truth,
                ))
            }
            Operator::Plus | Operator::Minus | Operator::Times | Operator::Over => {
                let both = Box::new([self.wanted(left, Kind::Number)?, self.wanted(right, Kind::Number)?]);
                Ok((Node::Reckon(operator, both), Kind::Number))
            }
            Operator::Less
            | Operator::LessOrEqual
            | Operator::Greater
            | Operator::GreaterOrEqual
            | Operator::Equal
            | Operator::Different => Ok((self.compare(operator, left, right)?, Kind::Truth)),
        }
    }

    fn compare(
        &mut self,
        operator: Operator,
        left: &Expression,
        right: &Expression,
    ) -> Result<Node, LibraryError> {
        let (node, kind) = self.node(left)?;
        if kind == Kind::Truth {
            let problem = format!("`{}` is no value that can be compared", &self.text[left.span.clone()]);
            return Err(self.refused(&problem, left.span.start, &with_what_is_known()));
        }
        let sides = [node, self.wanted(right, kind)?];
        if let (
            [Node::Column(column, _), Node::Text(text)] | [Node::Text(text), Node::Column(column, _)],
            true,
        ) = (&sides, matches!(operator, Operator::Equal | Operator::Different))
        {
            self.texts.insert((column.clone(), text.clone()));
        }
        Ok(Node::Compare(operator, Box::new(sides)))
    }

    fn column(&mut self, name: &str, at: usize) -> Result<(Node, Kind), LibraryError> {
        let Ok(field) = self.schema.field_with_name(name) else {
            let cure = columns_there_are(name, self.schema);
            return Err(self.refused(&format!("there is no column `{name}`"), at, &cure));
        };
        let kind = if *field.data_type() == DataType::Utf8 { Kind::Text } else { Kind::Number };
        self.columns.insert(name.to_string());
        Ok((Node::Column(name.to_string(), kind), kind))
    }
}

fn value<'r>(node: &'r Node, table: &'r RecordBatch, row: usize) -> Known<'r> {
    match node {
        Node::Number(number) => Known::Number(*number),
        Node::Text(text) => Known::Text(text),
        Node::Column(name, kind) => cell(table, name, *kind, row),
        Node::Not(inner) => match value(inner, table, row) {
            Known::Truth(truth) => Known::Truth(!truth),
            _ => Known::Nothing,
        },
        Node::Both(parts) => joined(parts, table, row, false),
        Node::Either(parts) => joined(parts, table, row, true),
        Node::IsNull(inner) => Known::Truth(value(inner, table, row) == Known::Nothing),
        Node::Compare(op, parts) => {
            let order = match (value(&parts[0], table, row), value(&parts[1], table, row)) {
                (Known::Number(a), Known::Number(b)) => a.partial_cmp(&b),
                (Known::Text(a), Known::Text(b)) => Some(a.cmp(b)),
                _ => None,
            };
            order.map_or(Known::Nothing, |order| {
                Known::Truth(match op {
                    Operator::Less => order.is_lt(),
                    Operator::LessOrEqual => order.is_le(),
                    Operator::Greater => order.is_gt(),
                    Operator::GreaterOrEqual => order.is_ge(),
                    Operator::Equal => order.is_eq(),
                    _ => order.is_ne(),
                })
            })
        }
        Node::Reckon(op, parts) => match (value(&parts[0], table, row), value(&parts[1], table, row)) {
            (Known::Number(a), Known::Number(b)) => Known::Number(match op {
                Operator::Plus => a + b,
                Operator::Minus => a - b,
                Operator::Times => a * b,
                _ => a / b,
            }),
            _ => Known::Nothing,
        },
    }
}

/// And, or if `decided` is true, or: one that decides is enough, whatever the other is.
fn joined<'r>(parts: &'r [Node; 2], table: &'r RecordBatch, row: usize, decided: bool) -> Known<'r> {
    let known = [&parts[0], &parts[1]].map(|part| value(part, table, row));
    if known.contains(&Known::Truth(decided)) {
        Known::Truth(decided)
    } else if known.contains(&Known::Nothing) {
        Known::Nothing
    } else {
        Known::Truth(!decided)
    }
}

fn cell<'r>(table: &'r RecordBatch, name: &str, kind: Kind, row: usize) -> Known<'r> {
    let Some(column) = table.column_by_name(name).filter(|column| column.is_valid(row)) else {
        return Known::Nothing;
    };
    let text = || column.as_string_opt::<i32>().map(|texts| Known::Text(texts.value(row)));
    let number = || column.as_primitive_opt::<Float64Type>().map(|numbers| Known::Number(numbers.value(row)));
    if kind == Kind::Text { text() } else { number() }.unwrap_or(Known::Nothing)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use arrow_array::{Float64Array, StringArray};
    use arrow_schema::Field;

    use super::*;

    fn table() -> RecordBatch {
        let schema = Schema::new(vec![
            Field::new("fabric", DataType::Utf8, true),
            Field::new("thickness", DataType::Float64, true),
            Field::new("2HB_warp", DataType::Float64, true),
        ]);
        let names = StringArray::from(vec!["a", "b", "c"]);
        let thickness = Float64Array::from(vec![Some(0.3), Some(0.5), None]);
        let hysteresis = Float64Array::from(vec![Some(0.02), Some(0.08), Some(0.04)]);
        RecordBatch::try_new(
            Arc::new(schema),
            vec![Arc::new(names), Arc::new(thickness), Arc::new(hysteresis)],
        )
        .unwrap()
    }

    #[test]
    fn bounds_pick_rows_and_what_is_not_known_is_not_within_them() {
        for (text, expected) in [
            ("thickness < 0.4", [true, false, false]),
            ("not thickness < 0.4", [false, true, false]),
            ("thickness < 0.4 or 2HB_warp < 0.05", [true, false, true]),
            ("thickness < 0.4 and \"2HB_warp\" >= 0.02", [true, false, false]),
            ("thickness is null", [false, false, true]),
            ("thickness is not null and 2HB_warp <> 0.08", [true, false, false]),
            ("2HB_warp between 0.02 and 0.04", [true, false, true]),
            ("2HB_warp not between 0.02 and 0.04", [false, true, false]),
            ("fabric in ('a', 'c')", [true, false, true]),
            ("fabric > 'a'", [false, true, true]),
            ("-thickness * 2 + 1 > 2HB_warp / 0.08", [true, false, false]),
            ("(thickness - 0.1) - 0.1 < 0.2 AND fabric != 'it''s'", [true, false, false]),
            ("`thickness`<4e-1 Or NOT(fabric=='b')", [true, false, true]),
            ("1 - 0.5 - 0.25 = 0.25 and 8 / 2 / 2 = 2 and - - 1 = 1", [true, true, true]),
            ("fabric not in ('a') and thickness is not null", [false, true, false]),
        ] {
            let table = table();
            let bounds = Bounds::parse(text, &table.schema()).unwrap();
            assert_eq!([0, 1, 2].map(|row| bounds.hold(&table, row)), expected, "{text}");
        }
    }

    #[test]
    fn the_column_that_was_meant_is_told_and_texts_are_known() {
        let schema = table().schema();
        let said = |text: &str| Bounds::parse(text, &schema).unwrap_err().to_string();
        assert!(said("2hb_warp < 1").ends_with("did you mean `2HB_warp`?"), "{}", said("2hb_warp < 1"));
        assert!(said("Thickness < 1").ends_with("did you mean `thickness`?"));
        assert!(said("drapability < 1").ends_with("there are fabric, thickness, 2HB_warp"));
        let bounds = "fabric in ('a', 'x') and not 'b' = fabric and fabric > 'c' and thickness < 1";
        let bounds = Bounds::parse(bounds, &schema).unwrap();
        let texts: Vec<_> = bounds.texts().collect();
        assert_eq!(texts, [("fabric", "a"), ("fabric", "b"), ("fabric", "x")]);
    }

    #[test]
    fn a_condition_without_end_is_refused_and_a_long_one_is_not() {
        let long = |terms: usize| format!("thickness < 0.4{}", " and 1<2".repeat(terms));
        let table = table();
        assert!(Bounds::parse(&long(500), &table.schema()).unwrap().hold(&table, 0));
        let error = Bounds::parse(&long(20_000), &table.schema()).unwrap_err().to_string();
        assert!(error.contains("more than 4096"), "{error}");
    }

    #[test]
    fn brackets_within_brackets_are_understood_to_a_depth() {
        let table = table();
        let nested = |depth: usize| format!("{}thickness < 0.4{}", "not (".repeat(depth), ")".repeat(depth));
        assert!(Bounds::parse(&nested(8), &table.schema()).unwrap().hold(&table, 0));
        let error = Bounds::parse(&nested(60), &table.schema()).unwrap_err().to_string();
        assert!(error.contains("more than 50 brackets"), "{error}");
        // Each of these was read twice by an earlier parser, and 50 took seconds.
        let negated = format!("{}thickness < 0.4", "not ".repeat(900));
        assert!(Bounds::parse(&negated, &table.schema()).unwrap().hold(&table, 0));
    }

    #[test]
    fn bounds_that_are_not_understood_are_told_with_their_place() {
        for (text, column, problem) in [
            ("tickness < 0.4", 1, "no column `tickness`"),
            ("thickness < 0.4 and B < 1", 21, "no column `B`"),
            ("thickness <", 12, "ends too early"),
            ("thickness < 0.4 and", 20, "ends too early"),
            ("(thickness < 0.4", 17, "ends too early"),
            ("fabric = 'a", 12, "ends too early"),
            ("thickness < 0.4)", 16, "`)` is not understood"),
            ("thickness", 1, "is a number where a condition was expected"),
            ("thickness < 'a'", 13, "is a text where a number was expected"),
            ("thickness < 0.4 2", 17, "`2` is not understood"),
            ("thickness like 'a'", 11, "`like` is not understood"),
            ("exp(thickness) < 2", 4, "is not understood"),
            ("thickness < 0,4", 14, "`,4` is not understood"),
            ("(thickness < 0.4) = (thickness < 1)", 2, "is no value that can be compared"),
        ] {
            match Bounds::parse(text, &table().schema()) {
                Err(LibraryError::Bounds { problem: found, column: at, cure }) => {
                    assert!(found.contains(problem) && at == column, "{text}: {found} at {at}");
                    assert!(cure.contains("thickness"), "{cure}");
                }
                other => panic!("{text}: {other:?}"),
            }
        }
    }
}
