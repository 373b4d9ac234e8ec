//! Short formulas with quantities, whose units are checked: `air.velocity / (4 * air.length_scale)`.
//!
//! ```text
//! sum     = product { (+|-) product }          power = [-] factor [ ^ power ]
//! product = power { (*|/) power }              factor = number [unit] | unit | name | ( sum )
//! ```

use super::{Dimension, excerpt};
use crate::error::Fault;
use std::collections::BTreeSet;
use std::fmt;

/// Longest formula that is read [bytes].
const LONGEST: usize = 1000;
/// Deepest nesting of parentheses and signs.
const DEEPEST: usize = 50;

/// The unit of a quantity as powers of metre, kilogram, second, kelvin and ampere.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Powers([f64; 5]);

impl Powers {
    /// The powers of a dimension.
    pub const fn from_dimension(dimension: Dimension) -> Self {
        Self(dimension.row().powers)
    }

    /// The factor of its number where metre, kilogram, second, kelvin and ampere are so many times smaller.
    pub fn factor(self, smaller: [f64; 5]) -> f64 {
        self.0.iter().zip(smaller).map(|(power, factor)| factor.powf(*power)).product()
    }

    /// Whether the two are equal apart from rounding.
    pub fn agree(self, other: Self) -> bool {
        self.plus(other, -1.0).0.iter().all(|power| power.abs() < 1e-9)
    }

    fn plus(self, other: Self, sign: f64) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + sign * other.0[i]))
    }

    fn times(self, factor: f64) -> Self {
        Self(self.0.map(|power| power * factor))
    }
}

impl fmt::Display for Powers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parts = Vec::new();
        let [metre, kilogram, second, kelvin, ampere] = self.0;
        for (unit, power) in [("kg", kilogram), ("m", metre), ("s", second), ("K", kelvin), ("A", ampere)] {
            if power == 1.0 {
                parts.push(unit.to_owned());
            } else if power != 0.0 {
                parts.push(format!("{unit}^{power}"));
            }
        }
        if parts.is_empty() { f.write_str("a plain number") } else { f.write_str(&parts.join(" ")) }
    }
}

/// A parsed formula.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    text: String,
    root: Node,
}

#[derive(Clone, Debug, PartialEq)]
enum Node {
    Quantity(f64, Powers),
    Name(String),
    Negative(Box<Node>),
    Binary(char, Box<Node>, Box<Node>),
}

impl Expression {
    /// Reads a formula. Numbers may carry units: `10 m/s`, `50 mm`, `1.2 kg/m^3`.
    ///
    /// # Errors
    /// If the text is not a formula.
    pub fn parse(text: &str) -> Result<Self, Fault> {
        let text = text.trim();
        if text.len() > LONGEST {
            return Err(too_long());
        }
        let mut reader = Reader { rest: text, depth: 0 };
        let root = reader.sum()?;
        if !reader.rest.is_empty() {
            return Err(reader.fault("an operator, + - * / or ^,"));
        }
        Ok(Self { text: text.to_owned(), root })
    }

    /// The formula as written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The names of keys that it uses.
    pub fn names(&self) -> BTreeSet<&str> {
        let mut names = BTreeSet::new();
        self.root.names(&mut names);
        names
    }

    /// Its value in SI units, and the unit.
    ///
    /// * `of` – gives value and unit of a name, or none if the name is unknown
    ///
    /// # Errors
    /// If units do not fit or a name is unknown.
    pub fn value(
        &self,
        value_of_key: &dyn Fn(&str) -> Option<(f64, Powers)>,
    ) -> Result<(f64, Powers), Fault> {
        self.root.value(value_of_key)
    }
}

