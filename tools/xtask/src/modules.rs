//! `cargo xtask modules`: checks the module structure of the sources.
//!
//! Two rules: no dependency cycle of modules in a crate, and no `#[path]`.
//!
//! Module A depends on module B if A names an item that B defines. B is the defining module, not a re-exporting one. Not counted: a
//! re-export (`pub use child::X`) of an item from a child module, the name of a module alone, code under `#[cfg(test)]`, method calls.
//! A module is a file, with its inline modules. Each target of a package is a separate crate. The check reads tokens, so it counts
//! paths anywhere, even in the arguments of a macro.
//!
//! `cargo modules dependencies --acyclic` makes the same check with rust-analyzer, but takes minutes to compile.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::slice;
use std::str::FromStr;

use anyhow::{Context, Result, anyhow, bail};
use proc_macro2::{Delimiter, Ident, TokenStream, TokenTree};
use serde::Deserialize;

use crate::paths;

/// Checks the rules for the whole workspace.
///
/// # Errors
/// A rule is violated, or a source cannot be read. The error lists each violation on its own line.
pub fn check() -> Result<()> {
    let mut faults = BTreeSet::new();
    for target in targets()? {
        let sources = Crate::load(&target.src_path, &|path| fs::read_to_string(path).ok())
            .with_context(|| format!("reading the modules of {}", target.name))?;
        faults.extend(sources.path_attributes.iter().cloned());
        let dependencies = sources.cycles();
        faults.extend(
            dependencies
                .iter()
                .map(|dependency| format!("{}: dependency in a cycle: {dependency}", target.name)),
        );
    }
    if !faults.is_empty() {
        let faults: Vec<_> = faults.into_iter().collect();
        bail!("cycles of modules, or `#[path]`:\n{}", faults.join("\n"));
    }
    Ok(())
}

/// The part of the output of `cargo metadata` that the check uses.
#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    targets: Vec<Target>,
}

/// A crate of a package, as `cargo metadata` lists it.
#[derive(Deserialize)]
struct Target {
    name: String,
    src_path: PathBuf,
}

