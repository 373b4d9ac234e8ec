//! The lines of a file by their tables.

/// A table with its lines. The first of a file has no name.
#[derive(Clone)]
struct Table {
    name: String,
    lines: Vec<String>,
}

/// Tables with their lines, in order.
pub struct Lines(Vec<Table>);

/// The heading of a layer, without its outer brackets.
const LAYER: &str = "[layer]";

impl Lines {
    pub fn new(text: &str) -> Self {
        let table = |name: &str| Table { name: name.to_owned(), lines: Vec::new() };
        let mut tables = vec![table("")];
        for line in text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#')) {
            match line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
                Some(name) => tables.push(table(name)),
                None => tables.last_mut().expect("a table").lines.push(line.to_owned()),
            }
        }
        Self(tables)
    }

    /// Writes a key; false if it is of a table within another.
    pub fn set(&mut self, key: &str, value: &str) -> bool {
        let Some((table, name)) = key.split_once('.').filter(|(_, name)| !name.contains('.')) else {
            return false;
        };
        let is_plain = value.parse::<f64>().is_ok() || ["true", "false"].contains(&value);
        let line = if is_plain { format!("{name} = {value}") } else { format!("{name} = \"{value}\"") };
        if !self.0.iter().any(|own| own.name == table) {
            self.0.push(Table { name: table.to_owned(), lines: Vec::new() });
        }
        let table = self.0.iter_mut().find(|own| own.name == table).expect("a table");
        table.lines.retain(|line| line.split('=').next().is_none_or(|own| own.trim() != name));
        table.lines.push(line);
        true
    }

    /// The value of a key, without quotation marks.
    pub fn value(&self, table: &str, key: &str) -> Option<String> {
        let lines = self.0.iter().filter(|own| own.name == table).flat_map(|own| &own.lines);
        let mut pairs = lines.filter_map(|line| line.split_once('='));
        pairs.find(|(name, _)| name.trim() == key).map(|(_, value)| value.trim().trim_matches('"').to_owned())
    }

    /// With other values of some keys, from their full names and their values without quotation marks.
    pub fn map(&self, other: impl Fn(&str, &str) -> Option<String>) -> Self {
        let line = |table: &str, line: &str| {
            let (name, value) = line.split_once('=')?;
            let other = other(&format!("{table}.{}", name.trim()), value.trim().trim_matches('"'))?;
            Some(format!("{name}= \"{other}\""))
        };
        let table = |Table { name, lines }: &Table| {
            let lines = lines.iter().map(|own| line(name, own).unwrap_or_else(|| own.clone()));
            Table { name: name.clone(), lines: lines.collect() }
        };
        Self(self.0.iter().map(table).collect())
    }

    /// The tables in another order, except those of layers, and the lines of each too.
    pub fn turned(mut self) -> Self {
        let common = self.0.iter().position(|table| table.name == LAYER).unwrap_or(self.0.len());
        self.0[1..common].reverse();
        self.0.iter_mut().for_each(|table| table.lines.reverse());
        self
    }

    /// The layers in another order.
    pub fn with_turned_layers(mut self) -> Self {
        let common = self.0.iter().position(|table| table.name == LAYER).unwrap_or(self.0.len());
        let mut layers: Vec<Vec<Table>> = Vec::new();
        for table in self.0.drain(common..) {
            if table.name == LAYER {
                layers.push(Vec::new());
            }
            layers.last_mut().expect("a layer").push(table);
        }
        self.0.extend(layers.into_iter().rev().flatten());
        self
    }

    /// Some tables as those of two equal layers.
    ///
    /// * `layer` – a line in its place in the first layer and in the second one, from its full key and its value
    pub fn with_two_layers(
        mut self,
        names: &[&str],
        layer: impl Fn(usize, &str, &str) -> Option<String>,
    ) -> Self {
        let (in_layers, common): (Vec<Table>, Vec<Table>) =
            self.0.drain(..).partition(|table| names.contains(&table.name.as_str()));
        self.0 = common;
        for number in 0..2 {
            self.0.push(Table { name: LAYER.to_owned(), lines: Vec::new() });
            for Table { name, lines } in &in_layers {
                let line = |line: &String| {
                    let (key, value) = line.split_once('=')?;
                    layer(number, &format!("{name}.{}", key.trim()), value.trim())
                };
                let lines = lines.iter().filter_map(line).collect();
                self.0.push(Table { name: format!("layer.{name}"), lines });
            }
        }
        self
    }

    pub fn text(&self) -> String {
        let table = |Table { name, lines }: &Table| {
            let head = if name.is_empty() { String::new() } else { format!("[{name}]\n") };
            head + &lines.join("\n") + "\n"
        };
        self.0.iter().map(table).collect()
    }
}