impl Node {
    fn names<'a>(&'a self, names: &mut BTreeSet<&'a str>) {
        match self {
            Self::Quantity(..) => {}
            Self::Name(name) => drop(names.insert(name)),
            Self::Negative(inner) => inner.names(names),
            Self::Binary(_, left, right) => {
                left.names(names);
                right.names(names);
            }
        }
    }

    fn value(&self, value_of_key: &dyn Fn(&str) -> Option<(f64, Powers)>) -> Result<(f64, Powers), Fault> {
        Ok(match self {
            Self::Quantity(value, powers) => (*value, *powers),
            Self::Name(name) => value_of_key(name).ok_or_else(|| {
                unknown_name(name, "write the full name of one, like air.velocity".to_owned())
            })?,
            Self::Negative(inner) => {
                let (value, powers) = inner.value(value_of_key)?;
                (-value, powers)
            }
            Self::Binary(operator, left, right) => {
                let (a, left) = left.value(value_of_key)?;
                let (b, right) = right.value(value_of_key)?;
                match operator {
                    '*' => (a * b, left.plus(right, 1.0)),
                    '/' => (a / b, left.plus(right, -1.0)),
                    '^' if !right.agree(Powers::default()) => {
                        return Err(Fault::new(
                            format!("has an exponent in {right}"),
                            "an exponent must be a plain number",
                        ));
                    }
                    '^' => (libm::pow(a, b), left.times(b)),
                    _ if !left.agree(right) => {
                        return Err(Fault::new(
                            format!("adds {left} and {right}"),
                            "only quantities of the same unit can be added or subtracted",
                        ));
                    }
                    '-' => (a - b, left),
                    _ => (a + b, left),
                }
            }
        })
    }
}

struct Reader<'a> {
    rest: &'a str,
    depth: usize,
}

impl<'a> Reader<'a> {
    fn fault(&self, wanted: &'static str) -> Fault {
        let at = if self.rest.is_empty() { "the end".to_owned() } else { excerpt(self.rest, 20) };
        Fault::new(format!("cannot be read at \"{at}\""), format!("{wanted} is expected there"))
    }

    fn skip(&mut self, bytes: usize) {
        self.rest = self.rest.get(bytes..).unwrap_or_default().trim_start();
    }

    /// Reads the next sign if it is one of these.
    fn take(&mut self, signs: &[char]) -> Option<char> {
        // Typeset text has other characters for minus and times.
        let sign = self.rest.chars().next()?;
        let plain = match sign {
            '−' => '-',
            '×' | '·' => '*',
            other => other,
        };
        if !signs.contains(&plain) {
            return None;
        }
        self.skip(sign.len_utf8());
        Some(plain)
    }

    fn enter_level(&mut self) -> Result<(), Fault> {
        self.depth += 1;
        if self.depth > DEEPEST { Err(too_long()) } else { Ok(()) }
    }

    fn sum(&mut self) -> Result<Node, Fault> {
        let mut left = self.product()?;
        while let Some(sign) = self.take(&['+', '-']) {
            left = Node::Binary(sign, Box::new(left), Box::new(self.product()?));
        }
        Ok(left)
    }

    fn product(&mut self) -> Result<Node, Fault> {
        let mut left = self.power()?;
        while let Some(sign) = self.take(&['*', '/']) {
            left = Node::Binary(sign, Box::new(left), Box::new(self.power()?));
        }
        Ok(left)
    }

    fn power(&mut self) -> Result<Node, Fault> {
        if self.take(&['-']).is_some() {
            self.enter_level()?;
            let inner = self.power()?;
            self.depth -= 1;
            return Ok(Node::Negative(Box::new(inner)));
        }
        let base = self.factor()?;
        self.raised(base)
    }

    fn raised(&mut self, base: Node) -> Result<Node, Fault> {
        if self.take(&['^']).is_none() {
            return Ok(base);
        }
        self.enter_level()?;
        let exponent = self.power()?;
        self.depth -= 1;
        Ok(Node::Binary('^', Box::new(base), Box::new(exponent)))
    }

