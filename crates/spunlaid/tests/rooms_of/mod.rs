//! Reads which rooms of a crate or of a wing, the modules at its root, import which others.
#![allow(clippy::expect_used)]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The rooms of a crate from left to right; those of one group stand side by side and may not import one another.
pub type Rooms<'a> = &'a [&'a [&'a str]];

fn rank(rooms: Rooms<'_>, room: &str) -> Option<usize> {
    rooms.iter().position(|group| group.contains(&room))
}

pub fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder of sources") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The source without comments and without what stands in quotes, so that only code can name a room.
fn code_only(source: &str) -> String {
    code_and_texts(source).0
}

/// The code of a source, in which texts are empty, and the texts as they are written.
pub fn code_and_texts(source: &str) -> (String, Vec<String>) {
    let (mut code, mut texts) = (String::new(), Vec::new());
    let mut rest = source.chars().peekable();
    while let Some(c) = rest.next() {
        match (c, rest.peek()) {
            ('/', Some('/')) => {
                while rest.peek().is_some_and(|&c| c != '\n') {
                    rest.next();
                }
            }
            ('"', _) => {
                let mut text = String::new();
                while let Some(c) = rest.next() {
                    match c {
                        '\\' => text.extend(rest.next().filter(|c| !c.is_alphabetic())),
                        '"' => break,
                        c => text.push(c),
                    }
                }
                code.push_str("\"\"");
                texts.push(text);
            }
            ('\'', Some('"')) => {
                // The character '"' opens no text.
                rest.next();
            }
            _ => code.push(c),
        }
    }
    (code, texts)
}

/// A path of two names or more in the code of a file.
pub struct NamePath {
    /// Its names: `super`, `super`, `air`, `Air`.
    pub names: Vec<String>,
    /// Whether it stands in a `use`.
    is_use: bool,
}

/// The paths of a code, with the groups in braces written out.
pub fn paths(code: &str) -> Vec<NamePath> {
    let (mut found, mut path, mut groups) = (Vec::new(), Vec::new(), Vec::<Vec<String>>::new());
    let (mut is_use, mut goes_on, mut is_alias) = (false, false, false);
    let mut rest = code;
    while let Some(first) = rest.chars().next() {
        let length = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        let (token, after) = rest.split_at(match length {
            0 if rest.starts_with("::") => 2,
            0 => first.len_utf8(),
            length => length,
        });
        rest = after;
        if token == "::" {
            goes_on = !path.is_empty();
        } else if (length > 0 || token == "*") && goes_on {
            path.push(token.to_owned());
            goes_on = false;
        } else if token == "{" && goes_on {
            groups.push(std::mem::take(&mut path));
            goes_on = false;
        } else if !token.trim().is_empty() {
            if path.len() > 1 {
                found.push(NamePath { names: std::mem::take(&mut path), is_use });
            }
            path.clear();
            match token {
                "use" => is_use = true,
                ";" => is_use = false,
                "{" => groups.push(Vec::new()),
                "}" => drop(groups.pop()),
                _ if length > 0 && token != "as" && !is_alias => {
                    path = groups.last().cloned().unwrap_or_default();
                    path.push(token.to_owned());
                }
                _ => {}
            }
            is_alias = token == "as";
        }
    }
    found
}

/// Rooms of a wing that a file imports from, its own left out. The rooms of no wing stand at the root of the crate.
fn imports(rooms: Rooms<'_>, wing: Option<&str>, source: &str, room: &str, depth: usize) -> BTreeSet<String> {
    let root: Vec<&str> = ["crate"].into_iter().chain(wing).collect();
    // `super` as often as the file is deep leaves the room, as `crate` does.
    let outside = |path: NamePath| {
        let above = path.names.iter().take_while(|name| *name == "super").count();
        let from_root =
            path.names.len() > root.len() && root.iter().zip(&path.names).all(|(one, other)| one == other);
        let entered = if from_root { Some(root.len()) } else { (above == depth).then_some(above) };
        entered.and_then(|at| path.names.get(at).cloned())
    };
    let mut found: BTreeSet<String> = paths(&code_only(source)).into_iter().filter_map(outside).collect();
    found.retain(|name| rank(rooms, name).is_some() && name != room);
    found
}

