//! The grammar of bounds, a part of SQL's: what stands in a text, and where.

use std::ops::Range;

use winnow::ascii::{Caseless, float, multispace0};
use winnow::combinator::{alt, delimited, fail, not, opt, peek, preceded, repeat, separated};
use winnow::error::ContextError;
use winnow::prelude::*;
use winnow::stream::{LocatingSlice, Location};
use winnow::token::{any, one_of, take_till, take_while};

type Input<'t> = LocatingSlice<&'t str>;
type Parsed<T> = winnow::Result<T, ContextError>;

/// Brackets within brackets. Each takes some steps of the parser, and nobody writes more.
const DEEPEST: usize = 50;
/// Words that are no names unless they stand in quotes.
const RESERVED: [&str; 7] = ["and", "or", "not", "between", "in", "is", "null"];

/// A part of a text with its bytes there.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    pub span: Range<usize>,
    pub form: ExpressionKind,
}

#[derive(Clone, Debug, PartialEq)]
pub enum ExpressionKind {
    Number(f64),
    Text(String),
    Name(String),
    Not(Box<Expression>),
    Minus(Box<Expression>),
    Binary(Operator, Box<[Expression; 2]>),
    IsNull(Box<Expression>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    And,
    Or,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    Different,
    Plus,
    Minus,
    Times,
    Over,
}

/// What is wrong with a text, and at which byte.
pub type GrammarError = (String, usize);

/// The expression that the text is.
pub fn expression(text: &str) -> Result<Expression, GrammarError> {
    let mut depth = 0_usize;
    for (at, sign) in text.char_indices() {
        match sign {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > DEEPEST {
            return Err((format!("more than {DEEPEST} brackets stand within each other"), at));
        }
    }
    (disjunction, multispace0).map(|(whole, _)| whole).parse(Input::new(text)).map_err(|error| {
        let rest = text[error.offset()..].trim_start();
        let at = text.len() - rest.len();
        match rest.split_whitespace().next() {
            Some(word) => (format!("`{word}` is not understood there"), at),
            None => ("the condition ends too early".to_string(), at),
        }
    })
}

fn disjunction(input: &mut Input<'_>) -> Parsed<Expression> {
    chain(input, conjunction, keyword("or").value(Operator::Or))
}

fn conjunction(input: &mut Input<'_>) -> Parsed<Expression> {
    chain(input, negation, keyword("and").value(Operator::And))
}

fn negation(input: &mut Input<'_>) -> Parsed<Expression> {
    prefixed(input, keyword("not"), comparison, ExpressionKind::Not)
}

fn comparison(input: &mut Input<'_>) -> Parsed<Expression> {
    let left = sum(input)?;
    if let Some(operator) = opt(compared).parse_next(input)? {
        let right = sum(input)?;
        return Ok(joined(operator, left, right));
    }
    if opt(keyword("is")).parse_next(input)?.is_some() {
        let negated = opt(keyword("not")).parse_next(input)?.is_some();
        keyword("null").parse_next(input)?;
        return Ok(since(left.span.start, input, ExpressionKind::IsNull(Box::new(left)), negated));
    }
    // Both are read as what they are short for.
    let start = left.span.start;
    let negated =
        opt((keyword("not"), peek(alt((keyword("between"), keyword("in")))))).parse_next(input)?.is_some();
    if opt(keyword("between")).parse_next(input)?.is_some() {
        let low = joined(Operator::GreaterOrEqual, left.clone(), sum(input)?);
        keyword("and").parse_next(input)?;
        let high = joined(Operator::LessOrEqual, left, sum(input)?);
        return Ok(since(start, input, joined(Operator::And, low, high).form, negated));
    }
    if opt(keyword("in")).parse_next(input)?.is_some() {
        let list: Vec<_> =
            delimited(sign("("), separated(1.., sum, sign(",")), sign(")")).parse_next(input)?;
        let each = list.into_iter().map(|one| joined(Operator::Equal, left.clone(), one));
        let Some(any) = each.reduce(|some, one| joined(Operator::Or, some, one)) else {
            return fail.parse_next(input);
        };
        return Ok(since(start, input, any.form, negated));
    }
    Ok(left)
}

fn sum(input: &mut Input<'_>) -> Parsed<Expression> {
    let operator = alt((sign("+").value(Operator::Plus), sign("-").value(Operator::Minus)));
    chain(input, product, operator)
}

fn product(input: &mut Input<'_>) -> Parsed<Expression> {
    let operator = alt((sign("*").value(Operator::Times), sign("/").value(Operator::Over)));
    chain(input, factor, operator)
}

fn factor(input: &mut Input<'_>) -> Parsed<Expression> {
    prefixed(input, sign("-"), atom, ExpressionKind::Minus)
}

fn atom(input: &mut Input<'_>) -> Parsed<Expression> {
    multispace0.void().parse_next(input)?;
    let start = input.current_token_start();
    let form = match peek(any).parse_next(input)? {
        '(' => return delimited(sign("("), disjunction, sign(")")).parse_next(input),
        '\'' => quoted('\'').map(ExpressionKind::Text).parse_next(input)?,
        quote @ ('"' | '`') => quoted(quote).map(ExpressionKind::Name).parse_next(input)?,
        // Names may begin with a figure, such as 2HB_warp.
        '0'..='9' | '.' => {
            alt((number.map(ExpressionKind::Number), name.map(ExpressionKind::Name))).parse_next(input)?
        }
        _ => name.map(ExpressionKind::Name).parse_next(input)?,
    };
    Ok(Expression { span: start..input.current_token_start(), form })
}

fn number(input: &mut Input<'_>) -> Parsed<f64> {
    let (number, ()) = (float, not(one_of(is_of_a_word))).parse_next(input)?;
    Ok(number)
}

fn name(input: &mut Input<'_>) -> Parsed<String> {
    let is_free = |word: &&str| !RESERVED.iter().any(|reserved| reserved.eq_ignore_ascii_case(word));
    take_while(1.., is_of_a_word).verify(is_free).map(str::to_string).parse_next(input)
}

/// What stands between two quotes; a quote in it is doubled.
fn quoted<'t>(quote: char) -> impl Parser<Input<'t>, String, ContextError> {
    let doubled = (quote, quote).take();
    let inner =
        repeat(0.., alt((take_till(1.., quote), doubled.map(move |two: &str| &two[quote.len_utf8()..]))));
    delimited(quote, inner.fold(String::new, |text, part: &str| text + part), quote)
}

fn compared(input: &mut Input<'_>) -> Parsed<Operator> {
    alt((
        sign("<=").value(Operator::LessOrEqual),
        alt((sign("<>"), sign("!="))).value(Operator::Different),
        sign("<").value(Operator::Less),
        sign(">=").value(Operator::GreaterOrEqual),
        sign(">").value(Operator::Greater),
        alt((sign("=="), sign("="))).value(Operator::Equal),
    ))
    .parse_next(input)
}

fn keyword<'t>(word: &'static str) -> impl Parser<Input<'t>, (), ContextError> {
    (multispace0, Caseless(word), not(one_of(is_of_a_word))).void()
}