/// Lists every crate of the workspace.
fn targets() -> Result<Vec<Target>> {
    let output = Command::new("cargo")
        .args([
            "metadata",
            "--no-deps",
            "--offline",
            "--format-version",
            "1",
        ])
        .current_dir(paths::root())
        .output()
        .context("running cargo metadata")?;
    if !output.status.success() {
        bail!(
            "cargo metadata: {}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
    let metadata: Metadata =
        serde_json::from_slice(&output.stdout).context("reading cargo metadata")?;
    Ok(metadata
        .packages
        .into_iter()
        .flat_map(|package| package.targets)
        .collect())
}

/// Segments of a path, such as `crate`, `a` and `B` of `crate::a::B`. The path of a module starts with `crate`.
type Segments = Vec<String>;

/// An item: the defining module and the name, which ends with `!` for a macro.
type Item = (Segments, String);

/// The imports visited in a lookup: modules and paths.
type Seen = BTreeSet<(Segments, Segments)>;

/// Reads the text of a source file; `None` if no such file exists.
type ReadSource<'a> = &'a dyn Fn(&Path) -> Option<String>;

/// The modules of one crate by their paths.
#[derive(Default)]
struct Crate {
    modules: BTreeMap<Segments, Module>,
    /// Modules with `#[path]`.
    path_attributes: Vec<String>,
}

/// The definitions, imports and named paths of a file. The level of a path is the number of inline modules around it.
#[derive(Default)]
struct Module {
    children: Vec<String>,
    defined: BTreeSet<String>,
    imports: Vec<Import>,
    paths: Vec<(usize, Segments)>,
    /// Names of modules with `#[path]`.
    path_attributes: Vec<String>,
}

/// A leaf of a `use` declaration.
struct Import {
    level: usize,
    path: Segments,
    /// Name in the importing module; `None` for a glob.
    name: Option<String>,
    is_public: bool,
}

impl Crate {
    /// Loads the crate with the root file `root`.
    fn load(root: &Path, read: ReadSource) -> Result<Self> {
        let mut sources = Self::default();
        let folder = root.parent().unwrap_or(Path::new(""));
        sources.add(vec!["crate".to_owned()], &[root.to_owned()], folder, read)?;
        Ok(sources)
    }

    /// Adds the module in the first existing file of `files`; its child modules are below `folder`.
    fn add(
        &mut self,
        name: Segments,
        files: &[PathBuf],
        folder: &Path,
        read: ReadSource,
    ) -> Result<()> {
        let found = files.iter().find_map(|file| Some((file, read(file)?)));
        let (file, text) =
            found.with_context(|| format!("{}: no such file", files[0].display()))?;
        let tokens =
            TokenStream::from_str(&text).map_err(|error| anyhow!("{}: {error}", file.display()))?;
        let mut module = Module::default();
        module.scan(tokens, 0, true);
        let marked = module.path_attributes.iter();
        self.path_attributes
            .extend(marked.map(|child| format!("{}: `#[path]` of {child}", file.display())));
        for child in &module.children {
            let folder = folder.join(child);
            let files = [folder.with_extension("rs"), folder.join("mod.rs")];
            self.add(
                [&name[..], slice::from_ref(child)].concat(),
                &files,
                &folder,
                read,
            )?;
        }
        self.modules.insert(name, module);
        Ok(())
    }

    /// The item that `path` names in `module` below `level` inline modules. `None` for names of other crates and of modules.
    /// `seen` has the imports visited so far, because imports may be circular.
    fn item(
        &self,
        module: &[String],
        mut level: usize,
        path: &[String],
        seen: &mut Seen,
    ) -> Option<Item> {
        let mut at = module.to_vec();
        let mut rest = path;
        while let Some((first, after)) = rest.split_first() {
            match first.as_str() {
                "crate" => (at, level) = (vec!["crate".to_owned()], 0),
                "self" => {}
                "super" if level > 0 => level -= 1,
                "super" => drop(at.pop()),
                name => return self.named(&at, name, after, seen),
            }
            rest = after;
        }
        None
    }

    /// Like [`Self::item`], for a path that starts with a name in the scope of `module`.
    fn named(
        &self,
        module: &[String],
        name: &str,
        rest: &[String],
        seen: &mut Seen,
    ) -> Option<Item> {
        let scope = self.modules.get(module)?;
        let child = [module, &[name.to_owned()]].concat();
        if self.modules.contains_key(&child) && !rest.is_empty() {
            return self.item(&child, 0, rest, seen);
        }
        if scope.defined.contains(name) {
            return Some((module.to_vec(), name.to_owned()));
        }
        // Textual scope is not modelled: the name of a macro is nearly always unique, so the first definition is taken.
        if name.ends_with('!') {
            let mut modules = self.modules.iter();
            let (definer, _) = modules.find(|(_, module)| module.defined.contains(name))?;
            return Some((definer.clone(), name.to_owned()));
        }
        let imports = scope.imports.iter();
        let (globs, named): (Vec<_>, Vec<_>) = imports.partition(|import| import.name.is_none());
        let named = named
            .into_iter()
            .filter(|import| import.name.as_deref() == Some(name));
        let named = named.map(|import| (import, rest.to_vec()));
        let globs = globs
            .into_iter()
            .map(|import| (import, [&[name.to_owned()], rest].concat()));
        named.chain(globs).find_map(|(import, rest)| {
            let looked_up = (module.to_vec(), import.path.clone());
            if !seen.insert(looked_up.clone()) {
                return None;
            }
            let path = [&import.path[..], &rest].concat();
            let item = self.item(module, import.level, &path, seen);
            seen.remove(&looked_up);
            item
        })
    }

    /// The dependencies of the crate, each with the name of an item that causes it.
    fn dependencies(&self) -> BTreeMap<(Segments, Segments), String> {
        let mut dependencies = BTreeMap::new();
        for (name, module) in &self.modules {
            let mut add = |level, path: &[String], is_reexport| {
                if let Some((definer, item)) = self.item(name, level, path, &mut Seen::new())
                    && definer != *name
                    && !(is_reexport && definer.starts_with(name))
                {
                    dependencies.entry((name.clone(), definer)).or_insert(item);
                }
            };
            for (level, path) in &module.paths {
                add(*level, path, false);
            }
            for import in module.imports.iter().filter(|import| import.name.is_some()) {
                add(import.level, &import.path, import.is_public);
            }
        }
        dependencies
    }

    /// The dependencies that are part of a cycle, or of a path between two cycles.
    fn cycles(&self) -> Vec<String> {
        let mut dependencies = self.dependencies();
        loop {
            let [starts, ends] = [0, 1].map(|end| {
                let ends = dependencies
                    .keys()
                    .map(|(from, to)| [from, to][end].clone());
                ends.collect::<BTreeSet<_>>()
            });
            let before = dependencies.len();
            dependencies.retain(|(from, to), _| ends.contains(from) && starts.contains(to));
            if dependencies.len() == before {
                break;
            }
        }
        let shown = dependencies.iter();
        shown
            .map(|((from, to), name)| format!("{} → {} ({name})", from.join("::"), to.join("::")))
            .collect()
    }
}

impl Module {
    /// Reads tokens below `level` inline modules. With `has_items`, the tokens are at module level, and a name after `fn`, `struct` and so
    /// on defines an item of the module.
    fn scan(&mut self, tokens: TokenStream, level: usize, has_items: bool) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let (mut at, mut is_public) = (0, false);
        while at < tokens.len() {
            let start = at;
            let before = start.checked_sub(1).map(|before| &tokens[before]);
            at += 1;
            match &tokens[start] {
                // An attribute.
                TokenTree::Group(group) if before.is_some_and(|token| is_punct(token, '#')) => {
                    let text = group.stream().to_string().replace(' ', "");
                    if text == "cfg(test)" || text.starts_with("cfg(all(test,") {
                        at += item_length(&tokens[at..]);
                    } else if text.starts_with("path=") {
                        let length = item_length(&tokens[at..]);
                        let mut item = tokens[at..at + length].iter().filter_map(text_of);
                        self.path_attributes.extend(item.next_back());
                        at += length;
                    } else {
                        self.scan(group.stream(), level, false);
                    }
                }
                TokenTree::Group(group) => {
                    self.scan(group.stream(), level, false);
                    // The group `(crate)` in `pub(crate)` is part of the visibility.
                    is_public &= group.delimiter() == Delimiter::Parenthesis;
                }
                TokenTree::Ident(word) if word == "pub" => is_public = true,
                TokenTree::Ident(word) if word == "use" => {
                    let end = |token: &TokenTree| is_punct(token, ';');
                    let length = tokens[at..].iter().position(end).unwrap_or_default();
                    self.uses(&tokens[at..at + length], &[], level, is_public);
                    (at, is_public) = (at + length, false);
                }
                TokenTree::Ident(word) if word == "mod" && has_items => {
                    let Some(name) = tokens.get(at).and_then(text_of) else {
                        continue;
                    };
                    if let Some(TokenTree::Group(group)) = tokens.get(at + 1) {
                        self.defined.insert(name);
                        self.scan(group.stream(), level + 1, true);
                    } else {
                        self.children.push(name);
                    }
                    (at, is_public) = (at + 2, false);
                }
                TokenTree::Ident(word) => {
                    is_public = false;
                    const ITEMS: [&str; 8] = [
                        "fn", "struct", "enum", "union", "trait", "type", "const", "static",
                    ];
                    if has_items && ITEMS.iter().any(|item| word == item) {
                        self.defined.extend(tokens.get(at).and_then(text_of));
                        continue;
                    }
                    let mut path = vec![text(word)];
                    while let Some([a, b, TokenTree::Ident(next)]) = tokens.get(at..at + 3)
                        && is_punct(a, ':')
                        && is_punct(b, ':')
                    {
                        path.push(text(next));
                        at += 3;
                    }
                    let next = tokens.get(at);
                    if next.is_some_and(|token| is_punct(token, '!')) {
                        path.last_mut().expect("it has a name").push('!');
                    }
                    // A single name may be a variable, so it counts only if its form shows an item.
                    let is_call = matches!(next, Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Parenthesis);
                    let is_item = path.len() > 1
                        || is_call
                        || path[0].ends_with('!')
                        || path[0].starts_with(char::is_uppercase);
                    let is_method = matches!(&tokens[..start], [.., a, b] if !is_punct(a, '.') && is_punct(b, '.'));
                    // `::name` names another crate, or an item of the preceding type.
                    let is_absolute = matches!(&tokens[..start], [.., a, b] if is_punct(a, ':') && is_punct(b, ':'));
                    if is_item && !is_method && !is_absolute {
                        self.paths.push((level, path));
                    }
                }
                TokenTree::Punct(_)
                    if has_items
                        && before
                            .and_then(text_of)
                            .is_some_and(|word| word == "macro_rules") =>
                {
                    let name = tokens.get(at).and_then(text_of);
                    self.defined.extend(name.map(|name| name + "!"));
                }
                TokenTree::Punct(_) | TokenTree::Literal(_) => {}
            }
        }
    }

    /// Reads the tree of a `use` declaration below `prefix`.
    fn uses(&mut self, tokens: &[TokenTree], prefix: &[String], level: usize, is_public: bool) {
        for leaf in tokens.split(|token| is_punct(token, ',')) {
            let mut path = prefix.to_vec();
            let mut name = None;
            for (at, token) in leaf.iter().enumerate() {
                match token {
                    TokenTree::Ident(word) if word == "as" => {
                        name = leaf.get(at + 1).and_then(text_of);
                        break;
                    }
                    TokenTree::Ident(word) if word == "self" && !path.is_empty() => {
                        name = path.last().cloned()
                    }
                    TokenTree::Ident(word) => {
                        path.push(text(word));
                        name = Some(text(word));
                    }
                    TokenTree::Group(group) => {
                        let inside: Vec<_> = group.stream().into_iter().collect();
                        self.uses(&inside, &path, level, is_public);
                        path.clear();
                    }
                    TokenTree::Punct(punct) if punct.as_char() == '*' => name = None,
                    // `use ::name` imports from another crate.
                    TokenTree::Punct(_) if at == 0 => break,
                    TokenTree::Punct(_) | TokenTree::Literal(_) => {}
                }
            }
            if !leaf.is_empty() && !path.is_empty() {
                self.imports.push(Import {
                    level,
                    path,
                    name,
                    is_public,
                });
            }
        }
    }
}

/// Number of tokens up to the end of an item, its `;` or its block.
fn item_length(tokens: &[TokenTree]) -> usize {
    let is_end = |token: &TokenTree| match token {
        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
        token => is_punct(token, ';'),
    };
    tokens
        .iter()
        .position(is_end)
        .map_or(tokens.len(), |end| end + 1)
}

fn is_punct(token: &TokenTree, character: char) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == character)
}

fn text_of(token: &TokenTree) -> Option<String> {
    match token {
        TokenTree::Ident(ident) => Some(text(ident)),
        TokenTree::Group(_) | TokenTree::Punct(_) | TokenTree::Literal(_) => None,
    }
}

/// The text of an identifier, without the prefix `r#`.
fn text(ident: &Ident) -> String {
    let text = ident.to_string();
    text.strip_prefix("r#").map(str::to_owned).unwrap_or(text)
}

#[cfg(test)]
mod tests;
