//! Bounds in SQL: `thickness < 0.4 and B_warp < 0.08`.

use std::collections::BTreeSet;

use arrow_array::cast::AsArray;
use arrow_array::types::Float64Type;
use arrow_array::{Array, RecordBatch};
use arrow_schema::{DataType, Schema};
use sqlparser::ast::{BinaryOperator, Expr, Ident, Spanned, UnaryOperator, Value};
use sqlparser::dialect::HiveDialect;
use sqlparser::parser::Parser;
use sqlparser::tokenizer::{Location, Token};

use super::error::LibraryError;

/// What the cure of bounds that are not understood begins with.
const EXAMPLE: &str = "they are like `thickness < 0.4 and B_warp < 0.08`";

/// Bytes of a condition. Nobody types more, and one without end would be deeper than a thread can go.
const MOST: usize = 4096;
/// Steps into brackets and operands. The parser reads a `NOT` that it does not understand again as a name, so that its time
/// doubles with each one inside another: 50 steps, its own limit, took five seconds for 1280 bytes.
const DEEPEST: usize = 24;

/// Bounds that were understood, for a library of certain columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    root: Node,
    columns: BTreeSet<String>,
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
    Compare(BinaryOperator, Box<[Node; 2]>),
    Reckon(BinaryOperator, Box<[Node; 2]>),
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
        // Of the dialects, this one knows names that begin with a figure, such as 2HB_warp.
        let failed = |problem: String, at: Location| bounds(&problem, at, EXAMPLE.into());
        let nowhere = Location::empty();
        if text.len() > MOST {
            return Err(failed(format!("{} bytes are more than {MOST}", text.len()), nowhere));
        }
        let parser = Parser::new(&HiveDialect {}).with_recursion_limit(DEEPEST);
        let mut parser = parser.try_with_sql(text).map_err(|e| failed(e.to_string(), nowhere))?;
        let tree = parser.parse_expr().map_err(|e| failed(e.to_string(), nowhere))?;
        let next = parser.peek_token();
        if next.token != Token::EOF {
            return Err(failed(format!("`{}` is more than a condition", next.token), next.span.start));
        }
        let mut reader = Reader { schema, columns: BTreeSet::new() };
        let root = reader.wanted(&tree, Kind::Truth)?;
        Ok(Self { root, columns: reader.columns })
    }

    /// Names of the columns that they speak of.
    pub fn columns(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(String::as_str)
    }

    /// Whether a row of a table that has these columns is within them; one of which it is not known is not.
    pub fn hold(&self, table: &RecordBatch, row: usize) -> bool {
        value(&self.root, table, row) == Known::Truth(true)
    }
}

fn bounds(problem: &str, at: Location, cure: String) -> LibraryError {
    LibraryError::Bounds { problem: problem.into(), column: at.column as usize, cure }
}

/// What makes bounds of the syntax tree.
struct Reader<'s> {
    schema: &'s Schema,
    columns: BTreeSet<String>,
}