/// What is wrong with the imports of the sources below `root`, the folder of a wing or of a crate without wings, a line
/// each, the files of `entrances` left out.
pub fn faults(root: &Path, wing: Option<&str>, rooms: Rooms<'_>, entrances: &[&str]) -> Vec<String> {
    let mut seen = BTreeSet::new();
    let mut wrong = Vec::new();
    for path in sources(root) {
        let inside: Vec<String> = path
            .strip_prefix(root)
            .expect("below the root")
            .components()
            .map(|part| part.as_os_str().to_string_lossy().into_owned())
            .collect();
        let room = inside[0].trim_end_matches(".rs").to_owned();
        if entrances.contains(&room.as_str()) {
            continue;
        }
        let Some(own) = rank(rooms, &room) else {
            wrong.push(format!("{room} is a room this test does not know; put it in its place in ROOMS"));
            continue;
        };
        seen.insert(room.clone());
        // src/a.rs and src/a/mod.rs are the room itself, src/a/b.rs is one deeper.
        let is_room = inside.len() == 1 || inside.last().is_some_and(|name| name == "mod.rs");
        let depth = if is_room { inside.len().max(2) - 1 } else { inside.len() };
        let source = fs::read_to_string(&path).expect("a readable source");
        for imported in imports(rooms, wing, &source, &room, depth) {
            if rank(rooms, &imported).is_some_and(|other| other < own) {
                continue;
            }
            wrong.push(format!("{}: imports {imported}, which is not to its left", path.display()));
        }
    }
    let missing = rooms.iter().copied().flatten().filter(|room| !seen.contains(**room));
    wrong.extend(missing.map(|room| format!("{room} is in ROOMS, but there is no such room")));
    wrong
}

type Module = Vec<String>;

/// The files of a crate as modules, with the paths that each names.
struct Files(BTreeMap<Module, Vec<NamePath>>);

impl Files {
    fn read(root: &Path) -> Self {
        let module = |path: &Path| -> Module {
            let inside = path.strip_prefix(root).expect("below the root").with_extension("");
            let names = inside.iter().map(|name| name.to_string_lossy().into_owned());
            names.filter(|name| !["mod", "lib", "main"].contains(&name.as_str())).collect()
        };
        let named = |path: &Path| {
            let source = fs::read_to_string(path).expect("a readable source");
            paths(&code_only(source.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default()))
        };
        Self(sources(root).iter().map(|path| (module(path), named(path))).collect())
    }

    /// A path that a module names, from the root of the crate. `None` if it leads out of the crate.
    fn absolute(&self, module: &Module, names: &[String]) -> Option<Module> {
        let above = names.iter().take_while(|name| *name == "super").count();
        let child = [&module[..], &names[..1]].concat();
        let start = match names[0].as_str() {
            "crate" => return Some(names[1..].to_vec()),
            "super" => &module[..module.len().checked_sub(above)?],
            "self" => return Some([module, &names[1..]].concat()),
            _ if self.0.contains_key(&child) => &module[..],
            _ => return None,
        };
        Some([start, &names[above..]].concat())
    }

    /// The file that has what a path from the root leads to. What a module only passes on is in another file.
    fn file(&self, path: &[String], steps: usize) -> Option<Module> {
        let module =
            (0..=path.len()).rev().map(|end| path[..end].to_vec()).find(|m| self.0.contains_key(m))?;
        let Some(name) = path.get(module.len()) else { return Some(module) };
        let passed_on = self.0[&module].iter().filter(|named| named.is_use);
        let other = passed_on.filter(|named| named.names.last() == Some(name));
        let other = other.filter_map(|named| self.absolute(&module, &named.names)).next();
        match other.filter(|_| steps > 0) {
            Some(start) => self.file(&[&start, &path[module.len() + 1..]].concat(), steps - 1),
            None => Some(module),
        }
    }