    fn factor(&mut self) -> Result<Node, Fault> {
        const WANTED: &str = "a number, a key or a parenthesis";
        if self.take(&['(']).is_some() {
            self.enter_level()?;
            let inner = self.sum()?;
            self.depth -= 1;
            return match self.take(&[')']) {
                Some(_) => Ok(inner),
                None => Err(self.fault("a closing parenthesis")),
            };
        }
        let (number, _) = super::split_number(self.rest);
        if number.starts_with(['+', '-']) {
            return Err(self.fault(WANTED));
        }
        if !number.is_empty() {
            let value = super::shifted(number, 0).unwrap_or(f64::NAN);
            self.skip(number.len());
            let name = self.name();
            let Some((scale, powers)) = unit(name) else {
                return Ok(Node::Quantity(value, Powers::default()));
            };
            self.skip(name.len());
            if self.rest.starts_with('^') {
                // `2 mm^2` means two square millimetres.
                let unit = self.raised(Node::Quantity(scale, powers))?;
                let number = Node::Quantity(value, Powers::default());
                return Ok(Node::Binary('*', Box::new(number), Box::new(unit)));
            }
            return Ok(exact(number, name).unwrap_or(Node::Quantity(value * scale, powers)));
        }
        let name = self.name();
        if name.is_empty() {
            return Err(self.fault(WANTED));
        }
        self.skip(name.len());
        Ok(match unit(name) {
            Some((scale, powers)) => Node::Quantity(scale, powers),
            None => Node::Name(name.to_owned()),
        })
    }

    /// Reads the next name. Empty if there is none.
    fn name(&self) -> &'a str {
        let is_in_name = |c: char| c.is_alphabetic() || c.is_ascii_digit() || c == '_' || c == '.';
        let end = self.rest.find(|c| !is_in_name(c)).unwrap_or(self.rest.len());
        let name = self.rest.get(..end).unwrap_or_default();
        if name.starts_with(|c: char| c.is_alphabetic() || c == '_') { name } else { "" }
    }
}

/// Size and powers of a unit, found by its symbol.
fn unit(symbol: &str) -> Option<(f64, Powers)> {
    if symbol == "kg" {
        return Some((1.0, Powers([0.0, 1.0, 0.0, 0.0, 0.0])));
    }
    match exact("1", symbol)? {
        Node::Quantity(value, powers) => Some((value, powers)),
        _ => None,
    }
}

/// The quantity as a key parses it, rounded once.
fn exact(number: &str, symbol: &str) -> Option<Node> {
    if symbol.is_empty() {
        return None;
    }
    let text = format!("{number} {symbol}");
    Dimension::all().find_map(|dimension| {
        let value = dimension.parse(&text).ok()?;
        Some(Node::Quantity(value, Powers::from_dimension(dimension)))
    })
}

fn too_long() -> Fault {
    Fault::new("is too long or has too many nested parentheses", "write it shorter")
}