impl Reader<'_> {
    /// The part, if it is of this kind.
    fn wanted(&mut self, tree: &Expr, kind: Kind) -> Result<Node, LibraryError> {
        let (node, found) = self.node(tree)?;
        if found == kind {
            return Ok(node);
        }
        let problem = format!("`{tree}` is {} where {} was expected", found.name(), kind.name());
        Err(bounds(&problem, tree.span().start, EXAMPLE.into()))
    }

    fn node(&mut self, tree: &Expr) -> Result<(Node, Kind), LibraryError> {
        match tree {
            Expr::Nested(inner) => self.node(inner),
            Expr::Identifier(name) => self.column(name),
            Expr::Value(value) => match &value.value {
                Value::Number(text, _) => match text.parse() {
                    Ok(number) => Ok((Node::Number(number), Kind::Number)),
                    Err(_) => Err(refused(tree)),
                },
                Value::SingleQuotedString(text) => Ok((Node::Text(text.clone()), Kind::Text)),
                _ => Err(refused(tree)),
            },
            Expr::UnaryOp { op: UnaryOperator::Not, expr } => {
                Ok((Node::Not(Box::new(self.wanted(expr, Kind::Truth)?)), Kind::Truth))
            }
            Expr::UnaryOp { op: UnaryOperator::Minus, expr } => {
                let pair = Box::new([Node::Number(0.0), self.wanted(expr, Kind::Number)?]);
                Ok((Node::Reckon(BinaryOperator::Minus, pair), Kind::Number))
            }
            Expr::BinaryOp { left, op, right } => self.binary(tree, left, op, right),
            Expr::Between { expr, negated, low, high } => {
                let above = self.compare(expr, &BinaryOperator::GtEq, low)?;
                let below = self.compare(expr, &BinaryOperator::LtEq, high)?;
                Ok((turned(Node::Both(Box::new([above, below])), *negated), Kind::Truth))
            }
            Expr::InList { expr, list, negated } => {
                let mut any = None;
                for one in list {
                    let same = self.compare(expr, &BinaryOperator::Eq, one)?;
                    any = Some(any.map_or(same.clone(), |before| Node::Either(Box::new([before, same]))));
                }
                any.map(|any| (turned(any, *negated), Kind::Truth)).ok_or_else(|| refused(tree))
            }
            Expr::IsNull(inner) => Ok((Node::IsNull(Box::new(self.node(inner)?.0)), Kind::Truth)),
            Expr::IsNotNull(inner) => {
                Ok((turned(Node::IsNull(Box::new(self.node(inner)?.0)), true), Kind::Truth))
            }
            _ => Err(refused(tree)),
        }
    }

    fn binary(
        &mut self,
        tree: &Expr,
        left: &Expr,
        op: &BinaryOperator,
        right: &Expr,
    ) -> Result<(Node, Kind), LibraryError> {
        use BinaryOperator as Op;
        match op {
            Op::And | Op::Or => {
                let both = Box::new([self.wanted(left, Kind::Truth)?, self.wanted(right, Kind::Truth)?]);
                Ok((if *op == Op::And { Node::Both(both) } else { Node::Either(both) }, Kind::Truth))
            }
            Op::Lt | Op::LtEq | Op::Gt | Op::GtEq | Op::Eq | Op::NotEq => {
                Ok((self.compare(left, op, right)?, Kind::Truth))
            }
            Op::Plus | Op::Minus | Op::Multiply | Op::Divide => {
                let both = Box::new([self.wanted(left, Kind::Number)?, self.wanted(right, Kind::Number)?]);
                Ok((Node::Reckon(op.clone(), both), Kind::Number))
            }
            _ => Err(refused(tree)),
        }
    }

    fn compare(&mut self, left: &Expr, op: &BinaryOperator, right: &Expr) -> Result<Node, LibraryError> {
        let (node, kind) = self.node(left)?;
        if kind == Kind::Truth {
            return Err(refused(left));
        }
        Ok(Node::Compare(op.clone(), Box::new([node, self.wanted(right, kind)?])))
    }

    fn column(&mut self, name: &Ident) -> Result<(Node, Kind), LibraryError> {
        let Ok(field) = self.schema.field_with_name(&name.value) else {
            let names: Vec<&str> = self.schema.fields().iter().map(|field| field.name().as_str()).collect();
            let cure = format!("there are {}", names.join(", "));
            return Err(bounds(&format!("there is no column `{}`", name.value), name.span.start, cure));
        };
        let kind = if *field.data_type() == DataType::Utf8 { Kind::Text } else { Kind::Number };
        self.columns.insert(name.value.clone());
        Ok((Node::Column(name.value.clone(), kind), kind))
    }
}

fn turned(node: Node, negated: bool) -> Node {
    if negated { Node::Not(Box::new(node)) } else { node }
}

fn refused(tree: &Expr) -> LibraryError {
    let known = "known are < <= = <> >= >, between, in, is null, and, or, not, + - * / and parentheses";
    bounds(&format!("`{tree}` is not understood"), tree.span().start, format!("{EXAMPLE}; {known}"))
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
                    BinaryOperator::Lt => order.is_lt(),
                    BinaryOperator::LtEq => order.is_le(),
                    BinaryOperator::Gt => order.is_gt(),
                    BinaryOperator::GtEq => order.is_ge(),
                    BinaryOperator::Eq => order.is_eq(),
                    _ => order.is_ne(),
                })
            })
        }
        Node::Reckon(op, parts) => match (value(&parts[0], table, row), value(&parts[1], table, row)) {
            (Known::Number(a), Known::Number(b)) => Known::Number(match op {
                BinaryOperator::Plus => a + b,
                BinaryOperator::Minus => a - b,
                BinaryOperator::Multiply => a * b,
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
        ] {
            let table = table();
            let bounds = Bounds::parse(text, &table.schema()).unwrap();
            assert_eq!([0, 1, 2].map(|row| bounds.hold(&table, row)), expected, "{text}");
        }
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
        assert!(error.contains("recursion limit"), "{error}");
    }

    #[test]
    fn bounds_that_are_not_understood_are_told_with_their_place() {
        for (text, column, problem) in [
            ("tickness < 0.4", 1, "no column `tickness`"),
            ("thickness < 0.4 and B < 1", 21, "no column `B`"),
            ("thickness <", 0, "Expected"),
            ("thickness", 1, "is a number where a condition was expected"),
            ("thickness < 'a'", 13, "is a text where a number was expected"),
            ("thickness < 0.4 2", 17, "more than a condition"),
            ("thickness like 'a'", 1, "is not understood"),
            ("exp(thickness) < 2", 1, "is not understood"),
            ("thickness < 0,4", 14, "more than a condition"),
            ("(thickness < 0.4) = (thickness < 1)", 2, "is not understood"),
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