    /// The files that a file imports from, those that hold it left out: a file may use what the module around
    /// it defines.
    fn imports(&self, module: &Module) -> BTreeSet<Module> {
        let named = self.0[module].iter().filter_map(|path| self.absolute(module, &path.names));
        named.filter_map(|path| self.file(&path, 8)).filter(|file| !module.starts_with(file)).collect()
    }
}

/// Imports between the modules below `root` that lead back to where they start, a line each. A folder counts
/// as a whole for what stands beside it: its files may use each other's through its `mod.rs`, so a circle may
/// go through any of them.
pub fn circles(root: &Path) -> Vec<String> {
    let files = Files::read(root);
    let mut imports = BTreeMap::<_, BTreeSet<_>>::new();
    for module in files.0.keys() {
        for other in files.imports(module) {
            let common = module.iter().zip(&other).take_while(|(one, other)| one == other).count();
            if common < module.len() {
                imports.entry(module[..=common].to_vec()).or_default().insert(other[..=common].to_vec());
            }
        }
    }
    let leads_to = |start: &Module, end: &Module| {
        let (mut reached, mut open) = (BTreeSet::new(), vec![start]);
        while let Some(module) = open.pop() {
            open.extend(imports.get(module).into_iter().flatten().filter(|next| reached.insert(*next)));
        }
        reached.contains(end)
    };
    let all = imports.iter().flat_map(|(module, others)| others.iter().map(move |other| (module, other)));
    let wrong = all.filter(|(module, other)| leads_to(other, module));
    wrong
        .map(|(module, other)| format!("{} and {} import each other", module.join("/"), other.join("/")))
        .collect()
}

#[test]
fn rooms_are_found_however_they_are_imported() {
    const ROOMS: Rooms<'_> = &[&["fibre", "chain", "air", "vec3", "case", "input"]];
    let found =
        |source: &str, depth| imports(ROOMS, None, source, "fibre", depth).into_iter().collect::<Vec<_>>();
    let in_wing = |source: &str, depth| imports(ROOMS, Some("house"), source, "fibre", depth);
    assert_eq!(found("use crate::chain::Chain;", 1), ["chain"]);
    assert_eq!(found("use crate::{\n    air::{Air, Eddies},\n    vec3::Vec3,\n};", 1), ["air", "vec3"]);
    assert_eq!(found("fn f() { super::super::case::check() }", 2), ["case"]);
    assert_eq!(found("fn f() { super::case::check() }", 2), [""; 0]);
    assert_eq!(found("// crate::case\n/// [`crate::case`]\nconst A: &str = \"crate::case\";", 1), [""; 0]);
    assert_eq!(found("let q = '\"'; crate::input::read();", 1), ["input"]);
    assert_eq!(found("use crate::fibre::Fibre; use thecrate::case;", 1), [""; 0]);
    assert!(in_wing("use crate::house::chain::Chain;", 1).contains("chain"));
    assert!(in_wing("use super::air::Air;", 1).contains("air"));
    assert!(in_wing("use crate::chain::Chain;", 1).is_empty(), "the room of another wing");
}

#[test]
fn circles_are_found_through_what_a_module_passes_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, source: &str| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, source).expect("a file");
    };
    write("lib.rs", "mod a; mod b;");
    write("a/mod.rs", "mod one;\nmod two;\npub use one::{One, first as start};\npub struct Own;");
    write("a/one.rs", "use super::Own;\nuse super::{super::b, two::Two};");
    write("a/two.rs", "fn two() -> super::One { super::start() }");
    write("b.rs", "// crate::a\nconst A: &str = \"crate::a::One\";");
    assert_eq!(
        circles(folder.path()),
        ["a/one and a/two import each other", "a/two and a/one import each other"]
    );
    write(
        "a/two.rs",
        "fn two() -> crate::b::B {}\n#[cfg(test)]\nmod tests {\n    use super::super::one::One;\n}",
    );
    assert_eq!(circles(folder.path()), [""; 0]);
    // Through the folder that holds the file.
    write("b.rs", "fn b() -> crate::a::Own {}");
    assert_eq!(circles(folder.path()), ["a and b import each other", "b and a import each other"]);
}