fn sign<'t>(sign: &'static str) -> impl Parser<Input<'t>, (), ContextError> {
    preceded(multispace0, sign).void()
}

fn is_of_a_word(sign: char) -> bool {
    sign.is_alphanumeric() || sign == '_'
}

/// Parts with operators between them, from the left.
fn chain<'t>(
    input: &mut Input<'t>,
    part: fn(&mut Input<'t>) -> Parsed<Expression>,
    mut operator: impl Parser<Input<'t>, Operator, ContextError>,
) -> Parsed<Expression> {
    let mut left = part(input)?;
    while let Some(operator) = opt(operator.by_ref()).parse_next(input)? {
        left = joined(operator, left, part(input)?);
    }
    Ok(left)
}

/// A part with any number of a prefix before it.
fn prefixed<'t>(
    input: &mut Input<'t>,
    mut prefix: impl Parser<Input<'t>, (), ContextError>,
    part: fn(&mut Input<'t>) -> Parsed<Expression>,
    form: fn(Box<Expression>) -> ExpressionKind,
) -> Parsed<Expression> {
    multispace0.void().parse_next(input)?;
    let mut starts = Vec::new();
    let mut start = input.current_token_start();
    while opt(prefix.by_ref()).parse_next(input)?.is_some() {
        starts.push(start);
        start = input.current_token_start();
    }
    let inner = part(input)?;
    Ok(starts
        .into_iter()
        .rev()
        .fold(inner, |inner, start| Expression { span: start..inner.span.end, form: form(Box::new(inner)) }))
}

fn joined(operator: Operator, left: Expression, right: Expression) -> Expression {
    let span = left.span.start..right.span.end;
    Expression { span, form: ExpressionKind::Binary(operator, Box::new([left, right])) }
}

/// What began at a byte and ends here, or its contrary.
fn since(start: usize, input: &Input<'_>, form: ExpressionKind, negated: bool) -> Expression {
    let span = start..input.current_token_start();
    let whole = Expression { span: span.clone(), form };
    if negated { Expression { span, form: ExpressionKind::Not(Box::new(whole)) } } else { whole }
}