/// The fault of a name that is not a key with a number.
pub fn unknown_name(name: &str, remedy: String) -> Fault {
    Fault::new(format!("uses {name}, which is not a key with a number"), remedy)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> Result<(f64, Powers), Fault> {
        let value_of_key = |name: &str| match name {
            "air.velocity" => Some((10.0, Powers::from_dimension(Dimension::Velocity))),
            "air.length_scale" => Some((0.05, Powers::from_dimension(Dimension::Length))),
            "air.turbulence_intensity" => Some((0.1, Powers::from_dimension(Dimension::Ratio))),
            _ => None,
        };
        Expression::parse(text)?.value(&value_of_key)
    }

    #[test]
    fn taylors_hypothesis() {
        let (hertz, powers) = value("air.velocity / (4 * air.length_scale)").unwrap();
        assert_eq!(hertz, 50.0);
        assert!(powers.agree(Powers::from_dimension(Dimension::Frequency)));
    }

    #[test]
    fn signs_bind_as_on_paper() {
        for (text, expected) in [
            ("1 + 2 * 3", 7.0),
            ("(1 + 2) * 3", 9.0),
            ("8 / 4 / 2", 1.0),
            ("8 - 4 - 2", 2.0),
            ("2 ^ 3 ^ 2", 512.0),
            ("-2 ^ 2", -4.0),
            ("2 ^ -1", 0.5),
            ("3 - -2", 5.0),
            ("3 × 2 − 1", 5.0),
            ("1e-3 * 1000", 1.0),
            ("50 mm / 1 m", 0.05),
            ("4 mm^2 / (2 mm)^2", 1.0),
            ("(air.velocity / 10 m * s) ^ 0.5", 1.0),
            ("air.velocity / (10 m/s)", 1.0),
            ("air.turbulence_intensity", 0.1),
        ] {
            let (found, powers) = value(text).unwrap_or_else(|fault| panic!("{text} {fault}"));
            assert_eq!(found, expected, "{text}");
            assert!(powers.agree(Powers::default()), "{text} comes out in {powers}");
        }
        assert_eq!(value("50 µm").unwrap(), (5e-5, Powers::from_dimension(Dimension::Length)));
        assert_eq!(value("1.2 kg/m^3").unwrap(), (1.2, Powers::from_dimension(Dimension::Density)));
    }

    #[test]
    fn rejects_what_is_no_formula() {
        for (text, message) in [
            ("", "cannot be read at \"the end\"; a number, a key or a parenthesis is expected there"),
            ("1 +", "cannot be read at \"the end\"; a number, a key or a parenthesis is expected there"),
            ("(1", "cannot be read at \"the end\"; a closing parenthesis is expected there"),
            ("1 2", "cannot be read at \"2\"; an operator, + - * / or ^, is expected there"),
            ("2 ^ 1 m", "has an exponent in m; an exponent must be a plain number"),
            (
                "air.velocity + 1 m",
                "adds m s^-1 and m; only quantities of the same unit can be added or subtracted",
            ),
            (
                "velocity",
                "uses velocity, which is not a key with a number; write the full name of one, like air.velocity",
            ),
        ] {
            assert_eq!(value(text).unwrap_err().to_string(), message, "{text}");
        }
        // A sign may begin a name.
        assert_eq!(
            value("_x").unwrap_err().to_string(),
            "uses _x, which is not a key with a number; write the full name of one, like air.velocity"
        );
        assert_eq!(value(&"(".repeat(2000)), Err(too_long()));
        assert_eq!(value(&"(".repeat(500)), Err(too_long()));
        assert_eq!(value(&"-".repeat(500)), Err(too_long()));
    }

    #[test]
    fn limit_a_formula_has_a_thousand_characters_and_fifty_levels() {
        for length in [LONGEST, LONGEST + 1, LONGEST + 2] {
            let long = "0".repeat(length - 4) + " + 1";
            assert_eq!(value(&long).is_ok(), length == LONGEST, "{length}");
        }
        let nested = |levels: usize| "(".repeat(levels) + "1" + &")".repeat(levels);
        assert!(value(&nested(DEEPEST)).is_ok() && value(&nested(DEEPEST + 1)).is_err());
        // One after the other they are no levels.
        for text in ["(1)", "-1", "1^1"] {
            assert!(value(&[text; 100].join("*")).is_ok(), "{text}");
        }
    }

    #[test]
    fn a_formula_has_its_text_and_the_names_of_its_keys() {
        let formula =
            Expression::parse(" -air.velocity / (4 * air.length_scale ^ 2) + air.velocity").unwrap();
        assert_eq!(formula.text(), "-air.velocity / (4 * air.length_scale ^ 2) + air.velocity");
        assert_eq!(formula.names().into_iter().collect::<Vec<_>>(), ["air.length_scale", "air.velocity"]);
    }

    /// In millimetres and tenths of a second, 1 m/s is 100.
    #[test]
    fn a_quantity_has_another_number_in_smaller_units() {
        let velocity = Powers::from_dimension(Dimension::Velocity);
        assert_eq!(velocity.factor([1000.0, 1.0, 10.0, 1.0, 1.0]), 100.0);
    }
}
